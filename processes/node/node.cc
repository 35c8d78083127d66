#include "processes/node/node.h"

#include <exception>

namespace airdos {
namespace {

constexpr std::size_t kMaxTextBytes = 500;  // STATUS does not take much longer texts

}  // namespace

std::vector<std::string> Node::input_channels() const {
  std::vector<std::string> names;
  for (const auto& [channel, handler] : handlers_) names.push_back(channel);
  return names;
}

void Node::Receive(const std::string& channel, const void* data, std::size_t size) {
  const auto it = handlers_.find(channel);
  if (it == handlers_.end()) return;
  ++counters(channel).num_received;
  num_bytes_received_ = size;
  std::string reason;
  try {
    reason = it->second(data, size);
  } catch (const std::exception& error) {
    reason = error.what();
  }
  if (!reason.empty()) Reject(channel, reason);
}

void Node::Reject(const std::string& channel, const std::string& reason) {
  ++counters(channel).num_rejected;
  counters(channel).last_reject = reason.substr(0, kMaxTextBytes);
}

void Node::Warn(const std::string& warning) {
  const std::string text = warning.substr(0, kMaxTextBytes);
  warnings_.push_back(text);
  if (warnings_.size() > kMaxWarnings) warnings_.pop_front();
  // Bounded as well, for owners that never fetch them.
  if (new_warnings_.size() < kMaxWarnings) new_warnings_.push_back(text);
}

std::vector<std::string> Node::TakeWarnings() { return std::exchange(new_warnings_, {}); }

std::vector<Envelope> Node::TakeOutput() { return std::exchange(output_, {}); }

}  // namespace airdos
