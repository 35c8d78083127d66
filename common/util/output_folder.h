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

/// A folder of results: locked while somebody writes into it, and with a list, `.airdos_results`,
/// of what was written, so that a later run replaces these files, and only these.
///
/// The list is text, a line a file: `bytes mtime_ns group name`, the name relative to the folder;
/// bytes and time are `-` from before a file is written until Finish(): what a killed run left
/// behind half-written is known as well. Lines are only added, and the last one of a name counts,
/// until the files of an earlier run are removed. A listed file that was changed since is the
/// user's, as every other one is.
class OutputFolder {
 public:
  static constexpr char kListName[] = ".airdos_results";

  /// Makes the folder if it is not there and locks it until this goes. Throws InputError in one
  /// line if another run writes there, if the folder lies in an input, cannot be made or written.
  OutputFolder(const std::string& path, const OutputRules& rules);
  /// Finish(). A folder in which nothing was written is left as it was.
  ~OutputFolder();
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;

  const std::string& path() const { return path_; }
  std::string PathOf(const std::string& name) const { return path_ + "/" + name; }

  /// Which of the listed files a call is about.
  using Selection = std::function<bool(const std::string& name, const std::string& group)>;

  /// Throws InputError if something that was not written here stands under one of the names, or one
  /// of the selected files of an earlier run was changed since (unless forced, both), or is an
  /// input. To be asked before the work starts.
  void RequireReplaceable(const std::vector<std::string>& names, const Selection& selection) const;

  /// Removes the selected files of an earlier run, and the folders below this one that this leaves
  /// empty. Files that were claimed before stay. Returns how many went. Throws as
  /// RequireReplaceable().
  int RemoveEarlier(const Selection& selection);

  /// The path of a file that is about to be written: puts it on the list and makes its folder.
  /// Throws InputError if it is an input, or exists and was not written here (unless forced).
  std::string Claim(const std::string& name, const std::string& group);

  /// Lists what was claimed with the sizes and times it has now. Throws nothing.
  void Finish();

  /// Whether there is such a file on the list, of an earlier run or of this one.
  bool IsListed(const std::string& name) const { return list_.count(name) > 0; }

  struct Entry {
    std::optional<FileStamp> stamp;  ///< nothing: announced, but maybe not written to its end
    std::string group;
  };
  using List = std::map<std::string, Entry>;  ///< by name

 private:
  void Lock();
  void Append(const std::string& text);
  void CheckChange(const std::string& name) const;

  std::string path_;
  OutputRules rules_;
  bool is_new_ = false;  // the folder was made here
  int list_file_ = -1;   // open and locked
  List list_;
  std::set<std::string> claimed_;
  std::set<std::string> unfinished_;  // of the claimed ones
};

/// "replaces the results of an earlier run: 12 files"; empty for none.
std::string SayReplaced(int num_files);

}  // namespace airdos

#endif  // AIRDOS_COMMON_UTIL_OUTPUT_FOLDER_H_
