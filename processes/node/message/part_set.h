#ifndef AIRDOS_PROCESSES_NODE_MESSAGE_PART_SET_H_
#define AIRDOS_PROCESSES_NODE_MESSAGE_PART_SET_H_

#include <map>
#include <string>
#include <utility>
#include <vector>

namespace airdos {

/// The parts of what travels as several messages, because one would be too large: numbered `part` =
/// 0 .. `num_parts` - 1 (Validate() sees to that), in whatever order they come.
template <class Message>
class PartSet {
 public:
  /// Takes a part in. Where it does not go with those that came before, which stay, it returns why
  /// not, in words; else an empty text.
  std::string Add(Message&& message) {
    const int part = message.part;
    if (!parts_.empty() && parts_.begin()->second.num_parts != message.num_parts) {
      return "num_parts " + std::to_string(message.num_parts) +
             " differs from that of another part";
    }
    if (!parts_.emplace(part, std::move(message)).second) {
      return "part " + std::to_string(part) + " came twice";
    }
    return "";
  }

  bool empty() const { return parts_.empty(); }
  bool is_complete() const {
    return !parts_.empty() &&
           static_cast<int>(parts_.size()) == static_cast<int>(parts_.begin()->second.num_parts);
  }
  /// Those that came, in order of `part`. None are left.
  std::vector<Message> Take() {
    std::vector<Message> taken;
    for (auto& [number, part] : std::exchange(parts_, {})) taken.push_back(std::move(part));
    return taken;
  }

 private:
  std::map<int, Message> parts_;
};

}  // namespace airdos

#endif  // AIRDOS_PROCESSES_NODE_MESSAGE_PART_SET_H_
