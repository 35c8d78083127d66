#ifndef AIRDOS_PROCESSES_NODE_BUS_BUS_H_
#define AIRDOS_PROCESSES_NODE_BUS_BUS_H_

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "processes/node/node.h"

namespace airdos {

/// Runs nodes in one process without LCM: a message goes to the observers and to every node that
/// subscribed, and so does what the nodes publish. Which messages the observers see, and in which
/// order, depends on what is published only, and is the same for every kind of bus.
class Bus {
 public:
  using Observer = std::function<void(const Envelope&)>;
  /// Told before and after each piece of work of a node, on the thread that does it, for whoever
  /// measures time.
  class WorkObserver {
   public:
    virtual ~WorkObserver() = default;
    virtual void BeforeWork(const Node& node) = 0;
    virtual void AfterWork(const Node& node) = 0;
  };

  Bus() = default;
  virtual ~Bus() = default;
  Bus(const Bus&) = delete;
  Bus& operator=(const Bus&) = delete;

  /// The node is not owned and outlives the bus. `publishes` names its output channels.
  void AddNode(Node* node, const std::vector<std::string>& publishes = {});
  /// Sees every message, in the order in which they travel, on the thread that publishes.
  void AddObserver(Observer observer) { observers_.push_back(std::move(observer)); }
  void SetWorkObserver(WorkObserver* observer) { work_observer_ = observer; }

  /// Publishes the messages of one frame in this order. What they cause may go on when this
  /// returns. Throws what a node or an observer throws; the bus is of no use then.
  virtual void PublishFrame(std::vector<Envelope> frame) = 0;
  /// Returns when all that was published has had its effect.
  virtual void Settle() = 0;
  /// No more input will come: has frames completed that still wait for some, one at a time, until
  /// nothing waits. First come nodes that wait for nothing another waiting node could still cause,
  /// of several the first by name; so what channels carry does not depend on the order in which
  /// nodes were added.
  virtual void Finish() = 0;

 protected:
  struct Member {
    Node* node;
    std::vector<std::string> inputs;
    std::vector<std::string> outputs;
  };

  std::vector<Member>& members() { return members_; }
  const std::vector<Member>& members() const { return members_; }
  void Observe(const Envelope& message) const;
  /// Has the node work and gives what it published.
  std::vector<Envelope> Work(Member* member, const std::function<void()>& work) const;
  /// The node whose oldest frame is to be completed next at the end of the input, if any.
  Member* NextToComplete();

 private:
  bool WaitsForAnother(const Member& member) const;

  std::vector<Member> members_;
  std::vector<Observer> observers_;
  WorkObserver* work_observer_ = nullptr;
};

}  // namespace airdos

#endif  // AIRDOS_PROCESSES_NODE_BUS_BUS_H_
