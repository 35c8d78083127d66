#ifndef AIRDOS_PROCESSES_NODE_LOG_FOREIGN_FILE_H_
#define AIRDOS_PROCESSES_NODE_LOG_FOREIGN_FILE_H_

#include <cstdint>
#include <string>
#include <vector>

namespace airdos {

/// This many bytes at the beginning of a file identify most formats.
inline constexpr std::size_t kForeignFileBytes = 512;

/// Identifies, from its first bytes, a file that was given as an LCM log but is not one, with what
/// to do about it: "is a ROS bag, not an LCM log: …". Empty if the format is not recognised.
std::string DescribeForeignFile(const std::vector<std::uint8_t>& first_bytes);

/// Whether the bytes look like text.
bool LooksLikeText(const std::vector<std::uint8_t>& first_bytes);

}  // namespace airdos

#endif  // AIRDOS_PROCESSES_NODE_LOG_FOREIGN_FILE_H_
