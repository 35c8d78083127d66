#ifndef AIRDOS_PROCESSES_NODE_BUS_PARALLEL_BUS_H_
#define AIRDOS_PROCESSES_NODE_BUS_PARALLEL_BUS_H_

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <exception>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "processes/node/bus/bus.h"
#include "processes/node/bus/serial_place.h"

namespace airdos {

/// A bus with one thread per node. Observers see the same messages as on FifoBus, byte for byte and
/// in the same order; nodes publish the same.
///
/// Order. Each message carries its place on FifoBus (serial_place.h). A node takes in forward
/// messages in the order of their places: it waits until no node upstream can still publish
/// anything earlier (`Bound`). What it publishes follows the last message that it took in, which
/// determines its place in turn. Channels that close a cycle (the optimizer's feedback) cannot be
/// waited for in this way, or the nodes in the cycle would have to take turns. They are taken in
/// only when the node's oldest frame lacks nothing else; the place of the frame then follows the
/// later of the two. For nodes whose output depends only on the content of each channel, this makes
/// no difference.
///
/// No deadlock, bounded memory. Queues are unbounded, so no node ever waits to publish and no cycle
/// can block. Instead, only kFramesInFlight frames are in flight: the source waits until an earlier
/// one has passed all nodes. Every wait ends: forward channels form no cycle (a network in which
/// they do runs in one thread), so among the nodes with a message, the one whose message comes
/// first may take it in, unless it waits for feedback. If all nodes with a message wait for
/// feedback (because upstream frames lack an input), nothing moves; the bus detects this and falls
/// back to serial mode.
///
/// Serial mode: the calling thread delivers messages one at a time in the order of their places,
/// exactly like FifoBus, while the threads wait. It is used where a node may depend on more than
/// the content of each channel: from when frames pile up or nothing moves until no node holds an
/// unfinished frame; for frames with very many messages; and at the end of the input. At a change
/// of session, everything settles first.
///
/// An exception thrown by a node is rethrown by the next call; what the observers have seen by then
/// is a prefix of what FifoBus would show them. Limitation: of two rejections on a channel, one on
/// arrival and one when a frame is processed, either may become the node's last_reject.
class ParallelBus : public Bus {
 public:
  static constexpr std::size_t kFramesInFlight = 4;
  /// Pending frames of one node above which serial mode is used. Far below FrameNode::kMaxPending,
  /// beyond which a node proceeds without what it waits for.
  static constexpr std::size_t kMaxPending = 64;
  static constexpr std::size_t kMaxFrameMessages = 64;

  ParallelBus() = default;
  ~ParallelBus() override;

  void PublishFrame(std::vector<Envelope> frame) override;
  void Settle() override;
  void Finish() override;

  /// Largest number of messages held at any time.
  std::size_t max_held() const { return max_held_; }
  /// How often serial mode was used within a session.
  std::int64_t num_stalls() const { return num_stalls_; }

 private:
  using Lock = std::unique_lock<std::mutex>;
  /// A message and its place in the serial order.
  struct Letter {
    SerialPlace place;
    std::shared_ptr<const Envelope> message;
  };
  /// A node's thread and queues.
  struct Worker {
    std::set<std::string> feedback;         // channels that close a cycle
    std::vector<std::size_t> predecessors;  // nodes that publish its forward channels
    std::deque<Letter> forward;             // ordered by place
    std::deque<Letter> returned;            // feedback, in order of arrival
    SerialPlace now;                        // its next output follows this place
    std::int64_t num_published = 0;         // since `now` last changed
    bool is_busy = false;
    std::set<std::string> awaited;  // feedback that it cannot proceed without
    std::size_t num_pending = 0;
    std::thread thread;
  };

  // Called before the first message.
  void Start();
  std::vector<std::vector<bool>> Reachable(bool without_feedback) const;
  void FindFeedback();
  bool HasCircle() const;
  // These need the lock.
  SerialPlace Bound(std::size_t worker) const;
  SerialPlace NextOutput(std::size_t worker) const;
  bool MayTake(std::size_t worker, const Letter& letter) const;
  std::optional<Letter> Take(std::size_t worker, bool only_look = false);
  void Post(const SerialPlace& place, Envelope message);
  void PostInput(Envelope message);
  bool IsQuiet();
  bool HasRoom();
  bool HasPending() const;
  // These release the lock while the node works.
  void Deliver(std::size_t worker, const Letter& letter, Lock* lock);
  void WorkAndPost(std::size_t worker, const std::function<void()>& work, Lock* lock);
  void RunWorker(std::size_t worker);
  // These run on the calling thread only.
  void ShowFinished(Lock* lock);
  void WaitUntil(const std::function<bool()>& condition, Lock* lock);
  void DeliverRest(Lock* lock);
  void SettleAll(Lock* lock);

  bool has_started_ = false;
  bool has_threads_ = false;
  bool is_serial_ = false;  // in serial mode
  std::optional<std::int64_t> session_;
  std::int64_t num_stalls_ = 0;
  std::size_t max_held_ = 0;

  std::mutex mutex_;  // protects everything below
  std::condition_variable changed_;
  std::vector<std::unique_ptr<Worker>> workers_;                   // in the order of members()
  std::map<SerialPlace, std::shared_ptr<const Envelope>> unseen_;  // not yet shown to the observers
  std::deque<std::int64_t> frame_ends_;  // last input of each frame in flight
  std::int64_t num_inputs_ = 0;
  bool is_calling_thread_at_work_ = false;
  bool must_stop_ = false;
  std::exception_ptr failure_;
};

}  // namespace airdos

#endif  // AIRDOS_PROCESSES_NODE_BUS_PARALLEL_BUS_H_
