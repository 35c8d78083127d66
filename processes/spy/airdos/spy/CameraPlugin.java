package airdos.spy;

import airdos.image_t;
import java.awt.Dimension;
import java.awt.Graphics;
import java.awt.Graphics2D;
import javax.swing.Action;
import javax.swing.JDesktopPane;
import javax.swing.JInternalFrame;
import javax.swing.JPanel;
import javax.swing.Timer;
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
    return PluginWindow.action(NAME, desktop, () -> open(desktop));
  }

  private static void open(JDesktopPane desktop) {
    FrameHistory history = new FrameHistory();
    LCM lcm = LCM.getSingleton();
    for (String channel : FrameHistory.CHANNELS) lcm.subscribe(channel, history);

    View view = new View();
    Timer timer = new Timer(REFRESH_MS, event -> view.show(history.newest()));
    JInternalFrame window = PluginWindow.open(NAME, view, desktop, SIZE);
    Runnable stop =
        () -> {
          timer.stop();
          for (String channel : FrameHistory.CHANNELS) lcm.unsubscribe(channel, history);
        };
    PluginWindow.onClose(window, desktop, stop);
    timer.start();
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
