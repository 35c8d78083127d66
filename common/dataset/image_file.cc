#include "common/dataset/image_file.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <opencv2/imgcodecs.hpp>

#include "common/dataset/sequence_files.h"
#include "common/util/error.h"
#include "common/util/format.h"

namespace airdos {
namespace {

constexpr char kCutShort[] =
    "is cut short (the file ends before its picture does: a full disk or a broken copy?)";

std::string WhyHeaderIsNone(const std::uint8_t* data, std::size_t size) {
  const std::string kind = FileKindOf(data, size);
  if (kind == "empty") return "is empty";
  if (kind == "a JPEG file" || kind == "a PNG file") return "cannot be decoded as an image";
  const std::string neither = "is neither a JPEG nor a PNG file";
  return kind == "a file of unknown kind" ? neither : neither + " but " + kind;
}

std::string WhyHeaderIsUnfit(const ImageHeader& header) {
  if (header.is_png) return "";
  if (header.num_channels == 4) return "is a JPEG in CMYK (for printers); grey or RGB is expected";
  if (header.bits != 8) {
    return "is a JPEG with " + std::to_string(header.bits) + " bits per sample; 8 are expected";
  }
  return "";
}

cv::Mat Decode(const std::vector<std::uint8_t>& file, const std::string& name, int flags) {
  cv::Mat image;
  try {
    image = cv::imdecode(file, flags | cv::IMREAD_IGNORE_ORIENTATION);
  } catch (const cv::Exception&) {  // e.g. a PNG variant that OpenCV does not support
    image.release();
  }
  if (image.empty()) {
    throw InputError(name + ": cannot be decoded as an image (is it damaged?)");
  }
  return image;
}

bool HasSixteenBits(const std::vector<std::uint8_t>& file) {
  const std::optional<ImageHeader> header = ReadImageHeader(file.data(), file.size());
  return header && header->is_png && header->bits == 16;
}

/// Number of samples by number of significant bits.
using BitHistogram = std::array<std::int64_t, 17>;

void CountBits(const cv::Mat& image, BitHistogram* histogram) {
  const int samples_per_row = image.cols * image.channels();
  for (int row = 0; row < image.rows; ++row) {
    const auto* samples = image.ptr<std::uint16_t>(row);
    for (int i = 0; i < samples_per_row; ++i) {
      std::size_t bits = 0;
      for (unsigned value = samples[i]; value != 0; value >>= 1) ++bits;
      ++(*histogram)[bits];
    }
  }
}

int SignificantBits(const BitHistogram& histogram) {
  constexpr double kHotPixels = 1e-4;  // hot pixels must not darken all others
  std::int64_t num_samples = 0;
  for (const std::int64_t count : histogram) num_samples += count;
  std::int64_t num_above = 0;
  int bits = 16;
  for (; bits > 0; --bits) {
    num_above += histogram[static_cast<std::size_t>(bits)];
    if (static_cast<double>(num_above) > kHotPixels * static_cast<double>(num_samples)) break;
  }
  return bits;
}

}  // namespace

std::string WhyNoPicture(const std::uint8_t* data, std::size_t size) {
  const std::string kind = FileKindOf(data, size);
  if (kind != "a JPEG file" && kind != "a PNG file") return WhyHeaderIsNone(data, size);
  if (IsCutShort(data, size)) return kCutShort;
  const std::optional<ImageHeader> header = ReadImageHeader(data, size);
  return header ? WhyHeaderIsUnfit(*header) : WhyHeaderIsNone(data, size);
}

std::string RangeText(const SixteenBitRange& range) {
  return "16-bit images with " + std::to_string(range.bits) +
         " significant bits: " + (range.shift() == 0 ? "taken as 8 bits" : "divided by ") +
         (range.shift() == 0 ? "" : std::to_string(1 << range.shift()));
}

std::optional<SixteenBitRange> FindSixteenBitRange(const StereoSequence& sequence) {
  constexpr std::size_t kMaxPairs = 10;
  const std::size_t num_frames = sequence.num_frames();
  const std::size_t num_pairs = std::min(num_frames, kMaxPairs);
  std::vector<std::string> paths;
  for (std::size_t i = 0; i < num_pairs; ++i) {
    const FrameFiles files =
        sequence.files(num_pairs == 1 ? 0 : i * (num_frames - 1) / (num_pairs - 1));
    paths.push_back(files.left_image);
    paths.push_back(files.right_image);
  }
  return FindSixteenBitRange(paths);
}

std::optional<SixteenBitRange> FindSixteenBitRange(const std::vector<std::string>& paths) {
  constexpr std::size_t kMaxFiles = 20;
  const std::size_t num_files = std::min(paths.size(), kMaxFiles);
  BitHistogram histogram = {};
  bool has_any = false;
  for (std::size_t i = 0; i < num_files; ++i) {
    const std::string& path = paths[num_files == 1 ? 0 : i * (paths.size() - 1) / (num_files - 1)];
    try {
      const std::vector<std::uint8_t> file = ReadBytes(path);
      if (!HasSixteenBits(file) || IsCutShort(file.data(), file.size())) continue;
      CountBits(Decode(file, path, cv::IMREAD_ANYCOLOR | cv::IMREAD_ANYDEPTH), &histogram);
      has_any = true;
    } catch (const InputError&) {  // reported when this picture is read
    }
  }
  if (!has_any) return std::nullopt;
  return SixteenBitRange{SignificantBits(histogram)};
}

Picture DecodePicture(const std::vector<std::uint8_t>& file, const std::string& name,
                      PictureColor color, const SixteenBitRange& range) {
  const std::string why = WhyNoPicture(file.data(), file.size());
  if (!why.empty()) throw InputError(name + ": " + why);
  Picture picture;
  const int flags = color == PictureColor::kGrey ? cv::IMREAD_GRAYSCALE : cv::IMREAD_ANYCOLOR;
  if (!HasSixteenBits(file)) {
    picture.pixels = Decode(file, name, flags);
    return picture;
  }
  const cv::Mat samples = Decode(file, name, flags | cv::IMREAD_ANYDEPTH);
  // In integers, so that it is a bit shift on every machine: OpenCV's own scaling rounds.
  picture.pixels.create(samples.size(), CV_8UC(samples.channels()));
  std::int64_t num_saturated = 0;
  for (int row = 0; row < samples.rows; ++row) {
    const auto* from = samples.ptr<std::uint16_t>(row);
    auto* to = picture.pixels.ptr<std::uint8_t>(row);
    for (int i = 0; i < samples.cols * samples.channels(); ++i) {
      const int value = from[i] >> range.shift();
      num_saturated += value > 255 ? 1 : 0;
      to[i] = static_cast<std::uint8_t>(std::min(value, 255));
    }
  }
  picture.saturated =
      static_cast<double>(num_saturated) /
      static_cast<double>(samples.total() * static_cast<std::size_t>(samples.channels()));
  return picture;
}

/// The first and last bytes of a file, or all of it if these are not enough.
SurveyedImage SurveyImage(const std::string& path, bool is_left) {
  SurveyedImage image;
  image.path = path;
  image.is_left = is_left;
  constexpr std::size_t kHeadBytes = 4096;
  constexpr std::streamoff kTailBytes = 16;
  std::ifstream file(path, std::ios::binary);
  std::vector<std::uint8_t> head(kHeadBytes);
  file.read(reinterpret_cast<char*>(head.data()), static_cast<std::streamsize>(head.size()));
  head.resize(static_cast<std::size_t>(file.gcount()));
  file.clear();
  file.seekg(-kTailBytes, std::ios::end);
  std::string tail(kTailBytes, '\0');
  file.read(tail.data(), kTailBytes);
  image.header = ReadImageHeader(head.data(), head.size());
  const bool has_end = image.header && file && head.size() == kHeadBytes &&
                       (image.header->is_png ? tail.find("IEND") != std::string::npos
                                             : tail.find("\xFF\xD9") != std::string::npos);
  if (has_end && WhyHeaderIsUnfit(*image.header).empty()) return image;
  try {
    const std::vector<std::uint8_t> bytes = ReadBytes(path);
    image.header = ReadImageHeader(bytes.data(), bytes.size());
    const std::string why = WhyNoPicture(bytes.data(), bytes.size());
    if (!why.empty()) image.error = path + ": " + why;
  } catch (const InputError& error) {
    image.error = error.what();
  }
  return image;
}

std::vector<SurveyedImage> SurveyImages(const StereoSequence& sequence) {
  std::vector<SurveyedImage> images;
  for (std::size_t i = 0; i < sequence.num_frames(); ++i) {
    const FrameFiles files = sequence.files(i);
    images.push_back(SurveyImage(files.left_image, true));
    images.push_back(SurveyImage(files.right_image, false));
  }
  return images;
}

std::string SizeMismatchText(std::int64_t width, std::int64_t height, const std::string& whose,
                             std::int64_t wanted_width, std::int64_t wanted_height) {
  const auto size = [](std::int64_t w, std::int64_t h) {
    return std::to_string(w) + " x " + std::to_string(h);
  };
  std::string text = "has " + size(width, height) + " px, " + whose + " " +
                     size(wanted_width, wanted_height) + " px";
  const double factor = static_cast<double>(width) / static_cast<double>(wanted_width);
  const double factor_y = static_cast<double>(height) / static_cast<double>(wanted_height);
  if (width == wanted_height && height == wanted_width) return text + ": turned by 90 degrees";
  if (std::abs(factor / factor_y - 1) > 0.02) return text + ": with another aspect ratio";
  return text + Format(": %.3g times as large", factor);
}

std::vector<std::uint8_t> EncodePng(const cv::Mat& pixels) {
  std::vector<std::uint8_t> file;
  constexpr int kFast = 1;
  cv::imencode(".png", pixels, file, {cv::IMWRITE_PNG_COMPRESSION, kFast});
  return file;
}

}  // namespace airdos
