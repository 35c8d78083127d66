#ifndef AIRDOS_PROCESSES_NODE_BUS_FIFO_BUS_H_
#define AIRDOS_PROCESSES_NODE_BUS_FIFO_BUS_H_

#include <deque>
#include <vector>

#include "processes/node/bus/bus.h"

namespace airdos {

/// A bus of one thread: what the nodes publish queues behind the message that caused it. No clock:
/// the same messages in the same order give the same traffic. Finish() needs the output channels of
/// the nodes (those on which one published already are known without).
class FifoBus : public Bus {
 public:
  /// Publishes one message and works until all nodes are quiet.
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
