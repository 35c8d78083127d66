#ifndef AIRDOS_PROCESSES_NODE_LIVE_OWN_OUTPUT_H_
#define AIRDOS_PROCESSES_NODE_LIVE_OWN_OUTPUT_H_

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <string>

namespace airdos {

/// Distinguishes this process's own messages from those that others publish on the same channels.
/// LCM delivers every message to its publisher as well, so each must come back exactly once.
/// Whatever comes back more often, or was never published, is somebody else's: another process of
/// the same kind, or a log that contains outputs, possibly with identical bytes.
///
/// Until this process has published something, foreign messages are tolerated: a killed process
/// that it replaces may have left messages in transit. A network that duplicates a message now and
/// then is tolerated as well.
class OwnOutput {
 public:
  /// Messages remembered per channel: far more than LCM's queue holds.
  static constexpr std::size_t kMaxRemembered = 4096;
  /// Up to this many duplicates, each within kDoubledWithin messages of the previous one, may be
  /// accidental.
  static constexpr int kMaxDoubled = 2;
  static constexpr int kDoubledWithin = 100;

  /// Records a message that this process is about to publish.
  void AddSaid(const std::string& channel, const void* data, std::size_t size);
  /// Records a received message. Returns whether it is somebody else's.
  bool IsForeign(const std::string& channel, const void* data, std::size_t size);

 private:
  /// What is expected to come back on one channel.
  struct Channel {
    std::deque<std::size_t> order;               // hashes, oldest first
    std::map<std::size_t, int> num_to_be_heard;  // by hash; negative if heard more often than said
    int num_doubled = 0;
    int num_said_since = 0;  // since the last duplicate
  };
  std::map<std::string, Channel> channels_;
  bool has_spoken_ = false;
};

}  // namespace airdos

#endif  // AIRDOS_PROCESSES_NODE_LIVE_OWN_OUTPUT_H_
