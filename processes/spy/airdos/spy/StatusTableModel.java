package airdos.spy;

import airdos.channel_status_t;
import airdos.process_status_t;
import java.util.ArrayList;
import java.util.List;
import java.util.Locale;
import java.util.Map;
import java.util.TreeMap;
import javax.swing.table.AbstractTableModel;

/** One row for each process, from its last STATUS. For Swing's thread only. */
final class StatusTableModel extends AbstractTableModel {
  /** A process speaks every second; after this long its row says so. */
  static final long SILENT_AFTER_MS = 3000;

  private static final String[] COLUMNS = {
    "process", "state", "frames", "incomplete", "skipped", "missing", "rejected",
    "p50 ms", "p99 ms", "cpu ms/frame", "memory MB", "version", "types", "waiting for",
    "last error", "warnings"
  };

  /** Digits of a fingerprint: enough to tell two apart. */
  private static final int SHOWN_OF_TYPES = 8;

  private static final class Row {
    process_status_t status;
    long heardAtMs;
  }

  /** Whoever invents names of processes must not fill the memory. */
  static final int MAX_PROCESSES = 100;

  private final Map<String, Row> rows = new TreeMap<>();
  private long nowMs;

  void add(process_status_t status, long atMs) {
    if (rows.size() >= MAX_PROCESSES && !rows.containsKey(status.process)) return;
    Row row = rows.computeIfAbsent(status.process, name -> new Row());
    row.status = status;
    row.heardAtMs = atMs;
    refresh(atMs);
  }

  /** Shows who has fallen silent by now. */
  void refresh(long atMs) {
    nowMs = Math.max(nowMs, atMs);
    fireTableDataChanged();
  }

  boolean isHealthy(int index) {
    Row row = rowAt(index);
    return row.status.state == process_status_t.STATE_READY && !isSilent(row);
  }

  private boolean isSilent(Row row) {
    return nowMs - row.heardAtMs > SILENT_AFTER_MS;
  }

  private Row rowAt(int index) {
    List<Row> all = new ArrayList<>(rows.values());
    return all.get(index);
  }

  @Override
  public int getRowCount() {
    return rows.size();
  }

  @Override
  public int getColumnCount() {
    return COLUMNS.length;
  }

  @Override
  public String getColumnName(int column) {
    return COLUMNS[column];
  }

  @Override
  public Object getValueAt(int index, int column) {
    Row row = rowAt(index);
    process_status_t status = row.status;
    switch (column) {
      case 0:
        return status.process;
      case 1:
        return isSilent(row) ? "SILENT" : stateOf(status.state);
      case 2:
        return status.num_frames_done;
      case 3:
        return status.num_frames_incomplete;
      case 4:
        return status.num_frames_skipped;
      case 5:
        return numMissing(status);
      case 6:
        return numRejected(status);
      case 7:
        return tenths(status.latency_p50_ms);
      case 8:
        return tenths(status.latency_p99_ms);
      case 9:
        return tenths(status.cpu_ms_per_frame);
      case 10:
        return tenths(status.memory_mb);
      case 11:
        return status.version;
      case 12: // the same in each row, unless somebody was built with other message types
        return beginning(status.types_fingerprint);
      case 13:
        return status.waiting_for;
      case 14:
        return status.last_error;
      default: // the newest first, as not all of them fit
        return newestFirst(status.warnings);
    }
  }

  private static long numMissing(process_status_t status) {
    long sum = 0;
    for (channel_status_t channel : status.channels) sum += channel.num_missing;
    return sum;
  }

  private static long numRejected(process_status_t status) {
    long sum = 0;
    for (channel_status_t channel : status.channels) sum += channel.num_rejected;
    return sum;
  }

  private static String newestFirst(String[] texts) {
    StringBuilder all = new StringBuilder();
    for (int i = texts.length - 1; i >= 0; --i) {
      all.append(all.length() == 0 ? "" : " | ").append(texts[i]);
    }
    return all.toString();
  }

  private static String beginning(String text) {
    return text.length() <= SHOWN_OF_TYPES ? text : text.substring(0, SHOWN_OF_TYPES);
  }

  private static String tenths(double value) {
    return String.format(Locale.ROOT, "%.1f", value);
  }

  static String stateOf(byte state) {
    switch (state) {
      case process_status_t.STATE_STARTING:
        return "STARTING";
      case process_status_t.STATE_READY:
        return "READY";
      case process_status_t.STATE_STALLED:
        return "STALLED";
      case process_status_t.STATE_STOPPING:
        return "STOPPING";
      default:
        return "INVALID";
    }
  }
}
