#include "processes/node/bus/fifo_bus.h"

#include <algorithm>
#include <utility>

#include "common/util/check.h"

namespace airdos {

void FifoBus::Publish(Envelope message) {
  queue_.push_back(std::move(message));
  RunUntilQuiet();
}

void FifoBus::PublishFrame(std::vector<Envelope> frame) {
  for (Envelope& message : frame) Publish(std::move(message));
}

void FifoBus::WorkAndQueue(Member* member, const std::function<void()>& work) {
  for (Envelope& message : Work(member, work)) queue_.push_back(std::move(message));
}

void FifoBus::RunUntilQuiet() {
  while (!queue_.empty()) {
    const Envelope message = std::move(queue_.front());
    queue_.pop_front();
    Observe(message);
    for (Member& member : members()) {
      const auto& inputs = member.inputs;
      if (std::find(inputs.begin(), inputs.end(), message.channel) == inputs.end()) continue;
      Node* node = member.node;
      WorkAndQueue(&member, [&] {
        node->Receive(message.channel, message.payload.data(), message.payload.size());
      });
      for (bool has_worked = true; has_worked;) {
        WorkAndQueue(&member, [&] { has_worked = node->Step(); });
      }
    }
  }
}

void FifoBus::Finish() {
  while (Member* member = NextToComplete()) {
    bool has_worked = false;
    WorkAndQueue(member, [&] { has_worked = member->node->CompleteOldest(); });
    AIRDOS_CHECK(has_worked);
    for (bool has_more = true; has_more;) {
      WorkAndQueue(member, [&] { has_more = member->node->Step(); });
    }
    RunUntilQuiet();
  }
}

}  // namespace airdos
