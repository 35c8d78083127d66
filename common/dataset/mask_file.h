#ifndef AIRDOS_COMMON_DATASET_MASK_FILE_H_
#define AIRDOS_COMMON_DATASET_MASK_FILE_H_

#include <cstddef>
#include <cstdint>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

namespace airdos {

/// A mask of people as its file has it.
struct PersonMask {
  cv::Mat pixels;    ///< CV_8UC1: 255 = a person, 0 = background
  cv::Mat values;    ///< CV_8UC1 or CV_16UC1: numbers as stored; of RGB, the largest of the three
  std::string kind;  ///< "8-bit grey", "palette", "16-bit grey", "RGB"
  /// What makes the reading doubtful, in words; empty: nothing does.
  std::string doubt;
};

/// Reads a PNG mask: the numbers that it stores, whatever a viewer would paint for them. Grey of 1,
/// 2, 4, 8 or 16 bits: 0 is background. Palette: index 0 is background whatever its colour. RGB of
/// 8 or 16 bits: black is background. Throws InputError "NAME: why" for anything else: an alpha
/// channel (which of the two is the mask?), JPEG (it smears the numbers), other kinds of files,
/// files that are damaged or cut short, and images above kMaxImagePixels.
PersonMask DecodePersonMask(const std::uint8_t* data, std::size_t size, const std::string& name);

/// Why DecodePersonMask() will refuse the bytes, as far as their header says, in words that follow
/// a file's name; empty: it will not.
std::string WhyNoMask(const std::uint8_t* data, std::size_t size);

/// A mask file of an image of width x height px as receivers want it: an 8-bit grey PNG, not 0 = a
/// person. A file that is one is handed on byte for byte, undecoded. Throws InputError as above,
/// and where the size is another one.
std::vector<std::uint8_t> ReadMaskFile(const std::string& path, int width, int height);

/// The share of the marked pixels whose number is a little (1 to 12) above, or below, those of both
/// neighbours in its row or column. Numbers of people or classes are constant over regions, and
/// smoothed edges go one way: below 0.01. A JPEG that was made into a PNG ripples around every
/// edge: 0.05 to 0.5.
double RippledShare(const PersonMask& mask);

/// Files of other kinds than PNG that stand in a folder of masks under an image's name, e.g.
/// "000003.jpg", sorted; hidden files are passed over.
std::vector<std::string> ListOtherMaskFiles(const std::string& folder);

}  // namespace airdos

#endif  // AIRDOS_COMMON_DATASET_MASK_FILE_H_
