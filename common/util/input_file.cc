#include "common/util/input_file.h"

#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
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
  std::string text(max_bytes + 1, '\0');  // one more tells whether there are too many
  file.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(file.gcount()));
  if (text.size() > max_bytes) {
    throw InputError(path + ": holds more than " + std::to_string(max_bytes) + " bytes");
  }
  return text;
}

}  // namespace airdos
