#ifndef AIRDOS_COMMON_DATASET_IMAGE_FILE_H_
#define AIRDOS_COMMON_DATASET_IMAGE_FILE_H_

#include <cstdint>
#include <opencv2/core.hpp>
#include <optional>
#include <string>
#include <vector>

#include "common/dataset/stereo_sequence.h"
#include "common/util/image_header.h"

namespace airdos {

/// Why the bytes cannot be a camera image, in words that follow a file name; empty if they can.
/// Reasons: neither JPEG nor PNG, truncated, no credible header, CMYK, a 12-bit JPEG.
std::string WhyNoPicture(const std::uint8_t* data, std::size_t size);

/// How samples of 16-bit pictures become 8 bits: divided by 2^shift and limited to 255.
struct SixteenBitRange {
  int bits = 16;  ///< significant bits: at most one sample in 10000 needs more
  int shift() const { return bits > 8 ? bits - 8 : 0; }
};

/// "16-bit images with 12 significant bits: divided by 16".
std::string RangeText(const SixteenBitRange& range);

/// Determines the range from up to 20 pictures, evenly spread over both cameras: one range for the
/// whole sequence, so that a surface keeps its grey value from image to image and from left to
/// right. Pictures that cannot be read or have 8 bits are ignored. Nothing if none has 16 bits.
std::optional<SixteenBitRange> FindSixteenBitRange(const StereoSequence& sequence);

/// The same from up to 20 of these files, evenly spread.
std::optional<SixteenBitRange> FindSixteenBitRange(const std::vector<std::string>& paths);

/// A PNG file of an image, quickly and therefore not as small as can be. The same for the same
/// pixels.
std::vector<std::uint8_t> EncodePng(const cv::Mat& pixels);

/// How DecodePicture() treats colour.
enum class PictureColor {
  kGrey,      ///< CV_8UC1
  kAsStored,  ///< CV_8UC1, or CV_8UC3 (BGR) if the file has colours
};

/// A decoded picture of 8 bits, with the pixels in the file's own order: the EXIF orientation is
/// ignored, since other programs handle it differently and left and right must agree. An alpha
/// channel is dropped.
struct Picture {
  cv::Mat pixels;
  double saturated = 0;  ///< share of a 16-bit picture's samples that exceed the range
};

/// Decodes an image file. Throws InputError "NAME: why".
Picture DecodePicture(const std::vector<std::uint8_t>& file, const std::string& name,
                      PictureColor color, const SixteenBitRange& range);

/// What the beginning and end of an image file reveal without decoding it.
struct SurveyedImage {
  std::string path;
  bool is_left = true;
  std::optional<ImageHeader> header;  ///< if none, see error
  std::string error;                  ///< "PATH: why it cannot be used"; empty if it can
};

/// Takes about 20 us.
SurveyedImage SurveyImage(const std::string& path, bool is_left);
/// Surveys all images of a sequence, alternating left and right.
std::vector<SurveyedImage> SurveyImages(const StereoSequence& sequence);

/// "has 320 x 180 px, the camera 640 x 360: half as large"; the factor only if there is a common
/// one.
std::string SizeMismatchText(std::int64_t width, std::int64_t height, const std::string& whose,
                             std::int64_t wanted_width, std::int64_t wanted_height);

}  // namespace airdos

#endif  // AIRDOS_COMMON_DATASET_IMAGE_FILE_H_
