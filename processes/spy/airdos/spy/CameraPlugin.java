package airdos.spy;

import airdos.image_t;
import java.awt.Dimension;
import java.awt.Graphics;
import java.awt.Graphics2D;
import java.awt.Window;
import java.awt.event.ActionEvent;
import java.awt.event.WindowAdapter;
import java.awt.event.WindowEvent;
import java.beans.PropertyVetoException;
import javax.swing.AbstractAction;
import javax.swing.Action;
import javax.swing.JDesktopPane;
import javax.swing.JInternalFrame;
import javax.swing.JPanel;
import javax.swing.SwingUtilities;
import javax.swing.Timer;
import javax.swing.event.InternalFrameAdapter;
import javax.swing.event.InternalFrameEvent;
import lcm.lcm.LCM;
import lcm.spy.ChannelData;
import lcm.spy.SpyPlugin;

/**
 * Opens for image channels; CAMERA_LEFT has the keypoints, tracks and static features of the
 * same image drawn over it. The other channels are received by a separate subscription on
 * LCM_DEFAULT_URL (set by launch_scripts/spy.sh), because the spy passes on one channel only.
 */
public final class CameraPlugin implements SpyPlugin {
  static final String NAME = "Camera with people and features";
  private static final int REFRESH_MS = 50;
  private static final Dimension SIZE = new Dimension(976, 630);

  public CameraPlugin() {}

  @Override
  public boolean canHandle(long fingerprint) {
    return fingerprint == image_t.LCM_FINGERPRINT;
  }

  /** First called with nulls, only for the name. */
  @Override
  public Action getAction(JDesktopPane desktop, ChannelData channel) {
    return new AbstractAction(NAME) {
      @Override
      public void actionPerformed(ActionEvent event) {
        if (desktop != null) open(desktop);
      }
    };
  }

  private static void open(JDesktopPane desktop) {
    FrameHistory history = new FrameHistory();
    LCM lcm = LCM.getSingleton();
    for (String channel : FrameHistory.CHANNELS) lcm.subscribe(channel, history);

    View view = new View();
    Timer timer = new Timer(REFRESH_MS, event -> view.show(history.newest()));
    JInternalFrame window = newWindow(NAME, view, desktop, SIZE);
    Runnable stop =
        () -> {
          timer.stop();
          for (String channel : FrameHistory.CHANNELS) lcm.unsubscribe(channel, history);
        };
    onClose(window, desktop, stop);
    timer.start();
  }

  static JInternalFrame newWindow(
      String title, JPanel content, JDesktopPane desktop, Dimension size) {
    JInternalFrame window = new JInternalFrame(title, true, true, true, true);
    window.setContentPane(content);
    window.setSize(size);
    desktop.add(window);
    window.setVisible(true);
    Window outer = SwingUtilities.getWindowAncestor(desktop);
    if (outer == null) return window;
    outer.setSize(size);
    outer.validate();
    try {
      window.setMaximum(true);
    } catch (PropertyVetoException e) {
      // Then it keeps its size.
    }
    return window;
  }

  /** Runs `stop` when the plugin's window, or the spy's window around it, is closed. */
  static void onClose(JInternalFrame window, JDesktopPane desktop, Runnable stop) {
    window.addInternalFrameListener(
        new InternalFrameAdapter() {
          @Override
          public void internalFrameClosed(InternalFrameEvent event) {
            stop.run();
          }
        });
    Window outer = SwingUtilities.getWindowAncestor(desktop);
    if (outer == null) return;
    outer.addWindowListener(
        new WindowAdapter() {
          @Override
          public void windowClosing(WindowEvent event) {
            window.dispose();
          }
        });
  }

  private static final class View extends JPanel {
    private final transient FrameRenderer renderer = new FrameRenderer();
    private transient Frame frame;

    void show(Frame newFrame) {
      frame = newFrame;
      repaint();
    }

    @Override
    protected void paintComponent(Graphics g) {
      super.paintComponent(g);
      Graphics2D copy = (Graphics2D) g.create();
      renderer.paint(copy, frame, getWidth(), getHeight());
      copy.dispose();
    }
  }
}
