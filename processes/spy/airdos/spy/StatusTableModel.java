package airdos.spy;

import airdos.channel_status_t;
import airdos.process_status_t;
import java.util.ArrayList;
import java.util.List;
import java.util.Locale;
import java.util.Map;
import java.util.TreeMap;
import java.util.function.Function;
import javax.swing.table.AbstractTableModel;

/** One row per process, from its last STATUS. For Swing's thread only. */
final class StatusTableModel extends AbstractTableModel {
  /** A process publishes every second; after this long its row shows that it has stopped. */
  static final long SILENT_AFTER_MS = 3000;

  /** In order of importance to the user. */
  enum Column {
    PROCESS("process", 110, status -> status.process),
    STATE("state", 75, status -> stateOf(status.state)),
    WAITING_FOR("waiting for", 170, status -> status.waiting_for),
    WARNINGS("warnings", 300, status -> newestFirst(status.warnings)), // not all of them fit
    LAST_ERROR("last error", 120, status -> status.last_error),
    FRAMES("frames", 52, status -> status.num_frames_done),
    INCOMPLETE("incomplete", 75, status -> status.num_frames_incomplete),
    SKIPPED("skipped", 55, status -> status.num_frames_skipped),
    MISSING("missing", 55, StatusTableModel::numMissing),
    REJECTED("rejected", 58, StatusTableModel::numRejected),
    P50("p50 ms", 52, status -> tenths(status.latency_p50_ms)),
    P99("p99 ms", 52, status -> tenths(status.latency_p99_ms)),
    CPU("cpu ms/frame", 90, status -> tenths(status.cpu_ms_per_frame)),
    MEMORY("memory MB", 80, status -> tenths(status.memory_mb)),
    VERSION("version", 50, status -> status.version),
    /** The same in every row, unless a process was built with different message types. */
    TYPES("types", 82, status -> beginning(status.types_fingerprint));

    final String title;
    final int widthPx;
    private final Function<process_status_t, Object> value;

    Column(String title, int widthPx, Function<process_status_t, Object> value) {
      this.title = title;
      this.widthPx = widthPx;
      this.value = value;
    }
  }

  /** Digits of a fingerprint shown: enough to distinguish two. */
  private static final int SHOWN_OF_TYPES = 8;

  private static final class Row {
    process_status_t status;
    long heardAtMs;
  }

  /** Limit, so that invented process names cannot fill the memory. */
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

  /** Updates which processes have fallen silent. */
  void refresh(long atMs) {
    nowMs = Math.max(nowMs, atMs);
    fireTableDataChanged();
  }

  boolean isHealthy(int index) {
    Row row = rowAt(index);
    return row.status.state == process_status_t.STATE_READY && !isSilent(row);
  }

  boolean hasWarnings(int index) {
    return rowAt(index).status.warnings.length > 0;
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
    return Column.values().length;
  }

  @Override
  public String getColumnName(int column) {
    return Column.values()[column].title;
  }

  @Override
  public Object getValueAt(int index, int column) {
    Row row = rowAt(index);
    if (column == Column.STATE.ordinal() && isSilent(row)) return "SILENT";
    return Column.values()[column].value.apply(row.status);
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
