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

/// Why the bytes cannot be a camera's picture, in words that follow a file's name; empty where they
/// can: neither JPEG nor PNG, cut short, no header that can be believed, CMYK, a 12-bit JPEG.
std::string WhyNoPicture(const std::uint8_t* data, std::size_t size);

/// How the samples of 16-bit pictures become 8 bits: divided by 2^shift, what is above 255 is 255.
struct SixteenBitRange {
  int bits = 16;  ///< significant ones: at most one sample in 10000 needs more
  int shift() const { return bits > 8 ? bits - 8 : 0; }
};

/// "16-bit images with 12 significant bits: divided by 16".
std::string RangeText(const SixteenBitRange& range);

/// What up to 20 pictures, evenly spread over both cameras, hold: one range for the sequence, so
/// that a surface keeps its grey from image to image and from left to right. Pictures that cannot
/// be read, or have 8 bits, do not count. Nothing where none has 16.
std::optional<SixteenBitRange> FindSixteenBitRange(const StereoSequence& sequence);

enum class PictureColor {
  kGrey,      ///< CV_8UC1
  kAsStored,  ///< CV_8UC1 or, where the file has colours, CV_8UC3 (blue, green, red)
};

/// A decoded picture of 8 bits, its pixels where the file has them: EXIF's wish to turn it is
/// ignored, as every other program of a chain ignores it or not, and left and right must not
/// differ. An alpha channel is left out.
struct Picture {
  cv::Mat pixels;
  double saturated = 0;  ///< share of the samples of a 16-bit picture that lie above the range
};

/// Throws InputError "NAME: why".
Picture DecodePicture(const std::vector<std::uint8_t>& file, const std::string& name,
                      PictureColor color, const SixteenBitRange& range);

/// What the head and the tail of one image file say; nothing was decoded.
struct SurveyedImage {
  std::string path;
  bool is_left = true;
  std::optional<ImageHeader> header;  ///< none: see error
  std::string error;                  ///< "PATH: why it cannot be used"; empty: it can
};

/// All images of a sequence, left and right in turn. About 20 us a file.
std::vector<SurveyedImage> SurveyImages(const StereoSequence& sequence);

/// "has 320 x 180 px, the camera 640 x 360: half as large", with the factor where there is one.
std::string SizeMismatchText(std::int64_t width, std::int64_t height, const std::string& whose,
                             std::int64_t wanted_width, std::int64_t wanted_height);

}  // namespace airdos

#endif  // AIRDOS_COMMON_DATASET_IMAGE_FILE_H_
