#include "common/util/output_folder.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <system_error>

#include "common/util/error.h"

namespace airdos {
namespace {

namespace fs = std::filesystem;

constexpr char kHead[] =
    "# What airdos wrote into this folder. The next run replaces these files while nobody changes "
    "them.\n# bytes, time (ns), group, name\n";
constexpr char kProcess[] = "# process ";

bool Exists(const std::string& path) {  // including a dangling link
  std::error_code error;
  return fs::exists(fs::symlink_status(path, error));
}

/// Whether a name from a list stays below its folder, whoever wrote the list.
bool IsSafe(const std::string& name) {
  const fs::path path(name);
  if (name.empty() || path.is_absolute()) return false;
  for (const fs::path& part : path) {
    if (part == ".." || part == "." || part.empty()) return false;
  }
  return true;
}

OutputFolder::List ReadList(const std::string& folder, std::string* process) {
  OutputFolder::List list;
  std::ifstream file(folder + "/" + OutputFolder::kListName);
  for (std::string line; std::getline(file, line);) {
    if (line.compare(0, std::strlen(kProcess), kProcess) == 0) {
      *process = line.substr(std::strlen(kProcess));
    }
    std::istringstream words(line);
    std::string bytes, time, group, name;
    if (line[0] == '#' || !(words >> bytes >> time >> group)) continue;
    words.get();  // the space before the name, which may itself contain spaces
    if (!std::getline(words, name) || !IsSafe(name)) continue;
    OutputFolder::Entry& entry = list[name];
    entry = {std::nullopt, group};
    if (bytes != "-") entry.stamp = FileStamp{std::atoll(bytes.c_str()), std::atoll(time.c_str())};
  }
  return list;
}

/// Whether the file is the one in this entry and has not changed since.
bool IsUnchanged(const OutputFolder::Entry& entry, const std::string& path) {
  const std::optional<FileStamp> now = StampOf(path, false);
  return now && (!entry.stamp || *entry.stamp == *now);
}

/// Whether one of our programs wrote the file: according to a list, possibly that of the subfolder
/// that it is in (an export into a session's folder), or to its mark.
bool IsOurs(const OutputFolder::List& list, const std::string& folder, const std::string& name) {
  const std::string path = folder + "/" + name;
  const auto entry = list.find(name);
  if (entry != list.end() && IsUnchanged(entry->second, path)) return true;
  const std::size_t slash = name.find('/');
  if (slash != std::string::npos) {
    const std::string below = folder + "/" + name.substr(0, slash);
    std::string process;
    if (Exists(below + "/" + OutputFolder::kListName) &&
        IsOurs(ReadList(below, &process), below, name.substr(slash + 1))) {
      return true;
    }
  }
  return StampOf(path, false) && !WriterOf(path).empty();
}

std::string LineOf(const std::string& name, const OutputFolder::Entry& entry) {
  std::string line = "- -";
  if (entry.stamp) {
    line = std::to_string(entry.stamp->num_bytes) + " " + std::to_string(entry.stamp->mtime_ns);
  }
  return line + " " + entry.group + " " + name + "\n";
}

/// Removes the folders above the file that are empty or hold only a list of their own.
void RemoveEmptyFolders(const std::string& folder, const std::string& name) {
  for (fs::path below = fs::path(name).parent_path(); !below.empty(); below = below.parent_path()) {
    const fs::path path = fs::path(folder) / below;
    std::error_code error;
    int num_others = 0;
    for (const fs::directory_entry& entry : fs::directory_iterator(path, error)) {
      num_others += entry.path().filename() == OutputFolder::kListName ? 0 : 1;
    }
    if (error || num_others > 0) return;
    fs::remove(path / OutputFolder::kListName, error);
    if (rmdir(path.c_str()) != 0) return;
  }
}

}  // namespace

OutputFolder::OutputFolder(const std::string& path, const OutputRules& rules)
    : path_(path), rules_(rules) {
  if (path.empty()) throw InputError("the name of the results folder is empty");
  // Otherwise the folder, with all its contents, would be an input of itself.
  CheckNoInput(path, rules.inputs);
  std::error_code error;
  is_new_ = fs::create_directories(path, error);
  if (!error && !fs::is_directory(path, error))
    error = std::make_error_code(std::errc::not_a_directory);
  if (error) throw InputError(path + ": cannot be created: " + error.message());
  try {
    Lock();
    std::string process;
    list_ = ReadList(path_, &process);
    const std::optional<FileStamp> stamp = StampOf(PathOf(kListName));
    if (!stamp) throw InputError(PathOf(kListName) + ": is not a file; remove it");
    Append((stamp->num_bytes == 0 ? kHead : "") + std::string(kProcess) + std::to_string(getpid()) +
           "\n");
  } catch (...) {
    if (list_file_ >= 0) close(list_file_);
    if (is_new_) rmdir(path_.c_str());
    throw;
  }
}

void OutputFolder::Lock() {
  const std::string list = PathOf(kListName);
  for (;;) {
    list_file_ = open(list.c_str(), O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC | O_NOFOLLOW, 0644);
    if (list_file_ < 0) throw InputError(path_ + ": cannot be written: " + std::strerror(errno));
    // A file system without locks is not the user's fault.
    if (flock(list_file_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
      std::string process;
      ReadList(path_, &process);
      throw InputError(path_ + ": another run is writing here" +
                       (process.empty() ? "" : " (process " + process + ")") +
                       "; wait until it ends or choose another folder");
    }
    // The previous holder of the lock may have removed the list on leaving.
    struct stat opened = {};
    struct stat named = {};
    if (fstat(list_file_, &opened) == 0 && stat(list.c_str(), &named) == 0 &&
        opened.st_ino == named.st_ino) {
      return;
    }
    close(list_file_);
  }
}

OutputFolder::~OutputFolder() {
  Finish();
  std::error_code error;
  if (list_.empty()) fs::remove(PathOf(kListName), error);
  if (list_.empty() && is_new_) rmdir(path_.c_str());  // fails if it is not empty
  close(list_file_);
}

void OutputFolder::Append(const std::string& text) {
  if (write(list_file_, text.data(), text.size()) != static_cast<ssize_t>(text.size())) {
    throw InputError(PathOf(kListName) + ": cannot be written: " + std::strerror(errno));
  }
}

void OutputFolder::CheckChange(const std::string& name) const {
  const std::string path = PathOf(name);
  if (!Exists(path)) return;
  CheckNoInput(path, rules_.inputs);
  if (rules_.force || IsOurs(list_, path_, name)) return;
  throw InputError(path +
                   (IsListed(name) ? ": was changed since airdos wrote it"
                                   : ": exists and is not known to be written by airdos") +
                   "; choose another folder, or --force replaces it");
}

void OutputFolder::RequireReplaceable(const std::vector<std::string>& names,
                                      const Selection& selection) const {
  for (const std::string& name : names) CheckChange(name);
  for (const auto& [name, entry] : list_) {
    if (claimed_.count(name) == 0 && selection(name, entry.group)) CheckChange(name);
  }
}

int OutputFolder::RemoveEarlier(const Selection& selection) {
  RequireReplaceable({}, selection);
  int num_removed = 0;
  List kept;
  for (const auto& [name, entry] : list_) {
    if (claimed_.count(name) > 0 || !selection(name, entry.group)) {
      kept.emplace(name, entry);
      continue;
    }
    if (!Exists(PathOf(name))) continue;
    if (unlink(PathOf(name).c_str()) != 0) {
      throw InputError(PathOf(name) + ": cannot be removed: " + std::strerror(errno));
    }
    ++num_removed;
    RemoveEmptyFolders(path_, name);
  }
  list_ = std::move(kept);
  // A kill between these two leaves files that are on no list, but loses none.
  if (ftruncate(list_file_, 0) == 0) {
    std::string text = kHead + std::string(kProcess) + std::to_string(getpid()) + "\n";
    for (const auto& [name, entry] : list_) text += LineOf(name, entry);
    Append(text);
  }
  return num_removed;
}

std::string OutputFolder::Claim(const std::string& name, const std::string& group) {
  const std::string path = PathOf(name);
  if (!IsSafe(name) || name.find('\n') != std::string::npos) {
    throw InputError(path + ": is not a valid name for a result");
  }
  CheckChange(name);
  std::error_code error;
  fs::create_directories(fs::path(path).parent_path(), error);
  if (error) {
    throw InputError(fs::path(path).parent_path().string() +
                     ": cannot be created: " + error.message());
  }
  list_[name] = {std::nullopt, group};
  claimed_.insert(name);
  unfinished_.insert(name);
  Append(LineOf(name, list_[name]));
  return path;
}

void OutputFolder::Finish() {
  std::string text;
  for (const std::string& name : unfinished_) {
    Entry& entry = list_[name];
    entry.stamp = StampOf(PathOf(name), false);
    if (entry.stamp) {
      text += LineOf(name, entry);
    } else {
      list_.erase(name);  // never written
    }
  }
  unfinished_.clear();
  try {
    if (!text.empty()) Append(text);
  } catch (const InputError&) {  // they stay listed as unfinished
  }
}

std::string SayReplaced(int num_files) {
  if (num_files == 0) return "";
  return "replaces the results of an earlier run: " + std::to_string(num_files) +
         (num_files == 1 ? " file" : " files");
}

}  // namespace airdos
