#ifndef AIRDOS_PROCESSES_NODE_FRAME_JOINER_H_
#define AIRDOS_PROCESSES_NODE_FRAME_JOINER_H_

#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "processes/node/message/header.h"

namespace airdos {

/// Decides, from the numbers of the messages alone, which frame is to be worked on next and when an
/// input of it is never to come. It sees no clock, so that the decision depends only on what each
/// channel carried and not on how the channels interleaved.
///
/// Frames come out in order of (session in order of appearance, seq). On each channel, a frame is
/// overtaken once the channel carried a later session, or a seq more than `reorder_window` ahead; a
/// message that comes after that is late, even if its frame still waits for another channel. A
/// frame is settled once each input has arrived or has been overtaken, and no older frame can
/// appear any more.
///
/// Limits: the sessions must appear in the same order on every channel. Only the last kMaxSessions
/// are remembered; one that comes back after as many others is a new one.
class FrameJoiner {
 public:
  struct Key {
    std::int64_t session_rank = 0;
    std::int64_t seq = 0;
    friend bool operator<(const Key& a, const Key& b) {
      return a.session_rank != b.session_rank ? a.session_rank < b.session_rank : a.seq < b.seq;
    }
  };
  enum class Arrival {
    kNew,
    kDuplicate,
    kLate,
    kTooFar,  ///< more than kMaxAhead beyond its channel: nonsense, or all that follows were late
  };
  static constexpr std::int64_t kMaxAhead = 1000000;
  static constexpr std::size_t kMaxSessions = 1000;
  struct Frame {
    Key key;
    Header header;  ///< of the first input that has arrived: which one was faster is no matter
    std::vector<int> missing;  ///< inputs that have not arrived
    std::vector<int> awaited;  ///< of these, the ones that have not been overtaken
    bool settled = false;
  };

  FrameJoiner(int num_inputs, int reorder_window);

  /// Notes that input number `input` of a frame arrived.
  Arrival Add(int input, const Header& header, Key* key);
  /// Notes that input number `input` has begun to arrive, in parts; Add() tells when it is whole.
  /// kDuplicate: it is whole already.
  Arrival Announce(int input, const Header& header, Key* key);
  /// The oldest frame that is not done, if any.
  std::optional<Frame> Oldest() const;
  /// The newest frame that has all its inputs, if any.
  std::optional<Key> NewestComplete() const;
  /// Marks the oldest frame as done; `num_skipped` becomes how many image numbers between it and
  /// the frame before never came.
  void FinishOldest(std::int64_t* num_skipped);
  std::size_t num_pending() const { return pending_.size(); }

  std::size_t num_sessions_known() const { return session_ranks_.size(); }

 private:
  struct Pending {
    Header header;
    std::size_t header_input = 0;  // whose it is
    std::vector<bool> arrived;
  };

  std::int64_t RankOf(std::int64_t session);
  /// Whether nothing older than or equal to `key` can come on the channel of `input` any more.
  bool IsOvertaken(std::size_t input, const Key& key) const;
  /// Whether a frame between the last one that is done and `key` could still appear.
  bool MayHavePredecessor(const Key& key) const;

  std::size_t num_inputs_;
  std::int64_t reorder_window_;
  std::map<std::int64_t, std::int64_t> session_ranks_;  // by session: how many appeared before it
  std::int64_t num_sessions_ = 0;
  std::vector<std::optional<Key>> newest_;  // per input
  std::map<Key, Pending> pending_;
  std::optional<Key> last_done_;
};

}  // namespace airdos

#endif  // AIRDOS_PROCESSES_NODE_FRAME_JOINER_H_
