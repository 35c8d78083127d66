#include "common/util/input_file.h"

#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "common/util/error.h"

namespace airdos {

void RequireRegularFile(const std::string& path) {
  struct stat status = {};
  if (stat(path.c_str(), &status) != 0) {
    throw InputError(path + ": cannot be read: " + std::strerror(errno));
  }
  if (S_ISDIR(status.st_mode)) {
    throw InputError(path + ": is a folder, but a file is expected");
  }
  if (!S_ISREG(status.st_mode)) {
    throw InputError(path + ": is a pipe, device or socket; write it to a file first");
  }
  if (access(path.c_str(), R_OK) != 0) {
    throw InputError(path + ": cannot be read: " + std::strerror(errno));
  }
}

std::string ReadWholeFile(const std::string& path, std::size_t max_bytes) {
  RequireRegularFile(path);
  std::ifstream file(path, std::ios::binary);
  if (!file) throw InputError(path + ": cannot be read");
  std::error_code error;
  const auto said = std::filesystem::file_size(path, error);  // some files say 0, and may grow
  constexpr std::size_t kLeast = 4096;
  const std::size_t likely = error ? kLeast : static_cast<std::size_t>(said) + 1;
  std::string text;
  while (file && text.size() <= max_bytes) {  // one more tells whether there are too many
    const std::size_t at = text.size();
    text.resize(std::min(max_bytes + 1, std::max({kLeast, likely, 2 * at})));
    file.read(text.data() + at, static_cast<std::streamsize>(text.size() - at));
    text.resize(at + static_cast<std::size_t>(file.gcount()));
  }
  if (text.size() > max_bytes) {
    throw InputError(path + ": holds more than " + std::to_string(max_bytes) + " bytes");
  }
  return text;
}

}  // namespace airdos
