#include "processes/node/bus/bus.h"

#include <algorithm>
#include <iterator>
#include <sstream>

#include "common/util/check.h"

namespace airdos {
namespace {

bool Contains(const std::vector<std::string>& list, const std::string& text) {
  return std::find(list.begin(), list.end(), text) != list.end();
}

}  // namespace

void Bus::AddNode(Node* node, const std::vector<std::string>& publishes) {
  for (const Member& member : members_) AIRDOS_CHECK(member.node->name() != node->name());
  members_.push_back({node, node->input_channels(), publishes});
}

void Bus::Observe(const Envelope& message) const {
  for (const Observer& observer : observers_) observer(message);
}

std::vector<Envelope> Bus::Work(Member* member, const std::function<void()>& work) const {
  if (work_observer_ != nullptr) work_observer_->BeforeWork(*member->node);
  work();
  std::vector<Envelope> output = member->node->TakeOutput();
  if (work_observer_ != nullptr) work_observer_->AfterWork(*member->node);
  for (const Envelope& message : output) {
    if (!Contains(member->outputs, message.channel)) member->outputs.push_back(message.channel);
  }
  return output;
}

// Follows the channels upstream: a node that has frames waits for the inputs that these lack; a
// node without frames waits for any of its inputs.
bool Bus::WaitsForAnother(const Member& member) const {
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

Bus::Member* Bus::NextToComplete() {
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

}  // namespace airdos
