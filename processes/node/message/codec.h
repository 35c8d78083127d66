#ifndef AIRDOS_PROCESSES_NODE_MESSAGE_CODEC_H_
#define AIRDOS_PROCESSES_NODE_MESSAGE_CODEC_H_

#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <vector>

#include "airdos/image_t.hpp"
#include "airdos/person_mask_t.hpp"

// Installed as airdos/codec.h, for users who have nothing else of this tree: it includes the types
// only.

namespace airdos {

/// Bytes of one LCM message of a generated type. Throws std::length_error where a list is shorter
/// than its count says, or a count is negative: the caller's mistake.
template <class Message>
std::vector<std::uint8_t> Encode(const Message& message) {
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(message.getEncodedSize()));
  const int size = message.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
  if (size != static_cast<int>(bytes.size())) throw std::length_error(Message::getTypeName());
  return bytes;
}

/// Larger messages are refused before they are decoded, as vectors of structures take up to twenty
/// times the room of their bytes. Ours stay below 128 kB; images may be raw and of 12 megapixels.
inline constexpr std::size_t kMaxImageMessageBytes = 40u << 20;
inline constexpr std::size_t kMaxOtherMessageBytes = 1u << 20;
template <class Message>
inline constexpr std::size_t kMaxMessageBytes = kMaxOtherMessageBytes;
template <>
inline constexpr std::size_t kMaxMessageBytes<image_t> = kMaxImageMessageBytes;
template <>
inline constexpr std::size_t kMaxMessageBytes<person_mask_t> = kMaxImageMessageBytes;

/// False unless the bytes are exactly one message of this type. The build bounds the generated
/// decode(), so hostile counts cost neither time nor memory (lcmtypes/bound_codec.cmake). What it
/// says is still to be checked: two in five messages with a flipped bit decode.
template <class Message>
bool Decode(const void* data, std::size_t size, Message* message) {
  if (size > kMaxMessageBytes<Message>) return false;
  return message->decode(data, 0, static_cast<int>(size)) == static_cast<int>(size);
}

}  // namespace airdos

#endif  // AIRDOS_PROCESSES_NODE_MESSAGE_CODEC_H_
