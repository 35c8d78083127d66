package airdos.spy;

import java.util.Map;
import java.util.TreeMap;

/** The last messages of one channel in one session, by image number. Not thread-safe. */
final class SeqBuffer<T> {
  static final int CAPACITY = 30;
  /** If image numbers go back by more than this, the source has restarted. */
  static final long RESTART_GAP = 5;

  private final TreeMap<Long, T> messages = new TreeMap<>();
  private long session;

  void add(long messageSession, long seq, T message) {
    boolean restarted = !messages.isEmpty() && seq + RESTART_GAP < messages.lastKey();
    if (messageSession != session || restarted) messages.clear();
    session = messageSession;
    messages.put(seq, message);
    while (messages.size() > CAPACITY) messages.pollFirstEntry();
  }

  boolean isEmpty() {
    return messages.isEmpty();
  }

  long session() {
    return session;
  }

  long newestSeq() {
    return messages.lastKey();
  }

  /** The message for that image, or null. */
  T get(long messageSession, long seq) {
    return messageSession == session ? messages.get(seq) : null;
  }

  /** The newest message whose image number is at most `seq`, or null. */
  Map.Entry<Long, T> atOrBefore(long seq) {
    return messages.floorEntry(seq);
  }
}
