package airdos.spy;

import java.awt.AWTException;
import java.awt.Color;
import java.awt.Component;
import java.awt.Container;
import java.awt.Frame;
import java.awt.Point;
import java.awt.Rectangle;
import java.awt.Robot;
import java.awt.Toolkit;
import java.awt.Window;
import java.awt.event.InputEvent;
import java.awt.image.BufferedImage;
import java.io.File;
import java.util.Map;
import java.util.TreeMap;
import java.util.concurrent.Callable;
import java.util.concurrent.Executors;
import java.util.concurrent.ScheduledExecutorService;
import java.util.concurrent.TimeUnit;
import javax.imageio.ImageIO;
import javax.swing.JInternalFrame;
import javax.swing.JTable;
import javax.swing.SwingUtilities;
import lcm.lcm.LCM;
import lcm.lcm.LCMEncodable;
import lcm.spy.Spy;

/**
 * The whole lcm-spy on a (virtual) display: every channel is listed with its type and decodes; a
 * double click opens the plugins; they draw. Arguments: folder for screenshots, and optionally a
 * data set whose images and keypoints are published instead of the made-up scene.
 */
final class SpyWindowTest {
  private static final long DEADLINE_S = 60;
  private static final int NUM_FRAMES = 100;

  private final Robot robot;
  private final File screenshots;

  private SpyWindowTest(File screenshots) throws AWTException {
    this.screenshots = screenshots;
    robot = new Robot();
    robot.setAutoWaitForIdle(true);
  }

  public static void main(String[] args) throws Exception {
    SpyTestStream stream = new SpyTestStream(args.length > 1 ? args[1] : null);
    ScheduledExecutorService publisher = Executors.newSingleThreadScheduledExecutor();
    LCM lcm = new LCM();
    long[] seq = {0};
    publisher.scheduleAtFixedRate(
        () -> {
          try {
            for (Map.Entry<String, LCMEncodable> message :
                stream.messagesOf(seq[0]++ % NUM_FRAMES).entrySet()) {
              lcm.publish(message.getKey(), message.getValue());
            }
          } catch (Exception e) {
            fail("publisher: " + e);
          }
        },
        0, SpyTestStream.FRAME_US, TimeUnit.MICROSECONDS);
    Spy.main(new String[] {});
    try {
      new SpyWindowTest(new File(args[0])).run(stream);
    } catch (Exception e) {
      e.printStackTrace();
      fail(e.toString());
    }
    System.out.println("all checks passed");
    System.exit(0);  // Swing's and LCM's threads would go on
  }

  private static void fail(String what) {
    System.err.println("FAILED: " + what);
    System.exit(1);
  }

  private <T> T await(String what, Callable<T> find) throws Exception {
    long deadline = System.nanoTime() + TimeUnit.SECONDS.toNanos(DEADLINE_S);
    while (System.nanoTime() < deadline) {
      T found = find.call();
      if (found != null) return found;
      TimeUnit.MILLISECONDS.sleep(50);  // between two looks, until the deadline
    }
    save("spy_failure.png");
    fail(what + " did not come within " + DEADLINE_S + " s");
    return null;
  }

  private void run(SpyTestStream stream) throws Exception {
    JTable channels = await("the spy's table", () -> findIn(JTable.class, null));
    Map<String, String> expected = new TreeMap<>();
    for (Map.Entry<String, LCMEncodable> message : stream.messagesOf(0).entrySet()) {
      expected.put(message.getKey(), message.getValue().getClass().getSimpleName());
    }
    Map<String, String> listed = new TreeMap<>();
    await("all channels with their types", () -> {
      listed.putAll(onSwing(() -> typesIn(channels)));
      return listed.entrySet().containsAll(expected.entrySet()) ? true : null;
    });
    save("spy_channels.png");

    Window fields = open(channels, "STATE_ESTIMATE", () -> titled("STATE_ESTIMATE"));
    SwingUtilities.invokeAndWait(() -> fields.setLocation(800, 0));
    await("fields drawn", () -> count(shotOf(fields), Color.BLACK) > 1000 ? true : null);
    save("spy_fields.png");

    openPlugin(channels, "STATUS", StatusPlugin.NAME);
    JTable processes =
        await("the table of processes",
            () -> onSwing(() -> {
              JTable table = findIn(JTable.class, StatusPlugin.NAME);
              return table != null && table.getRowCount() == 2 ? table : null;
            }));
    if (!"READY".equals(processes.getValueAt(0, 1))) fail("the frontend is shown as READY");
    save("spy_processes.png");

    Window window = openPlugin(channels, "CAMERA_LEFT", CameraPlugin.NAME);
    await("features and tracks on the screen", () -> drawsOn(window) ? true : null);
    save("spy_camera.png");
  }

  private static Map<String, String> typesIn(JTable channels) {
    Map<String, String> types = new TreeMap<>();
    for (int row = 0; row < channels.getRowCount(); ++row) {
      String undecodable = String.valueOf(channels.getValueAt(row, channels.getColumnCount() - 1));
      if (!undecodable.equals("0")) fail(undecodable + " undecodable in row " + row);
      types.put(String.valueOf(channels.getValueAt(row, 0)).trim(),
          String.valueOf(channels.getValueAt(row, 1)).trim());
    }
    return types;
  }

  /** As a user does it; there is no window manager, so the windows are put side by side first. */
  private Window openPlugin(JTable channels, String channel, String title) throws Exception {
    JInternalFrame inner = open(channels, channel, () -> findIn(JInternalFrame.class, title));
    Window window = SwingUtilities.getWindowAncestor(inner);
    SwingUtilities.invokeAndWait(() -> {
      window.setLocation(20, 330);
      window.toFront();
    });
    return window;
  }

  /** A busy spy may see two single clicks: then it is tried again. */
  private <T> T open(JTable channels, String channel, Callable<T> find) throws Exception {
    final int looks = 40;
    return await("the window of " + channel, () -> {
      doubleClick(channels, channel);
      for (int look = 0; look < looks; ++look) {
        T found = onSwing(find);
        if (found != null) return found;
        TimeUnit.MILLISECONDS.sleep(50);  // between two looks
      }
      return null;
    });
  }

  private void doubleClick(JTable channels, String channel) throws Exception {
    SwingUtilities.invokeAndWait(() -> SwingUtilities.getWindowAncestor(channels).toFront());
    Point point = onSwing(() -> {
      for (int row = 0; row < channels.getRowCount(); ++row) {
        if (!channel.equals(String.valueOf(channels.getValueAt(row, 0)).trim())) continue;
        Rectangle cell = channels.getCellRect(row, 0, true);
        Point centre = new Point(cell.x + 20, cell.y + cell.height / 2);
        SwingUtilities.convertPointToScreen(centre, channels);
        return centre;
      }
      return null;
    });
    robot.mouseMove(point.x, point.y);
    robot.waitForIdle();
    robot.setAutoWaitForIdle(false);  // the spy repaints so much that the clicks would be far apart
    for (int click = 0; click < 2; ++click) {
      robot.mousePress(InputEvent.BUTTON1_DOWN_MASK);
      robot.mouseRelease(InputEvent.BUTTON1_DOWN_MASK);
    }
    robot.setAutoWaitForIdle(true);
    robot.waitForIdle();
  }

  private boolean drawsOn(Window window) {
    BufferedImage shot = shotOf(window);
    return count(shot, FrameRenderer.STEREO_FEATURE) > 100
        && count(shot, FrameRenderer.MONO_FEATURE) > 20
        && count(shot, FrameRenderer.colourOf(3)) > 50;
  }

  private BufferedImage shotOf(Window window) {
    return robot.createScreenCapture(window.getBounds());
  }

  private static int count(BufferedImage image, Color colour) {
    int num = 0;
    for (int y = 0; y < image.getHeight(); ++y) {
      for (int x = 0; x < image.getWidth(); ++x) {
        if ((image.getRGB(x, y) & 0xFFFFFF) == (colour.getRGB() & 0xFFFFFF)) ++num;
      }
    }
    return num;
  }

  private void save(String name) throws Exception {
    robot.waitForIdle();
    Rectangle screen = new Rectangle(Toolkit.getDefaultToolkit().getScreenSize());
    ImageIO.write(robot.createScreenCapture(screen), "png", new File(screenshots, name));
  }

  private static <T> T onSwing(Callable<T> read) throws Exception {
    Object[] result = new Object[1];
    SwingUtilities.invokeAndWait(() -> {
      try {
        result[0] = read.call();
      } catch (Exception e) {
        throw new IllegalStateException(e);
      }
    });
    @SuppressWarnings("unchecked")
    T value = (T) result[0];
    return value;
  }

  /** The first component of that class, inside the internal window of that title if one is given. */
  private static <T extends Component> T findIn(Class<T> type, String title) {
    for (Window window : Window.getWindows()) {
      Container root = title == null ? window : titled(window, title);
      T found = root == null || !window.isShowing() ? null : find(root, type);
      if (found != null) return found;
    }
    return null;
  }

  private static Window titled(String title) {
    for (Window window : Window.getWindows()) {
      boolean hasTitle = window instanceof Frame && ((Frame) window).getTitle().equals(title);
      if (hasTitle && window.isShowing()) return window;
    }
    return null;
  }

  private static JInternalFrame titled(Container container, String title) {
    for (Component child : container.getComponents()) {
      if (child instanceof JInternalFrame && ((JInternalFrame) child).getTitle().equals(title)) {
        return (JInternalFrame) child;
      }
      JInternalFrame found =
          child instanceof Container ? titled((Container) child, title) : null;
      if (found != null) return found;
    }
    return null;
  }

  private static <T extends Component> T find(Component component, Class<T> type) {
    if (type.isInstance(component)) return type.cast(component);
    if (!(component instanceof Container)) return null;
    for (Component child : ((Container) component).getComponents()) {
      T found = find(child, type);
      if (found != null) return found;
    }
    return null;
  }
}
