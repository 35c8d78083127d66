#include "processes/node/live/own_output.h"

#include <functional>
#include <string_view>

namespace airdos {
namespace {

std::size_t HashOf(const void* data, std::size_t size) {
  return std::hash<std::string_view>()({static_cast<const char*>(data), size});
}

}  // namespace

void OwnOutput::AddSaid(const std::string& channel, const void* data, std::size_t size) {
  has_spoken_ = true;
  Channel& said = channels_[channel];
  const std::size_t hash = HashOf(data, size);
  if (said.num_to_be_heard.try_emplace(hash, 0).second) said.order.push_back(hash);
  ++said.num_to_be_heard[hash];
  if (++said.num_said_since > kDoubledWithin) said.num_doubled = 0;
  if (said.order.size() <= kMaxRemembered) return;
  said.num_to_be_heard.erase(said.order.front());
  said.order.pop_front();
}

bool OwnOutput::IsForeign(const std::string& channel, const void* data, std::size_t size) {
  if (!has_spoken_) return false;
  Channel& said = channels_[channel];
  const auto entry = said.num_to_be_heard.find(HashOf(data, size));
  if (entry == said.num_to_be_heard.end()) return true;
  if (--entry->second >= 0) return false;
  said.num_said_since = 0;
  return ++said.num_doubled > kMaxDoubled;
}

}  // namespace airdos
