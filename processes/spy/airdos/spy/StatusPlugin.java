package airdos.spy;

import airdos.process_status_t;
import java.awt.BorderLayout;
import java.awt.Color;
import java.awt.Component;
import java.awt.Dimension;
import java.io.IOException;
import javax.swing.Action;
import javax.swing.JDesktopPane;
import javax.swing.JInternalFrame;
import javax.swing.JPanel;
import javax.swing.JScrollPane;
import javax.swing.JTable;
import javax.swing.SwingUtilities;
import javax.swing.Timer;
import javax.swing.table.DefaultTableCellRenderer;
import javax.swing.table.TableColumnModel;
import lcm.lcm.LCM;
import lcm.lcm.LCMSubscriber;
import lcm.spy.ChannelData;
import lcm.spy.SpyPlugin;

/**
 * Opens for STATUS: one row per process, red if it is not READY or has fallen silent, yellow if
 * it has warnings.
 */
public final class StatusPlugin implements SpyPlugin {
  static final String NAME = "Processes";
  private static final String CHANNEL = "STATUS";
  private static final int REFRESH_MS = 500;
  private static final Dimension SIZE = new Dimension(1180, 260);

  public StatusPlugin() {}

  @Override
  public boolean canHandle(long fingerprint) {
    return fingerprint == process_status_t.LCM_FINGERPRINT;
  }

  /** First called with nulls, only for the name. */
  @Override
  public Action getAction(JDesktopPane desktop, ChannelData channel) {
    return PluginWindow.action(NAME, desktop, () -> open(desktop, channel));
  }

  private static void open(JDesktopPane desktop, ChannelData channel) {
    StatusTableModel model = new StatusTableModel();
    LCM lcm = LCM.getSingleton();
    String name = channel == null ? CHANNEL : channel.name;
    LCMSubscriber subscriber =
        (source, heardOn, stream) -> {
          try {
            process_status_t status = new process_status_t(stream);
            SwingUtilities.invokeLater(() -> model.add(status, nowMs()));
          } catch (IOException | RuntimeException e) {
            // The spy's own column counts messages that do not decode.
          }
        };
    lcm.subscribe(name, subscriber);

    JPanel panel = new JPanel(new BorderLayout());
    panel.add(new JScrollPane(newTable(model)));
    JInternalFrame window = PluginWindow.open(NAME, panel, desktop, SIZE);
    Timer timer = new Timer(REFRESH_MS, event -> model.refresh(nowMs()));
    Runnable stop =
        () -> {
          timer.stop();
          lcm.unsubscribe(name, subscriber);
        };
    PluginWindow.onClose(window, desktop, stop);
    timer.start();
  }

  /** For ages only. Not the wall clock, which may be set back. */
  private static long nowMs() {
    return System.nanoTime() / 1_000_000;
  }

  static JTable newTable(StatusTableModel model) {
    JTable table = new JTable(model);
    table.setAutoResizeMode(JTable.AUTO_RESIZE_OFF);
    TableColumnModel columns = table.getColumnModel();
    for (StatusTableModel.Column column : StatusTableModel.Column.values()) {
      columns.getColumn(column.ordinal()).setPreferredWidth(column.widthPx);
    }
    table.setDefaultRenderer(Object.class, new HealthRenderer(model));
    return table;
  }

  private static final class HealthRenderer extends DefaultTableCellRenderer {
    private static final Color ALARM = new Color(0xFF, 0xCC, 0xCC);
    private static final Color DOUBT = new Color(0xFF, 0xF4, 0xCC);
    private final transient StatusTableModel model;

    HealthRenderer(StatusTableModel model) {
      this.model = model;
    }

    @Override
    public Component getTableCellRendererComponent(
        JTable table, Object value, boolean isSelected, boolean hasFocus, int row, int column) {
      Component cell =
          super.getTableCellRendererComponent(table, value, isSelected, hasFocus, row, column);
      setToolTipText(value == null || value.toString().isEmpty() ? null : value.toString());
      if (!isSelected) {
        Color healthy = model.hasWarnings(row) ? DOUBT : Color.WHITE;
        cell.setBackground(model.isHealthy(row) ? healthy : ALARM);
      }
      return cell;
    }
  }
}
