#include "processes/node/fifo_bus.h"

#include <algorithm>
#include <iterator>
#include <sstream>
#include <utility>

#include "common/util/check.h"

namespace airdos {
namespace {

bool Contains(const std::vector<std::string>& list, const std::string& text) {
  return std::find(list.begin(), list.end(), text) != list.end();
}

}  // namespace

void FifoBus::AddNode(Node* node, const std::vector<std::string>& publishes) {
  for (const Member& member : members_) AIRDOS_CHECK(member.node->name() != node->name());
  members_.push_back({node, node->input_channels(), publishes});
}

void FifoBus::Publish(Envelope message) {
  queue_.push_back(std::move(message));
  RunUntilQuiet();
}

void FifoBus::Work(Member* member, const std::function<void()>& work) {
  if (work_observer_ != nullptr) work_observer_->BeforeWork(*member->node);
  work();
  std::vector<Envelope> output = member->node->TakeOutput();
  if (work_observer_ != nullptr) work_observer_->AfterWork(*member->node);
  for (Envelope& message : output) {
    if (!Contains(member->outputs, message.channel)) member->outputs.push_back(message.channel);
    queue_.push_back(std::move(message));
  }
}

void FifoBus::RunUntilQuiet() {
  while (!queue_.empty()) {
    const Envelope message = std::move(queue_.front());
    queue_.pop_front();
    for (const Observer& observer : observers_) observer(message);
    for (Member& member : members_) {
      if (!Contains(member.inputs, message.channel)) continue;
      Node* node = member.node;
      Work(&member,
           [&] { node->Receive(message.channel, message.payload.data(), message.payload.size()); });
      for (bool has_worked = true; has_worked;) {
        Work(&member, [&] { has_worked = node->Step(); });
      }
    }
  }
}

// Follows the channels upstream: a node that has frames waits for what these lack, one that has
// none waits for any of its inputs.
bool FifoBus::WaitsForAnother(const Member& member) const {
  std::istringstream lacking(member.node->waiting_for());
  std::vector<std::string> channels(std::istream_iterator<std::string>(lacking), {});
  for (std::size_t i = 0; i < channels.size(); ++i) {
    for (const Member& other : members_) {
      if (&other == &member || !Contains(other.outputs, channels[i])) continue;
      if (other.node->num_pending() > 0) return true;
      for (const std::string& input : other.inputs) {
        if (!Contains(channels, input)) channels.push_back(input);
      }
    }
  }
  return false;
}

FifoBus::Member* FifoBus::NextToComplete() {
  Member* best = nullptr;
  bool best_waits = true;
  for (Member& member : members_) {
    if (member.node->num_pending() == 0) continue;
    const bool waits = WaitsForAnother(member);
    const bool is_better =
        best == nullptr ||
        (waits != best_waits ? best_waits : member.node->name() < best->node->name());
    if (!is_better) continue;
    best = &member;
    best_waits = waits;
  }
  return best;
}

void FifoBus::Finish() {
  while (Member* member = NextToComplete()) {
    bool has_worked = false;
    Work(member, [&] { has_worked = member->node->CompleteOldest(); });
    AIRDOS_CHECK(has_worked);
    for (bool has_more = true; has_more;) {
      Work(member, [&] { has_more = member->node->Step(); });
    }
    RunUntilQuiet();
  }
}

}  // namespace airdos
