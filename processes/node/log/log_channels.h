#ifndef AIRDOS_PROCESSES_NODE_LOG_LOG_CHANNELS_H_
#define AIRDOS_PROCESSES_NODE_LOG_LOG_CHANNELS_H_

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace airdos {

/// The channels of images and of everything else that comes from outside (as opposed to what the
/// processes compute from it), CAMERA_LEFT first.
const std::vector<std::string>& InputChannels();
bool IsInputChannel(const std::string& channel);
/// Whether it is a channel that the processes compute, with one or more messages per image: those
/// covered by the determinism contract.
bool IsOutputChannel(const std::string& channel);

/// LCM's fingerprint at the start of a message, which identifies its type. Nothing if it is too
/// short.
std::optional<std::int64_t> PeekFingerprint(const void* data, std::size_t size);
/// Name of the type, such as "image_t", or an empty text if it is not one of ours.
std::string TypeOfFingerprint(std::int64_t fingerprint);

/// What a log contains, channel by channel, for messages to the user; in particular, which channel
/// was meant by a name that is not quite ours.
class LogChannels {
 public:
  static constexpr std::size_t kMaxListed = 20;
  /// Limit of names: a hostile log may have a new one in each event.
  static constexpr std::size_t kMaxNames = 1000;

  void Add(const std::string& channel, const void* data, std::size_t size);

  std::int64_t num_messages(const std::string& channel) const;
  /// "CAM (50 messages of image_t, 2600 kB), …", ordered by name, the first kMaxListed.
  std::string List() const;
  /// Another channel that is probably meant by `wanted`: one with the same name up to case,
  /// punctuation, and a prefix or suffix (robot1/camera_left); the shortest such name.
  std::optional<std::string> LookAlike(const std::string& wanted) const;
  /// The channels that our processes publish, ordered by name.
  std::vector<std::string> Outputs() const;
  /// Explains why there is nothing to work on without `wanted`: which channels are read, which ones
  /// the log contains, and what was probably meant.
  std::string ExplainMissing(const std::string& wanted) const;

 private:
  /// What is known about one channel.
  struct Entry {
    std::int64_t num_messages = 0;
    std::int64_t num_bytes = 0;
    std::string type;  // of the first message, if it is one of ours
  };

  std::map<std::string, Entry> entries_;
  Entry others_;  // everything beyond kMaxNames
};

/// ExplainMissing() for a whole log if it has no message on `wanted`; empty if it has one. Reads up
/// to the first such message. Throws InputError if the file is not a log.
std::string ExplainIfMissing(const std::string& path, const std::string& wanted);

}  // namespace airdos

#endif  // AIRDOS_PROCESSES_NODE_LOG_LOG_CHANNELS_H_
