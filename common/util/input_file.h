#ifndef AIRDOS_COMMON_UTIL_INPUT_FILE_H_
#define AIRDOS_COMMON_UTIL_INPUT_FILE_H_

#include <cstddef>
#include <string>

namespace airdos {

/// Call this before opening a file for reading: opening a pipe waits for its writer, a device may
/// have no end, and reading a folder fails with an unrelated message. Follows links. Throws
/// InputError naming the path if there is no file, if it is a folder, pipe, device or socket, or if
/// it may not be read.
void RequireRegularFile(const std::string& path);

/// A whole regular file. Throws InputError naming the path where it cannot be read, or holds more
/// than `max_bytes` bytes.
std::string ReadWholeFile(const std::string& path, std::size_t max_bytes);

}  // namespace airdos

#endif  // AIRDOS_COMMON_UTIL_INPUT_FILE_H_
