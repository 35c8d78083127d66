#ifndef AIRDOS_PROCESSES_NODE_CODEC_H_
#define AIRDOS_PROCESSES_NODE_CODEC_H_

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "common/util/check.h"

namespace airdos {

/// Bytes of one LCM message of a generated type.
template <class Message>
std::vector<std::uint8_t> Encode(const Message& message) {
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(message.getEncodedSize()));
  const int size = message.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
  AIRDOS_CHECK(size == static_cast<int>(bytes.size()));
  return bytes;
}

/// False unless the bytes are exactly one message of this type. The build bounds the generated
/// decode(), so hostile counts cost neither time nor memory (lcmtypes/CMakeLists.txt).
template <class Message>
bool Decode(const void* data, std::size_t size, Message* message) {
  if (size > static_cast<std::size_t>(std::numeric_limits<int>::max())) return false;
  return message->decode(data, 0, static_cast<int>(size)) == static_cast<int>(size);
}

}  // namespace airdos

#endif  // AIRDOS_PROCESSES_NODE_CODEC_H_
