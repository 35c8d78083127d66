#ifndef AIRDOS_PROCESSES_NODE_BUS_FIFO_BUS_H_
#define AIRDOS_PROCESSES_NODE_BUS_FIFO_BUS_H_

#include <deque>
#include <vector>

#include "processes/node/bus/bus.h"

namespace airdos {

/// A single-threaded bus: what the nodes publish is queued after the message that caused it. It has
/// no clock: the same messages in the same order cause the same traffic. Finish() needs to know the
/// nodes' output channels (those on which a node has already published are known anyway).
class FifoBus : public Bus {
 public:
  /// Publishes one message and runs until all nodes are idle.
  void Publish(Envelope message);

  void PublishFrame(std::vector<Envelope> frame) override;
  void Settle() override {}
  void Finish() override;

 private:
  void RunUntilQuiet();
  void WorkAndQueue(Member* member, const std::function<void()>& work);

  std::deque<Envelope> queue_;
};

}  // namespace airdos

#endif  // AIRDOS_PROCESSES_NODE_BUS_FIFO_BUS_H_
