#include "common/util/input_file.h"

#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

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

}  // namespace airdos
