#ifndef AIRDOS_COMMON_DATASET_MASK_FILE_H_
#define AIRDOS_COMMON_DATASET_MASK_FILE_H_

#include <cstddef>
#include <cstdint>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

namespace airdos {

/// A mask of people as stored in its file.
struct PersonMask {
  cv::Mat pixels;    ///< CV_8UC1: 255 = person, 0 = background
  cv::Mat values;    ///< CV_8UC1 or CV_16UC1: values as stored; the largest of RGB
  std::string kind;  ///< "8-bit grey", "palette", "16-bit grey", "RGB"
  /// What makes the interpretation doubtful, in words; empty if nothing does.
  std::string doubt;
};

/// Reads a PNG mask by its stored values, not by the colours that a viewer would show. Grey with 1,
/// 2, 4, 8 or 16 bits: 0 is background. Palette: index 0 is background, whatever its colour. RGB
/// with 8 or 16 bits: black is background. Throws InputError "NAME: why" for anything else: an
/// alpha channel (which of the two is the mask?), JPEG (which blurs the values), other formats,
/// damaged or truncated files, and images larger than kMaxImagePixels.
PersonMask DecodePersonMask(const std::uint8_t* data, std::size_t size, const std::string& name);

/// Why DecodePersonMask() will refuse the bytes, judging by their header, in words that follow a
/// file name; empty if it will not.
std::string WhyNoMask(const std::uint8_t* data, std::size_t size);

/// Reads the mask of an image of width x height px and returns it in the form that receivers
/// expect: an 8-bit grey PNG, non-zero = person. A file in that form is passed on byte for byte,
/// without decoding. Throws InputError as above, and if the size differs.
std::vector<std::uint8_t> ReadMaskFile(const std::string& path, int width, int height);

/// The share of marked pixels whose value is slightly (1 to 12) above, or below, both neighbours in
/// the row or column. Ids of people or classes are constant over regions, and smoothed edges are
/// monotonic: below 0.01. A JPEG converted to PNG has ripples around every edge: 0.05 to 0.5.
double RippledShare(const PersonMask& mask);

/// Files in a mask folder that are named like an image but are not PNG, e.g. "000003.jpg", sorted;
/// hidden files are ignored.
std::vector<std::string> ListOtherMaskFiles(const std::string& folder);

}  // namespace airdos

#endif  // AIRDOS_COMMON_DATASET_MASK_FILE_H_
