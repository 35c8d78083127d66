#ifndef AIRDOS_PROCESSES_NODE_BUS_BUS_H_
#define AIRDOS_PROCESSES_NODE_BUS_BUS_H_

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "processes/node/node.h"

namespace airdos {

/// Runs nodes in one process without LCM: a message goes to the observers and to every subscribed
/// node, and so does whatever the nodes publish. Which messages the observers see, and in which
/// order, depends only on what is published and is the same for every kind of bus.
class Bus {
 public:
  using Observer = std::function<void(const Envelope&)>;
  /// Notified before and after each piece of work of a node, on the thread that does it, for
  /// measuring time.
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

  /// The node is not owned and must outlive the bus. `publishes` names its output channels.
  void AddNode(Node* node, const std::vector<std::string>& publishes = {});
  /// The observer sees every message, in the order in which they travel, on the publishing thread.
  void AddObserver(Observer observer) { observers_.push_back(std::move(observer)); }
  void SetWorkObserver(WorkObserver* observer) { work_observer_ = observer; }

  /// Publishes the messages of one frame in this order. Their consequences may continue after this
  /// returns. Throws what a node or an observer throws; the bus is then unusable.
  virtual void PublishFrame(std::vector<Envelope> frame) = 0;
  /// Returns once everything published has had its effect.
  virtual void Settle() = 0;
  /// Call this when there is no more input. Completes the frames that still wait for some, one at a
  /// time, until nothing waits. Nodes that wait for nothing that another waiting node could still
  /// cause come first, in order of name, so the result does not depend on the order in which nodes
  /// were added.
  virtual void Finish() = 0;

 protected:
  /// A node with its channels.
  struct Member {
    Node* node;
    std::vector<std::string> inputs;
    std::vector<std::string> outputs;
  };

  std::vector<Member>& members() { return members_; }
  const std::vector<Member>& members() const { return members_; }
  void Observe(const Envelope& message) const;
  /// Lets the node work and returns what it published.
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
