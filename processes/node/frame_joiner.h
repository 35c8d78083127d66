#ifndef AIRDOS_PROCESSES_NODE_FRAME_JOINER_H_
#define AIRDOS_PROCESSES_NODE_FRAME_JOINER_H_

#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "processes/node/message/header.h"

namespace airdos {

/// Decides, from the numbers of the messages alone, which frame is processed next and when an input
/// can no longer arrive. It uses no clock, so the decision depends only on what each channel
/// carried, not on how the channels interleaved.
///
/// Frames come out in order of (session in order of appearance, seq). On each channel, a frame is
/// overtaken once the channel has carried a later session, or a seq more than `reorder_window`
/// ahead. A message that arrives after that is late, even if its frame still waits for another
/// channel. A frame is settled once each input has arrived or been overtaken, and no older frame
/// can appear any more.
///
/// Limitations: sessions must appear in the same order on every channel. Only the last kMaxSessions
/// are remembered; one that reappears after that many others counts as new.
class FrameJoiner {
 public:
  /// Identifies a frame; ordered by session, then seq.
  struct Key {
    std::int64_t session_rank = 0;
    std::int64_t seq = 0;
    friend bool operator<(const Key& a, const Key& b) {
      return a.session_rank != b.session_rank ? a.session_rank < b.session_rank : a.seq < b.seq;
    }
  };
  /// What became of a message.
  enum class Arrival {
    kNew,
    kDuplicate,
    kLate,
    kTooFar,  ///< more than kMaxAhead beyond its channel: invalid, or all that follow would be late
  };
  static constexpr std::int64_t kMaxAhead = 1000000;
  static constexpr std::size_t kMaxSessions = 1000;
  /// A frame and what it lacks.
  struct Frame {
    Key key;
    Header header;             ///< of the first input, in order of the inputs, that has arrived
    std::vector<int> missing;  ///< inputs that have not arrived
    std::vector<int> awaited;  ///< those of the missing inputs that have not been overtaken
    bool settled = false;
  };

  FrameJoiner(int num_inputs, int reorder_window);

  /// Records that input number `input` of a frame has arrived.
  Arrival Add(int input, const Header& header, Key* key);
  /// Records that input number `input` has begun to arrive, in parts; Add() tells when it is
  /// complete. Returns kDuplicate if it is complete already.
  Arrival Announce(int input, const Header& header, Key* key);
  /// The oldest frame that is not done, if any.
  std::optional<Frame> Oldest() const;
  /// The newest frame that has all its inputs, but for the `num_newer` newest ones that have, if
  /// any.
  std::optional<Key> NewestComplete(int num_newer = 0) const;
  /// Marks the oldest frame as done; sets `num_skipped` to the number of image numbers between it
  /// and the previous frame that never came.
  void FinishOldest(std::int64_t* num_skipped);
  std::size_t num_pending() const { return pending_.size(); }

  std::size_t num_sessions_known() const { return session_ranks_.size(); }

 private:
  /// A frame that is not done.
  struct Pending {
    Header header;
    std::size_t header_input = 0;  // input that the header is from
    std::vector<bool> arrived;
  };

  std::int64_t RankOf(std::int64_t session);
  /// Whether nothing older than or equal to `key` can still arrive on the channel of `input`.
  bool IsOvertaken(std::size_t input, const Key& key) const;
  /// Whether a frame between the last one done and `key` can still appear.
  bool MayHavePredecessor(const Key& key) const;

  std::size_t num_inputs_;
  std::int64_t reorder_window_;
  std::map<std::int64_t, std::int64_t> session_ranks_;  // number of sessions before each one
  std::int64_t num_sessions_ = 0;
  std::vector<std::optional<Key>> newest_;  // per input
  std::map<Key, Pending> pending_;
  std::optional<Key> last_done_;
};

}  // namespace airdos

#endif  // AIRDOS_PROCESSES_NODE_FRAME_JOINER_H_
