#include "processes/stereo_player/image_packer.h"

#include <cmath>
#include <cstring>
#include <opencv2/imgcodecs.hpp>
#include <utility>

#include "common/util/error.h"

namespace airdos {
namespace {

bool IsJpeg(const std::vector<std::uint8_t>& file) {
  return file.size() > 3 && file[0] == 0xFF && file[1] == 0xD8 && file[2] == 0xFF;
}

bool IsPng(const std::vector<std::uint8_t>& file) {
  constexpr std::uint8_t kSignature[] = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n'};
  return file.size() > sizeof(kSignature) &&
         std::memcmp(file.data(), kSignature, sizeof(kSignature)) == 0;
}

void SetData(std::vector<std::uint8_t> bytes, std::int8_t encoding, image_t* message) {
  message->encoding = encoding;
  message->num_bytes = static_cast<std::int32_t>(bytes.size());
  message->data = std::move(bytes);
}

}  // namespace

void ImagePacker::Note(const std::string& kind, const std::string& note) {
  if (said_.insert(kind).second) notes_.push_back(note);
}

void ImagePacker::NoteLarge() {
  Note("large", "PNG images above the limit: receivers need a large socket buffer");
}

void ImagePacker::NotePixels(const ImageHeader& header, const Picture& picture,
                             const std::string& name) {
  if (header.orientation != 1) {
    Note("orientation " + std::to_string(header.orientation),
         name + ": its EXIF data want it " + OrientationText(header.orientation) +
             "; this is ignored, pixels are used as stored");
  }
  if (header.bits == 16) Note("range", RangeText(range_));
  if (picture.saturated > 1e-3) {
    Note("saturated", name + ": " + std::to_string(std::lround(100 * picture.saturated)) +
                          " % of its samples have more than " + std::to_string(range_.bits) +
                          " bits and are clipped to white");
  }
  if (header.has_alpha()) Note("alpha", name + ": its alpha channel is not used");
}

std::vector<std::string> ImagePacker::TakeNotes() { return std::exchange(notes_, {}); }

bool ImagePacker::PackUnchanged(const std::vector<std::uint8_t>& file, image_t* message) {
  using Encoding = ImagePackerOptions::Encoding;
  const bool fits = static_cast<int>(file.size()) <= options_.max_image_bytes;
  if (IsJpeg(file) && options_.encoding != Encoding::kPng && fits) {
    SetData(file, image_t::ENCODING_JPEG, message);
    return true;
  }
  if (IsPng(file) &&
      (options_.encoding == Encoding::kPng || (options_.encoding == Encoding::kAuto && fits))) {
    if (!fits) NoteLarge();
    SetData(file, image_t::ENCODING_PNG, message);
    return true;
  }
  return false;
}

/// Whether it fits is only tried where it may: images of a scene shrink to about half as PNG, and
/// to compress them costs more than all else that is done with them.
bool ImagePacker::PackSmall(const cv::Mat& pixels, image_t* message) {
  const std::size_t num_bytes = pixels.total() * pixels.elemSize();
  if (options_.encoding != ImagePackerOptions::Encoding::kAuto ||
      num_bytes / 2 > static_cast<std::size_t>(options_.max_image_bytes)) {
    return false;
  }
  return PackUnchanged(EncodePng(pixels), message);
}

void ImagePacker::PackPng(const cv::Mat& image, image_t* message) {
  std::vector<std::uint8_t> bytes;
  cv::imencode(".png", image, bytes);
  if (static_cast<int>(bytes.size()) > options_.max_image_bytes) NoteLarge();
  SetData(std::move(bytes), image_t::ENCODING_PNG, message);
}

bool ImagePacker::PackJpeg(const cv::Mat& image, image_t* message) {
  std::vector<std::uint8_t> bytes;
  for (const int quality : options_.jpeg_qualities) {
    cv::imencode(".jpg", image, bytes, {cv::IMWRITE_JPEG_QUALITY, quality});
    if (static_cast<int>(bytes.size()) > options_.max_image_bytes) continue;
    Note("quality " + std::to_string(quality),
         "images are encoded as JPEG with quality " + std::to_string(quality) + " to fit into " +
             std::to_string(options_.max_image_bytes) + " bytes");
    SetData(std::move(bytes), image_t::ENCODING_JPEG, message);
    return true;
  }
  return false;
}

void ImagePacker::Pack(const std::vector<std::uint8_t>& file, const std::string& name,
                       image_t* message) {
  const Picture picture = DecodePicture(file, name, PictureColor::kAsStored, range_);
  const ImageHeader header = *ReadImageHeader(file.data(), file.size());
  NotePixels(header, picture, name);
  message->width = picture.pixels.cols;
  message->height = picture.pixels.rows;
  if (header.bits != 16 && PackUnchanged(file, message)) return;
  PackDecoded(picture.pixels, name, message);
}

void ImagePacker::Pack(const cv::Mat& pixels, const std::string& name, image_t* message) {
  message->width = pixels.cols;
  message->height = pixels.rows;
  if (!PackSmall(pixels, message)) PackDecoded(pixels, name, message);
}

void ImagePacker::PackDecoded(const cv::Mat& pixels, const std::string& name, image_t* message) {
  if (options_.encoding == ImagePackerOptions::Encoding::kPng) {
    PackPng(pixels, message);
  } else if (!PackJpeg(pixels, message)) {
    throw InputError(name + ": does not fit into " + std::to_string(options_.max_image_bytes) +
                     " bytes at any of the JPEG qualities");
  }
}

}  // namespace airdos
