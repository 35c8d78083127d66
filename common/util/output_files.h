#ifndef AIRDOS_COMMON_UTIL_OUTPUT_FILES_H_
#define AIRDOS_COMMON_UTIL_OUTPUT_FILES_H_

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace airdos {

// Where a program may write. It never writes over one of its inputs, and replaces a file that it
// did not write itself only if it is told to (--force). Folders of results: output_folder.h.

struct OutputRules {
  std::vector<std::string> inputs;  ///< files, and folders with all that is in them
  bool force = false;               ///< other people's files are replaced, inputs never
};

/// Size and time of the last change of a file: while they stay the same, so does the file.
struct FileStamp {
  std::int64_t num_bytes = 0;
  std::int64_t mtime_ns = 0;
  bool operator==(const FileStamp& other) const {
    return num_bytes == other.num_bytes && mtime_ns == other.mtime_ns;
  }
  bool operator!=(const FileStamp& other) const { return !(*this == other); }
};

/// Of a regular file; a link is followed only where asked for. Nothing where there is none.
std::optional<FileStamp> StampOf(const std::string& path, bool follows_links = true);

/// Throws InputError if `path` is one of the inputs (the same file, also through links), or lies in
/// an input folder; `force` does not help. The path itself need not exist.
void CheckNoInput(const std::string& path, const std::vector<std::string>& inputs);

/// Throws InputError, in one line, if the file must not or cannot be written: it is an input; it
/// exists and this program did not write it (see MarkWritten()), unless forced; its folder is not
/// there or cannot be written to. Devices and pipes, /dev/stdout too, are let through.
void CheckOutputFile(const std::string& path, const OutputRules& rules);

/// Remembers that this program wrote the file, and when: in its extended attribute
/// user.airdos.written. A file that is changed afterwards is somebody else's again. On a file
/// system without such attributes nothing is remembered, so that replacing needs --force.
void MarkWritten(const std::string& path);

/// The program that wrote the file as it is now; empty if that was none of ours or is not known.
std::string WriterOf(const std::string& path);

/// The files that one command writes: checked when this is made, marked when it goes, if they were
/// written by then (also where the command failed half-way; not after a kill).
class OutputFiles {
 public:
  /// Empty paths, options that were not given, are left out. Throws InputError as
  /// CheckOutputFile(), and where two are the same.
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
