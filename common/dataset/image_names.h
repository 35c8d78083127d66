#ifndef AIRDOS_COMMON_DATASET_IMAGE_NAMES_H_
#define AIRDOS_COMMON_DATASET_IMAGE_NAMES_H_

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace airdos {

/// The images of one folder in the order of the numbers in their names.
///
/// A name is text, numbers and an ending: 000003.png, frame1.jpg, left12.jpg, 000003_10.png,
/// 1403636579763555584.png, 1403636579.763555.png. Most names of a folder differ only in their
/// numbers, and that series is taken. What is not of it is named in `notes` and not taken: hidden
/// files, previews, copies ("000003 (1).jpg").
struct ImageNames {
  std::string folder;
  std::vector<std::string> files;  ///< names in the folder, in order
  /// What tells the images apart, the same in both folders of a pair: "3" of left000003.png,
  /// "1403636579.763555" of 1403636579.763555.png; the name without its ending where no number
  /// does.
  std::vector<std::string> keys;
  /// The keys as whole numbers; empty where they are none.
  std::vector<std::uint64_t> numbers;
  std::vector<std::string> notes;
};

/// Lists the .png, .jpg and .jpeg files of a folder. Throws InputError where it cannot be read, has
/// no image (naming the files of other kinds), has two files of one number, or two series of names
/// (none is less than a quarter of the other), so that it is not known which is meant.
ImageNames ListImages(const std::string& folder);

/// Throws InputError with both counts and the first names without a partner where the keys of left
/// and right differ.
void CheckPairs(const ImageNames& left, const ImageNames& right);

/// Names of files with this ending (".txt") that belong to images, one an image, "" where there is
/// none: the file whose name is that of the left or right image, else the one of the same number.
/// Nothing but exact names where the folder holds several series of names. A folder that is not
/// there holds nothing.
std::vector<std::string> FindPartners(const std::string& folder, const std::string& ending,
                                      const ImageNames& left, const ImageNames& right);

/// Whether a folder has a .png, .jpg or .jpeg file that is not hidden.
bool HoldsImages(const std::string& folder);

/// Times of the images (us) where the names say them: seconds with decimals, or s, ms, us or ns
/// since 1970, or us or ns since whatever (steps of 5000 and more are no image numbers).
struct NamedTimes {
  std::vector<std::int64_t> utimes;
  std::string unit;
};
std::optional<NamedTimes> TimesFromNames(const ImageNames& names);

}  // namespace airdos

#endif  // AIRDOS_COMMON_DATASET_IMAGE_NAMES_H_
