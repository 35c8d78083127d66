#ifndef AIRDOS_COMMON_DATASET_FILE_NAME_H_
#define AIRDOS_COMMON_DATASET_FILE_NAME_H_

#include <cstddef>
#include <string>
#include <vector>

namespace airdos {

/// A parsed file name: "left_000012_10.png" has the pattern "left_\0_\0" and the numbers 12 and 10.
struct FileName {
  std::string name;
  std::string stem;     ///< without the extension
  std::string pattern;  ///< the stem with a zero byte for each number
  /// Digits, possibly with decimals, without redundant zeros: "12" for 0012, "1.5" for 1.50.
  std::vector<std::string> numbers;
};

FileName TakeApart(const std::string& name);

/// Numeric order, whatever the width: "9" before "10", "1.5" before "1.6".
bool IsNumberLess(const std::string& a, const std::string& b);

/// Files whose names differ only in their numbers, in natural order.
struct NameSeries {
  std::vector<FileName> names;
  /// Index of the number that counts the files; -1 if there is none.
  int counting = -1;

  /// What distinguishes the file from the others in the series.
  std::string KeyOf(const FileName& name) const;
};

/// Groups names into series, largest first; of equally large ones, those with numbers come first.
std::vector<NameSeries> GroupNames(const std::vector<std::string>& names);

/// Names (without folder) of a folder's regular files with one of the extensions (lower case, with
/// the dot; any case in the folder), or of all if no extension is given, in lexicographic order.
/// Throws InputError if the folder cannot be read.
std::vector<std::string> ListFiles(const std::string& folder,
                                   const std::vector<std::string>& endings);

/// The extension of a name in lower case, with the dot.
std::string EndingOf(const std::string& name);
bool IsHidden(const std::string& name);

/// "20 .json files (000000_keypoints.json, ...)" for messages: the extensions and how many files
/// have each.
std::string CountByEnding(const std::vector<std::string>& names);

/// "a, b, c and 4 more" for messages.
std::string FirstFew(const std::vector<std::string>& names, std::size_t max_shown = 3);

}  // namespace airdos

#endif  // AIRDOS_COMMON_DATASET_FILE_NAME_H_
