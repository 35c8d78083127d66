#ifndef AIRDOS_PROCESSES_NODE_MESSAGE_TYPES_FINGERPRINT_H_
#define AIRDOS_PROCESSES_NODE_MESSAGE_TYPES_FINGERPRINT_H_

#include <cstdint>
#include <map>
#include <string>

namespace airdos {

/// Each message type with its own channel, and its LCM fingerprint, which starts each of its
/// messages and covers members, their types and dimensions.
const std::map<std::string, std::int64_t>& MessageTypes();

/// 16 hexadecimal digits of the SHA-256 over names and fingerprints in MessageTypes(). Programs
/// that report the same value understand each other's messages.
const std::string& TypesFingerprint();

}  // namespace airdos

#endif  // AIRDOS_PROCESSES_NODE_MESSAGE_TYPES_FINGERPRINT_H_
