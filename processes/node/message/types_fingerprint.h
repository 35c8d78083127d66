#ifndef AIRDOS_PROCESSES_NODE_MESSAGE_TYPES_FINGERPRINT_H_
#define AIRDOS_PROCESSES_NODE_MESSAGE_TYPES_FINGERPRINT_H_

#include <cstdint>
#include <map>
#include <string>

namespace airdos {

/// Each message type that travels on a channel of its own, and LCM's fingerprint of it: what stands
/// at the head of each of its messages. It covers members, their types and dimensions.
const std::map<std::string, std::int64_t>& MessageTypes();

/// 16 hexadecimal digits of SHA-256 over names and fingerprints of MessageTypes(). Two programs
/// that say the same understand each other's messages.
const std::string& TypesFingerprint();

}  // namespace airdos

#endif  // AIRDOS_PROCESSES_NODE_MESSAGE_TYPES_FINGERPRINT_H_
