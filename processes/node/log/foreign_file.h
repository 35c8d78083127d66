#ifndef AIRDOS_PROCESSES_NODE_LOG_FOREIGN_FILE_H_
#define AIRDOS_PROCESSES_NODE_LOG_FOREIGN_FILE_H_

#include <cstdint>
#include <string>
#include <vector>

namespace airdos {

/// As many bytes of a file's beginning tell most formats.
inline constexpr std::size_t kForeignFileBytes = 512;

/// What a file is that was given as an LCM log, by its first bytes, and what to do about it: "is a
/// ROS bag, not an LCM log: …". Empty where the bytes are those of no format that is known here.
std::string DescribeForeignFile(const std::vector<std::uint8_t>& first_bytes);

/// Whether the bytes can be read as text.
bool LooksLikeText(const std::vector<std::uint8_t>& first_bytes);

}  // namespace airdos

#endif  // AIRDOS_PROCESSES_NODE_LOG_FOREIGN_FILE_H_
