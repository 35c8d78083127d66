#ifndef AIRDOS_COMMON_DATASET_IMAGE_NAMES_H_
#define AIRDOS_COMMON_DATASET_IMAGE_NAMES_H_

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace airdos {

/// The images of one folder, ordered by the numbers in their names.
///
/// A name consists of text, numbers and an extension: 000003.png, frame1.jpg, left12.jpg,
/// 000003_10.png, 1403636579763555584.png, 1403636579.763555.png. The largest series of names that
/// differ only in their numbers is used. Everything else is skipped and named in `notes`: hidden
/// files, previews, copies ("000003 (1).jpg").
struct ImageNames {
  std::string folder;
  std::vector<std::string> files;  ///< names in the folder, in order
  /// What distinguishes the images, equal in both folders of a pair: "3" for left000003.png,
  /// "1403636579.763555" for 1403636579.763555.png; if no number does, the name without its
  /// extension.
  std::vector<std::string> keys;
  /// The keys as integers; empty if they are not integers.
  std::vector<std::uint64_t> numbers;
  std::vector<std::string> notes;
};

/// Lists the .png, .jpg and .jpeg files of a folder. Throws InputError if it cannot be read, has no
/// image (naming the files of other formats), has two files with the same number, or has two series
/// of names so similar in size (none less than a quarter of the other) that it is unknown which one
/// is meant.
ImageNames ListImages(const std::string& folder);
/// The same of some of the folder's files.
ImageNames OrderImages(const std::string& folder, std::vector<std::string> names);
/// The names of these files, in lexicographic order.
std::vector<std::string> ListImageFiles(const std::string& folder);

/// Throws InputError with both counts and the first names without a partner if the keys of left and
/// right differ.
void CheckPairs(const ImageNames& left, const ImageNames& right);

/// For each image, the name of the file with this extension (".txt") that belongs to it, or "" if
/// there is none: the file named like the left or right image, or else the one with the same
/// number. If the folder holds several series of names, only equal names count. A folder that does
/// not exist is treated as empty.
std::vector<std::string> FindPartners(const std::string& folder, const std::string& ending,
                                      const ImageNames& left, const ImageNames& right);

/// Whether a folder contains a .png, .jpg or .jpeg file that is not hidden.
bool HoldsImages(const std::string& folder);

/// Times of the images (us) if the names contain them: seconds with decimals; s, ms, us or ns since
/// 1970; or us or ns since any other origin (steps of 5000 and more are not image numbers).
struct NamedTimes {
  std::vector<std::int64_t> utimes;
  std::string unit;
};
std::optional<NamedTimes> TimesFromNames(const ImageNames& names);

}  // namespace airdos

#endif  // AIRDOS_COMMON_DATASET_IMAGE_NAMES_H_
