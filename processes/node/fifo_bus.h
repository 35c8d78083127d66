#ifndef AIRDOS_PROCESSES_NODE_FIFO_BUS_H_
#define AIRDOS_PROCESSES_NODE_FIFO_BUS_H_

#include <cstdint>
#include <deque>
#include <functional>
#include <string>
#include <vector>

#include "processes/node/node.h"

namespace airdos {

/// Runs nodes in one process without LCM. A message goes to the observers and to every node that
/// subscribed; what the nodes publish queues behind it. One thread, no clock: the same messages in
/// the same order give the same traffic.
class FifoBus {
 public:
  using Observer = std::function<void(const Envelope&)>;
  /// Told before and after each piece of work of a node, for whoever measures time.
  class WorkObserver {
   public:
    virtual ~WorkObserver() = default;
    virtual void BeforeWork(const Node& node) = 0;
    virtual void AfterWork(const Node& node) = 0;
  };

  /// The node is not owned and outlives the bus. `publishes` names its output channels; Finish()
  /// needs them (those that it published already are known without).
  void AddNode(Node* node, const std::vector<std::string>& publishes = {});
  /// Sees every message, in the order in which they travel.
  void AddObserver(Observer observer) { observers_.push_back(std::move(observer)); }
  void SetWorkObserver(WorkObserver* observer) { work_observer_ = observer; }

  /// Publishes one message and works until all nodes are quiet.
  void Publish(Envelope message);
  /// No more input will come: has frames completed that still wait for some, one at a time, until
  /// nothing waits. First come nodes that wait for nothing another waiting node could still cause,
  /// of several the first by name; so what channels carry does not depend on the order in which
  /// nodes were added.
  void Finish();

 private:
  struct Member {
    Node* node;
    std::vector<std::string> inputs;
    std::vector<std::string> outputs;
  };

  void RunUntilQuiet();
  void Work(Member* member, const std::function<void()>& work);
  Member* NextToComplete();
  bool WaitsForAnother(const Member& member) const;

  std::vector<Member> members_;
  std::vector<Observer> observers_;
  WorkObserver* work_observer_ = nullptr;
  std::deque<Envelope> queue_;
};

}  // namespace airdos

#endif  // AIRDOS_PROCESSES_NODE_FIFO_BUS_H_
