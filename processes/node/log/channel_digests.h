#ifndef AIRDOS_PROCESSES_NODE_LOG_CHANNEL_DIGESTS_H_
#define AIRDOS_PROCESSES_NODE_LOG_CHANNEL_DIGESTS_H_

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace airdos {

/// Digests of what each channel carried, regardless of how the channels interleaved: per channel,
/// the SHA-256 over the SHA-256 (hexadecimal) of each payload, ordered by session (in order of
/// appearance), seq and arrival.
class ChannelDigests {
 public:
  /// Number of messages on a channel, and their digest.
  struct Entry {
    std::int64_t num_messages = 0;
    std::string sha256;
  };
  void Add(const std::string& channel, const void* data, std::size_t size);
  std::map<std::string, Entry> Result() const;

 private:
  using Key = std::pair<std::size_t, std::int64_t>;  // rank of the session, seq
  struct Channel {
    std::map<std::int64_t, std::size_t> session_ranks;  // in order of appearance
    std::map<Key, std::vector<std::string>> payload_digests;
  };
  std::map<std::string, Channel> channels_;
};

}  // namespace airdos

#endif  // AIRDOS_PROCESSES_NODE_LOG_CHANNEL_DIGESTS_H_
