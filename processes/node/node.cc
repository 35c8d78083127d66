#include "processes/node/node.h"

#include <exception>

namespace airdos {

std::vector<std::string> Node::input_channels() const {
  std::vector<std::string> names;
  for (const auto& [channel, handler] : handlers_) names.push_back(channel);
  return names;
}

void Node::Receive(const std::string& channel, const void* data, std::size_t size) {
  const auto it = handlers_.find(channel);
  if (it == handlers_.end()) return;
  ChannelCounters& counters = channels_[channel];
  ++counters.num_received;
  num_bytes_received_ = size;
  std::string reason;
  try {
    reason = it->second(data, size);
  } catch (const std::exception& error) {
    reason = error.what();
  }
  if (reason.empty()) return;
  ++counters.num_rejected;
  counters.last_reject = reason.substr(0, 500);  // STATUS takes no text that is much longer
}

std::vector<Envelope> Node::TakeOutput() { return std::exchange(output_, {}); }

}  // namespace airdos
