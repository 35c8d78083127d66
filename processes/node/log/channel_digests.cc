#include "processes/node/log/channel_digests.h"

#include "common/util/digest.h"
#include "processes/node/log/log_source.h"

namespace airdos {

void ChannelDigests::Add(const std::string& channel, const void* data, std::size_t size) {
  Channel& entry = channels_[channel];
  const Header header = PeekHeader(data, size).value_or(Header{});
  const std::size_t rank =
      entry.session_ranks.try_emplace(header.session, entry.session_ranks.size()).first->second;
  Digest digest;
  digest.Add(data, size);
  entry.payload_digests[{rank, header.seq}].push_back(digest.Hex());
}

std::map<std::string, ChannelDigests::Entry> ChannelDigests::Result() const {
  std::map<std::string, Entry> result;
  for (const auto& [name, channel] : channels_) {
    Digest digest;
    Entry& entry = result[name];
    for (const auto& [key, payload_digests] : channel.payload_digests) {
      for (const std::string& payload_digest : payload_digests) {
        digest.Add(payload_digest.data(), payload_digest.size());
        ++entry.num_messages;
      }
    }
    entry.sha256 = digest.Hex();
  }
  return result;
}

}  // namespace airdos
