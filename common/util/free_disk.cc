#include "common/util/free_disk.h"

#include <algorithm>
#include <filesystem>
#include <system_error>

namespace airdos {

std::int64_t DiskReserveBytes(std::int64_t capacity_bytes) {
  return std::min<std::int64_t>(100000000, capacity_bytes / 100);
}

std::string WhyDiskIsFull(const std::string& path) {
  std::error_code error;
  const std::filesystem::space_info space = std::filesystem::space(path, error);
  if (error || space.capacity == 0) return "";
  const std::int64_t reserve_bytes = DiskReserveBytes(static_cast<std::int64_t>(space.capacity));
  if (static_cast<std::int64_t>(space.available) >= reserve_bytes) return "";
  return "less than " + std::to_string(reserve_bytes / 1000) + " kB are left on the disk";
}

}  // namespace airdos
