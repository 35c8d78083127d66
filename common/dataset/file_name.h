#ifndef AIRDOS_COMMON_DATASET_FILE_NAME_H_
#define AIRDOS_COMMON_DATASET_FILE_NAME_H_

#include <cstddef>
#include <string>
#include <vector>

namespace airdos {

/// A file name taken apart: "left_000012_10.png" is the pattern "left_#_#" and the numbers 12
/// and 10.
struct FileName {
  std::string name;
  std::string stem;     ///< without the ending
  std::string pattern;  ///< of the stem, a # for each number
  /// Digits with or without decimals, without zeros that mean nothing: "12" of 0012, "1.5" of
  /// 1.50.
  std::vector<std::string> numbers;
};

FileName TakeApart(const std::string& name);

/// Order by number, whatever the width: "9" before "10", "1.5" before "1.6".
bool IsNumberLess(const std::string& a, const std::string& b);

/// Files whose names differ only in their numbers, in natural order.
struct NameSeries {
  std::string pattern;
  std::vector<FileName> names;
  /// Which of the numbers counts the files; -1 where none does.
  int counting = -1;

  /// What tells the file apart from the others of the series.
  std::string KeyOf(const FileName& name) const;
};

/// The series that names fall into, largest first; of equally large ones those with numbers first.
std::vector<NameSeries> GroupNames(const std::vector<std::string>& names);

/// Names (without folder) of the plain files of a folder with one of the endings (lower case, with
/// the dot; any case in the folder), in order of text; of all where there are none. Throws
/// InputError where the folder cannot be read.
std::vector<std::string> ListFiles(const std::string& folder,
                                   const std::vector<std::string>& endings);

/// The ending of a name in lower case, with the dot.
std::string EndingOf(const std::string& name);
bool IsHidden(const std::string& name);

/// "20 .json files (000000_keypoints.json, ...)" for a message: kinds of files and how many.
std::string CountByEnding(const std::vector<std::string>& names);

/// "a, b, c and 4 more" for a message.
std::string FirstFew(const std::vector<std::string>& names, std::size_t max_shown = 3);

}  // namespace airdos

#endif  // AIRDOS_COMMON_DATASET_FILE_NAME_H_
