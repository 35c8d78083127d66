#ifndef AIRDOS_COMMON_UTIL_FREE_DISK_H_
#define AIRDOS_COMMON_UTIL_FREE_DISK_H_

#include <cstdint>
#include <string>

namespace airdos {

/// Space that a recorder leaves free for others: 100 MB, or 1 % of a disk smaller than 10 GB.
std::int64_t DiskReserveBytes(std::int64_t capacity_bytes);

/// Why nothing more should be written to the file system that holds `path`, or an empty text. A
/// file system that does not report its free space is assumed to have enough.
std::string WhyDiskIsFull(const std::string& path);

}  // namespace airdos

#endif  // AIRDOS_COMMON_UTIL_FREE_DISK_H_
