#include <cstdint>
#include <iomanip>
#include <iostream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "processes/node/message/codec.h"
#include "tests/support/sample_messages.h"

// What the C++ codec says of a message, for the test of the Python one. Reads lines "TYPE HEX" and
// answers each with the hex of the message decoded and encoded again, "no" if it does not decode,
// "cannot" if it decodes but cannot be encoded (a text with a zero in it). "TYPE" alone asks for a
// sample.

namespace airdos {
namespace {

using Bytes = std::vector<std::uint8_t>;

std::string ToHex(const Bytes& bytes) {
  std::ostringstream text;
  text << std::hex << std::setfill('0');
  for (const std::uint8_t byte : bytes) text << std::setw(2) << static_cast<int>(byte);
  return text.str();
}

Bytes FromHex(const std::string& text) {
  Bytes bytes;
  for (std::size_t i = 0; i + 1 < text.size(); i += 2) {
    bytes.push_back(static_cast<std::uint8_t>(std::stoi(text.substr(i, 2), nullptr, 16)));
  }
  return bytes;
}

template <class Message>
std::string Judge(const std::string& hex) {
  if (hex.empty()) return ToHex(Encode(Sample<Message>()));
  const Bytes bytes = FromHex(hex);
  Message message = {};
  if (!Decode(bytes.data(), bytes.size(), &message)) return "no";
  try {
    return ToHex(Encode(message));
  } catch (const std::length_error&) {
    return "cannot";
  }
}

/// Tries the types in turn; an empty text if none has this name.
template <class Message, class... Others>
std::string JudgeAs(const std::string& type, const std::string& hex) {
  if (type == Message::getTypeName()) return Judge<Message>(hex);
  if constexpr (sizeof...(Others) > 0) return JudgeAs<Others...>(type, hex);
  return "";
}

/// The same for all types of channels.
std::string JudgeAll(const std::string& type, const std::string& hex) {
  return JudgeAs<image_t, stereo_calibration_t, person_keypoints_t, person_mask_t,
                 static_features_t, human_observations_t, state_estimate_t, map_update_t, pose_t,
                 frame_done_t, process_status_t>(type, hex);
}

}  // namespace
}  // namespace airdos

int main() {
  for (std::string line; std::getline(std::cin, line);) {
    std::istringstream words(line);
    std::string type, hex;
    words >> type >> hex;
    std::cout << airdos::JudgeAll(type, hex) << std::endl;
  }
  return 0;
}
