#ifndef AIRDOS_COMMON_UTIL_INPUT_FILE_H_
#define AIRDOS_COMMON_UTIL_INPUT_FILE_H_

#include <cstddef>
#include <string>

namespace airdos {

/// To be called before a file is opened for reading: to open a pipe waits for its writer, a device
/// may have no end, and what reads a folder fails with a text of its own. Throws InputError naming
/// the path where there is no file (through links), where it is a folder, a pipe, a device or a
/// socket, or where it must not be read.
void RequireRegularFile(const std::string& path);

/// A whole regular file. Throws InputError naming the path where it cannot be read, or holds more
/// than `max_bytes` bytes.
std::string ReadWholeFile(const std::string& path, std::size_t max_bytes);

}  // namespace airdos

#endif  // AIRDOS_COMMON_UTIL_INPUT_FILE_H_
