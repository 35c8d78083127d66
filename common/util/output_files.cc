#include "common/util/output_files.h"

#include <errno.h>
#include <sys/stat.h>
#include <sys/xattr.h>
#include <unistd.h>

#include <cstring>
#include <filesystem>
#include <sstream>
#include <system_error>

#include "common/util/error.h"

namespace airdos {
namespace {

namespace fs = std::filesystem;

constexpr char kMark[] = "user.airdos.written";  // "bytes time program"

std::string ProgramName() { return program_invocation_short_name; }

bool IsSame(const struct stat& a, const struct stat& b) {
  return a.st_dev == b.st_dev && a.st_ino == b.st_ino;
}

/// Whether the file is in the folder, possibly under another name (a link).
bool IsFileIn(const std::string& folder, const struct stat& file) {
  constexpr int kMaxDepth = 3;  // depth of a data set; a link may lead anywhere
  std::error_code error;
  const auto options = fs::directory_options::follow_directory_symlink |
                       fs::directory_options::skip_permission_denied;
  fs::recursive_directory_iterator entries(folder, options, error);
  for (; !error && entries != fs::recursive_directory_iterator(); entries.increment(error)) {
    struct stat entry = {};
    if (stat(entries->path().c_str(), &entry) == 0 && IsSame(entry, file)) return true;
    if (entries.depth() >= kMaxDepth) entries.disable_recursion_pending();
  }
  return false;
}

/// Whether the path, which need not exist, is the folder or inside it.
bool IsBelow(const std::string& path, const struct stat& folder) {
  std::error_code error;
  fs::path place = fs::weakly_canonical(fs::absolute(path, error), error);
  for (; !error && !place.empty(); place = place.parent_path()) {
    struct stat status = {};
    if (stat(place.c_str(), &status) == 0 && IsSame(status, folder)) return true;
    if (place == place.parent_path()) break;
  }
  return false;
}

bool IsStandardStream(const std::string& path) {
  const auto starts_with = [&path](const std::string& start) {
    return path.compare(0, start.size(), start) == 0;
  };
  return path == "/dev/stdout" || path == "/dev/stderr" || starts_with("/dev/fd/") ||
         starts_with("/proc/self/fd/");
}

[[noreturn]] void FailToWrite(const std::string& path) {
  throw InputError(path + ": cannot be written: " + std::strerror(errno));
}

void CheckNewFile(const std::string& path) {
  fs::path folder = fs::path(path).parent_path();
  if (folder.empty()) folder = ".";
  std::error_code error;
  if (!fs::exists(folder, error)) {
    throw InputError(path + ": there is no folder " + folder.string() + "; create it first");
  }
  if (!fs::is_directory(folder, error)) {
    throw InputError(path + ": cannot be written: " + folder.string() + " is not a folder");
  }
  if (access(folder.c_str(), W_OK | X_OK) != 0) FailToWrite(path);
}

void CheckOldFile(const std::string& path, bool force) {
  if (access(path.c_str(), W_OK) != 0) FailToWrite(path);
  const std::string writer = WriterOf(path);
  if (force || writer == ProgramName()) return;
  throw InputError(path + ": exists and was " +
                   (writer.empty() ? "not written by airdos, or changed since, or cut short"
                                   : "written by " + writer) +
                   "; --force replaces it");
}

}  // namespace

std::optional<FileStamp> StampOf(const std::string& path, bool follows_links) {
  struct stat status = {};
  const int result = follows_links ? stat(path.c_str(), &status) : lstat(path.c_str(), &status);
  if (result != 0 || !S_ISREG(status.st_mode)) return std::nullopt;
  constexpr std::int64_t kNsPerS = 1000000000;
  return FileStamp{status.st_size, status.st_mtim.tv_sec * kNsPerS + status.st_mtim.tv_nsec};
}

void CheckNoInput(const std::string& path, const std::vector<std::string>& inputs) {
  struct stat status = {};
  const bool exists = stat(path.c_str(), &status) == 0;
  for (const std::string& input : inputs) {
    struct stat other = {};
    if (input.empty() || stat(input.c_str(), &other) != 0) continue;  // its reader will report that
    if (exists && IsSame(status, other)) {
      throw InputError(path + ": is an input" + (path == input ? "" : " (" + input + ")") +
                       ", which is never overwritten; choose another name");
    }
    if (!S_ISDIR(other.st_mode)) continue;
    if (IsBelow(path, other) || (exists && S_ISREG(status.st_mode) && IsFileIn(input, status))) {
      throw InputError(path + ": is in the input folder " + input +
                       ", to which nothing is written; choose another place");
    }
  }
}

void CheckOutputFile(const std::string& path, const OutputRules& rules) {
  if (path.empty()) throw InputError("the name of an output file is empty");
  CheckNoInput(path, rules.inputs);
  struct stat status = {};
  if (stat(path.c_str(), &status) != 0) {
    if (errno != ENOENT) FailToWrite(path);
    CheckNewFile(path);
  } else if (S_ISDIR(status.st_mode)) {
    throw InputError(path + ": is a folder, but a file is to be written");
  } else if (S_ISREG(status.st_mode) && !IsStandardStream(path)) {
    CheckOldFile(path, rules.force);
  }
}

void MarkWritten(const std::string& path) {
  const std::optional<FileStamp> stamp = StampOf(path);
  if (!stamp || IsStandardStream(path)) return;
  const std::string mark = std::to_string(stamp->num_bytes) + " " +
                           std::to_string(stamp->mtime_ns) + " " + ProgramName();
  setxattr(path.c_str(), kMark, mark.data(), mark.size(), 0);  // may fail: see the header
}

std::string WriterOf(const std::string& path) {
  char mark[256];
  const ssize_t size = getxattr(path.c_str(), kMark, mark, sizeof mark);
  if (size <= 0) return "";
  std::istringstream text(std::string(mark, static_cast<std::size_t>(size)));
  FileStamp stamp;
  std::string program;
  const std::optional<FileStamp> now = StampOf(path);
  if (!(text >> stamp.num_bytes >> stamp.mtime_ns >> program) || !now || stamp != *now) return "";
  return program;
}

OutputFiles::OutputFiles(const std::vector<std::string>& paths, const OutputRules& rules) {
  for (const std::string& path : paths) {
    if (path.empty()) continue;
    CheckOutputFile(path, rules);
    std::error_code error;
    const fs::path place = fs::weakly_canonical(fs::absolute(path, error), error);
    for (const Entry& other : entries_) {
      const bool is_same = fs::weakly_canonical(fs::absolute(other.path, error), error) == place ||
                           fs::equivalent(path, other.path, error);
      if (is_same && (!fs::exists(path, error) || StampOf(path))) {  // twice /dev/null is fine
        throw InputError(path + ": would be written twice; give each output its own name");
      }
    }
    entries_.push_back({path, StampOf(path)});
  }
}

OutputFiles::~OutputFiles() {
  for (const Entry& entry : entries_) {
    const std::optional<FileStamp> now = StampOf(entry.path);
    if (now && (!entry.before || *entry.before != *now)) MarkWritten(entry.path);
  }
}

}  // namespace airdos
