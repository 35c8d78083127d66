#ifndef AIRDOS_PROCESSES_NODE_LIVE_OWN_OUTPUT_H_
#define AIRDOS_PROCESSES_NODE_LIVE_OWN_OUTPUT_H_

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <string>

namespace airdos {

/// Tells what this process said from what somebody else says on the same channels. LCM hands every
/// message back to whoever published it, so each must be heard once; what is heard more often, or
/// was never said, is of somebody else: another process of the same kind, or a log that also holds
/// outputs, whose bytes may well be the same.
///
/// Before this process has said anything it takes no offence: a process that was killed, and whose
/// place it took, may have had messages on their way. A network that doubles a message now and then
/// is none either.
class OwnOutput {
 public:
  /// Messages of each channel that are remembered: far more than wait in LCM's queue.
  static constexpr std::size_t kMaxRemembered = 4096;
  /// So many that are heard twice, each within kDoubledWithin messages of the one before, may be an
  /// accident.
  static constexpr int kMaxDoubled = 2;
  static constexpr int kDoubledWithin = 100;

  /// A message that this process is about to publish.
  void AddSaid(const std::string& channel, const void* data, std::size_t size);
  /// A message that was heard. Whether it is of somebody else.
  bool IsForeign(const std::string& channel, const void* data, std::size_t size);

 private:
  struct Channel {
    std::deque<std::size_t> order;               // of the hashes, oldest first
    std::map<std::size_t, int> num_to_be_heard;  // by hash; below 0: more often than said
    int num_doubled = 0;
    int num_said_since = 0;  // the last one was heard twice
  };
  std::map<std::string, Channel> channels_;
  bool has_spoken_ = false;
};

}  // namespace airdos

#endif  // AIRDOS_PROCESSES_NODE_LIVE_OWN_OUTPUT_H_
