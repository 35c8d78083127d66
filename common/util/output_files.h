#ifndef AIRDOS_COMMON_UTIL_OUTPUT_FILES_H_
#define AIRDOS_COMMON_UTIL_OUTPUT_FILES_H_

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace airdos {

// Where a program may write. It never overwrites one of its inputs, and replaces a file that it did
// not write itself only when told to (--force). For folders of results see output_folder.h.

/// What must not be overwritten.
struct OutputRules {
  std::vector<std::string> inputs;  ///< files, and folders with all their contents
  bool force = false;               ///< replaces files that are not ours, but never inputs
};

/// Size and modification time of a file: while they stay the same, the file counts as unchanged.
struct FileStamp {
  std::int64_t num_bytes = 0;
  std::int64_t mtime_ns = 0;
  bool operator==(const FileStamp& other) const {
    return num_bytes == other.num_bytes && mtime_ns == other.mtime_ns;
  }
  bool operator!=(const FileStamp& other) const { return !(*this == other); }
};

/// Stamp of a regular file; links are followed only if requested. Nothing if there is no such file.
std::optional<FileStamp> StampOf(const std::string& path, bool follows_links = true);

/// Throws InputError if `path` is one of the inputs (the same file, even through links), or is in
/// an input folder, even with `force`. The path itself need not exist.
void CheckNoInput(const std::string& path, const std::vector<std::string>& inputs);

/// Throws a one-line InputError if the file may not or cannot be written: it is an input; it exists
/// and was not written by this program (see MarkWritten()), unless forced; or its folder does not
/// exist or is not writable. Devices and pipes, such as /dev/stdout, are accepted.
void CheckOutputFile(const std::string& path, const OutputRules& rules);

/// Records that this program wrote the file, and when, in its extended attribute
/// user.airdos.written. A file that is modified afterwards no longer counts as ours. On a file
/// system without extended attributes nothing is recorded, so replacing the file needs --force.
void MarkWritten(const std::string& path);

/// The program that wrote the file in its present state; empty if it is not one of ours or unknown.
std::string WriterOf(const std::string& path);

/// The files that one command writes. They are checked on construction and, if written by then,
/// marked on destruction (even if the command failed half-way, but not after a kill).
class OutputFiles {
 public:
  /// Empty paths, for options that were not given, are ignored. Throws InputError like
  /// CheckOutputFile(), and if two paths are the same.
  OutputFiles(const std::vector<std::string>& paths, const OutputRules& rules);
  ~OutputFiles();
  OutputFiles(const OutputFiles&) = delete;
  OutputFiles& operator=(const OutputFiles&) = delete;

 private:
  struct Entry {
    std::string path;
    std::optional<FileStamp> before;
  };
  std::vector<Entry> entries_;
};

}  // namespace airdos

#endif  // AIRDOS_COMMON_UTIL_OUTPUT_FILES_H_
