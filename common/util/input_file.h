#ifndef AIRDOS_COMMON_UTIL_INPUT_FILE_H_
#define AIRDOS_COMMON_UTIL_INPUT_FILE_H_

#include <string>

namespace airdos {

/// Call this before opening a file for reading: opening a pipe waits for its writer, a device may
/// have no end, and reading a folder fails with an unrelated message. Follows links. Throws
/// InputError naming the path if there is no file, if it is a folder, pipe, device or socket, or if
/// it may not be read.
void RequireRegularFile(const std::string& path);

}  // namespace airdos

#endif  // AIRDOS_COMMON_UTIL_INPUT_FILE_H_
