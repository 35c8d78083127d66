package airdos.spy;

import java.awt.Dimension;
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
import javax.swing.event.InternalFrameAdapter;
import javax.swing.event.InternalFrameEvent;

/** What the plugins' windows in the spy have in common. */
final class PluginWindow {
  private PluginWindow() {}

  /** What a plugin returns from getAction(): the spy asks without a desktop for the name only. */
  static Action action(String name, JDesktopPane desktop, Runnable open) {
    return new AbstractAction(name) {
      @Override
      public void actionPerformed(ActionEvent event) {
        if (desktop != null) open.run();
      }
    };
  }

  static JInternalFrame open(String title, JPanel content, JDesktopPane desktop, Dimension size) {
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
      // Then it stays as large as it is.
    }
    return window;
  }

  /** Runs `stop` when the plugin's window or the spy's window around it goes away. */
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
}
