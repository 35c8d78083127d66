#ifndef AIRDOS_PROCESSES_NODE_LOG_LOG_CHANNELS_H_
#define AIRDOS_PROCESSES_NODE_LOG_LOG_CHANNELS_H_

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace airdos {

/// The channels of images and of what else comes from outside (never of what processes made of it),
/// CAMERA_LEFT first.
const std::vector<std::string>& InputChannels();
bool IsInputChannel(const std::string& channel);
/// What the processes made, one message or more for each image: covered by the determinism
/// contract.
bool IsOutputChannel(const std::string& channel);

/// LCM's fingerprint at the head of a message: which type it is of. Nothing if it is too short.
std::optional<std::int64_t> PeekFingerprint(const void* data, std::size_t size);
/// "image_t", or an empty text for a type that is none of ours.
std::string TypeOfFingerprint(std::int64_t fingerprint);

/// What a log holds, channel by channel, for messages to people: above all what was meant by names
/// that are not quite ours.
class LogChannels {
 public:
  static constexpr std::size_t kMaxListed = 20;
  /// More names are not told apart: a hostile log has a new one in each event.
  static constexpr std::size_t kMaxNames = 1000;

  void Add(const std::string& channel, const void* data, std::size_t size);

  std::int64_t num_messages(const std::string& channel) const;
  /// "CAM (50 messages of image_t, 2600 kB), …": by name, the first kMaxListed.
  std::string List() const;
  /// Another channel that probably is `wanted`: of its name but for case, signs, and what stands
  /// before or behind it (robot1/camera_left); the shortest such name.
  std::optional<std::string> LookAlike(const std::string& wanted) const;
  /// Those that processes of ours publish, by name.
  std::vector<std::string> Outputs() const;
  /// Why there is nothing to work on without `wanted`: which channels are read, which the log
  /// holds, what was probably meant.
  std::string ExplainMissing(const std::string& wanted) const;

 private:
  struct Entry {
    std::int64_t num_messages = 0;
    std::int64_t num_bytes = 0;
    std::string type;  // of the first message, if it is ours
  };

  std::map<std::string, Entry> entries_;
  Entry others_;  // all beyond kMaxNames
};

/// What ExplainMissing() says of a whole log if it has no message on `wanted`; empty if it has one.
/// Reads up to the first one. Throws InputError where the file is no log.
std::string ExplainIfMissing(const std::string& path, const std::string& wanted);

}  // namespace airdos

#endif  // AIRDOS_PROCESSES_NODE_LOG_LOG_CHANNELS_H_
