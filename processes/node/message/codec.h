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

/// Encodes an LCM message of a generated type. Throws std::length_error if a list is shorter than
/// its count, or a count is negative: the caller's mistake.
template <class Message>
std::vector<std::uint8_t> Encode(const Message& message) {
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(message.getEncodedSize()));
  const int size = message.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
  if (size != static_cast<int>(bytes.size())) throw std::length_error(Message::getTypeName());
  return bytes;
}

/// Larger messages are refused before decoding, because vectors of structures take up to twenty
/// times the memory of their bytes. Ours stay below 128 kB, but images may be raw, with 12
/// megapixels.
inline constexpr std::size_t kMaxImageMessageBytes = 40u << 20;
inline constexpr std::size_t kMaxOtherMessageBytes = 1u << 20;
template <class Message>
inline constexpr std::size_t kMaxMessageBytes = kMaxOtherMessageBytes;
template <>
inline constexpr std::size_t kMaxMessageBytes<image_t> = kMaxImageMessageBytes;
template <>
inline constexpr std::size_t kMaxMessageBytes<person_mask_t> = kMaxImageMessageBytes;

/// Decodes exactly one message of this type; false if the bytes are anything else. The build adds
/// bounds to the generated decode(), so hostile counts cost neither time nor memory
/// (lcmtypes/bound_codec.cmake). The content must still be validated: two in five messages with a
/// flipped bit decode.
template <class Message>
bool Decode(const void* data, std::size_t size, Message* message) {
  if (size > kMaxMessageBytes<Message>) return false;
  return message->decode(data, 0, static_cast<int>(size)) == static_cast<int>(size);
}

}  // namespace airdos

#endif  // AIRDOS_PROCESSES_NODE_MESSAGE_CODEC_H_
