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

/// A bus with a thread for each node. Observers see the messages that FifoBus shows them, byte for
/// byte and in the same order; nodes publish the same.
///
/// Order. Every message carries the place it has on FifoBus (serial_place.h). A node takes in what
/// comes forward in order of places: it waits until no node before it can still publish something
/// earlier (`Bound`). What it publishes follows the last message it took in, which gives its place
/// in turn. Channels that close a circle (the optimizer's feedback) cannot be waited for in this
/// way, or the nodes of the circle would take turns. They are taken in only when the node's oldest
/// frame lacks nothing else; the frame's place follows the later of the two. For nodes whose output
/// depends on the content of each channel alone that changes nothing.
///
/// No deadlock, bounded memory. Queues have no bound of their own, so no node ever waits to publish
/// and no circle can block; instead only kFramesInFlight frames are under way: the source waits
/// until an earlier one has passed all nodes. Every wait ends: forward channels form no circle (a
/// network where they do is run in one thread), so of the nodes that have something, the one whose
/// message stands earliest may take it in, unless it waits for feedback. If all nodes that have
/// something wait for feedback (frames upstream lack an input), nothing moves: the bus sees that
/// and takes the serial way.
///
/// The serial way: the calling thread carries messages one by one in order of places, exactly as
/// FifoBus does, while the threads wait. It is taken where nodes may look at more than the content
/// of a channel: when frames pile up or nothing moves, until no node holds an unfinished frame; for
/// frames of very many messages; and at the end of the input. At the change of session all settles.
///
/// An exception of a node is thrown by the next call; what the observers saw until then is the
/// beginning of what FifoBus shows them. Limit: of two rejections on a channel, one on arrival and
/// one when a frame is worked on, either may be the node's last_reject.
class ParallelBus : public Bus {
 public:
  static constexpr std::size_t kFramesInFlight = 4;
  /// Of one node; more than that, and the serial way is taken. Far below FrameNode::kMaxPending,
  /// beyond which a node goes on without what it waits for.
  static constexpr std::size_t kMaxPending = 64;
  static constexpr std::size_t kMaxFrameMessages = 64;

  ParallelBus() = default;
  ~ParallelBus() override;

  void PublishFrame(std::vector<Envelope> frame) override;
  void Settle() override;
  void Finish() override;

  /// Most messages that were ever held at a time.
  std::size_t max_held() const { return max_held_; }
  /// How often the serial way was taken within a session.
  std::int64_t num_stalls() const { return num_stalls_; }

 private:
  using Lock = std::unique_lock<std::mutex>;
  struct Letter {
    SerialPlace place;
    std::shared_ptr<const Envelope> message;
  };
  struct Worker {
    std::set<std::string> feedback;         // channels that close a circle
    std::vector<std::size_t> predecessors;  // that publish what comes forward
    std::deque<Letter> forward;             // in order of places
    std::deque<Letter> returned;            // feedback, in order of arrival
    SerialPlace now;                        // what it publishes follows this
    std::int64_t num_published = 0;         // since `now` changed
    bool is_busy = false;
    std::set<std::string> awaited;  // feedback without which it does not go on
    std::size_t num_pending = 0;
    std::thread thread;
  };

  // Before the first message.
  void Start();
  std::vector<std::vector<bool>> Reachable(bool without_feedback) const;
  void FindFeedback();
  bool HasCircle() const;
  // With the lock held.
  SerialPlace Bound(std::size_t worker) const;
  SerialPlace NextOutput(std::size_t worker) const;
  bool MayTake(std::size_t worker, const Letter& letter) const;
  std::optional<Letter> Take(std::size_t worker, bool only_look = false);
  void Post(const SerialPlace& place, Envelope message);
  void PostInput(Envelope message);
  bool IsQuiet();
  bool HasRoom();
  bool HasPending() const;
  // Gives the lock back while the node works.
  void Deliver(std::size_t worker, const Letter& letter, Lock* lock);
  void WorkAndPost(std::size_t worker, const std::function<void()>& work, Lock* lock);
  void RunWorker(std::size_t worker);
  // On the calling thread only.
  void ShowFinished(Lock* lock);
  void WaitUntil(const std::function<bool()>& condition, Lock* lock);
  void DeliverRest(Lock* lock);
  void SettleAll(Lock* lock);

  bool has_started_ = false;
  bool has_threads_ = false;
  bool is_serial_ = false;  // the serial way is taken
  std::optional<std::int64_t> session_;
  std::int64_t num_stalls_ = 0;
  std::size_t max_held_ = 0;

  std::mutex mutex_;  // of all below
  std::condition_variable changed_;
  std::vector<std::unique_ptr<Worker>> workers_;                   // as members()
  std::map<SerialPlace, std::shared_ptr<const Envelope>> unseen_;  // by the observers
  std::deque<std::int64_t> frame_ends_;  // last input of each frame under way
  std::int64_t num_inputs_ = 0;
  bool is_calling_thread_at_work_ = false;
  bool must_stop_ = false;
  std::exception_ptr failure_;
};

}  // namespace airdos

#endif  // AIRDOS_PROCESSES_NODE_BUS_PARALLEL_BUS_H_
