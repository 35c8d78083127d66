#ifndef AIRDOS_COMMON_UTIL_OUTPUT_FOLDER_H_
#define AIRDOS_COMMON_UTIL_OUTPUT_FOLDER_H_

#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "common/util/output_files.h"

namespace airdos {

/// A folder of results. It is locked while somebody writes to it and has a list, `.airdos_results`,
/// of the files written, so that a later run replaces exactly these files and no others.
///
/// The list is text with one line per file: `bytes mtime_ns group name`, with the name relative to
/// the folder. Bytes and time are `-` from before a file is written until Finish(), so that files
/// left half-written by a killed run are known as well. Lines are only appended, and the last one
/// for a name counts, until the files of an earlier run are removed. A listed file that was
/// modified since belongs to the user, like every file that is not listed.
class OutputFolder {
 public:
  static constexpr char kListName[] = ".airdos_results";

  /// Creates the folder if necessary and locks it for the lifetime of this object. Throws a
  /// one-line InputError if another run is writing to it, if it is inside an input, or if it cannot
  /// be created or written to.
  OutputFolder(const std::string& path, const OutputRules& rules);
  /// Calls Finish(). A folder to which nothing was written is left unchanged.
  ~OutputFolder();
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;

  const std::string& path() const { return path_; }
  std::string PathOf(const std::string& name) const { return path_ + "/" + name; }

  /// Selects the listed files that a call applies to.
  using Selection = std::function<bool(const std::string& name, const std::string& group)>;

  /// Throws InputError if one of the names is taken by something that was not written here, or if a
  /// selected file of an earlier run has been modified since (both unless forced), or is an input.
  /// Call it before the work starts.
  void RequireReplaceable(const std::vector<std::string>& names, const Selection& selection) const;

  /// Removes the selected files of an earlier run and any subfolders that this leaves empty. Files
  /// claimed in this run are kept. Returns the number of files removed. Throws like
  /// RequireReplaceable().
  int RemoveEarlier(const Selection& selection);

  /// Returns the path of a file that is about to be written, after listing it and creating its
  /// folder. Throws InputError if it is an input, or exists and was not written here (unless
  /// forced).
  std::string Claim(const std::string& name, const std::string& group);

  /// Lists the claimed files with their present sizes and times. Does not throw.
  void Finish();

  /// Whether the list has this file, from an earlier run or from this one.
  bool IsListed(const std::string& name) const { return list_.count(name) > 0; }

  /// A line of the list.
  struct Entry {
    std::optional<FileStamp> stamp;  ///< nothing if possibly unfinished
    std::string group;
  };
  using List = std::map<std::string, Entry>;  ///< keyed by name

 private:
  void Lock();
  void Append(const std::string& text);
  void CheckChange(const std::string& name) const;

  std::string path_;
  OutputRules rules_;
  bool is_new_ = false;  // the folder was created here
  int list_file_ = -1;   // open and locked
  List list_;
  std::set<std::string> claimed_;
  std::set<std::string> unfinished_;  // claimed and not yet finished
};

/// "replaces the results of an earlier run: 12 files"; empty if there are none.
std::string SayReplaced(int num_files);

}  // namespace airdos

#endif  // AIRDOS_COMMON_UTIL_OUTPUT_FOLDER_H_
