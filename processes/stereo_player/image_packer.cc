#include "processes/stereo_player/image_packer.h"

#include <algorithm>
#include <cstring>
#include <opencv2/imgcodecs.hpp>
#include <utility>

#include "common/util/error.h"
#include "common/util/image_header.h"

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

void ImagePacker::Note(const std::string& note) {
  if (std::find(said_.begin(), said_.end(), note) != said_.end()) return;
  said_.push_back(note);
  notes_.push_back(note);
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
    if (!fits) Note("PNG images above the limit: receivers need a large socket buffer");
    SetData(file, image_t::ENCODING_PNG, message);
    return true;
  }
  return false;
}

void ImagePacker::Pack(const std::vector<std::uint8_t>& file, const std::string& name,
                       image_t* message) {
  cv::Mat image;
  try {
    if (ReadImageHeader(file.data(), file.size()))
      image = cv::imdecode(file, cv::IMREAD_ANYCOLOR);  // 8 bit, grey or BGR
  } catch (const cv::Exception&) {
    image.release();
  }
  if (image.empty()) throw InputError(name + ": is no image that can be decoded");
  message->width = image.cols;
  message->height = image.rows;
  if (PackUnchanged(file, message)) return;

  std::vector<std::uint8_t> bytes;
  if (options_.encoding == ImagePackerOptions::Encoding::kPng) {
    cv::imencode(".png", image, bytes);
    if (static_cast<int>(bytes.size()) > options_.max_image_bytes) {
      Note("PNG images above the limit: receivers need a large socket buffer");
    }
    SetData(std::move(bytes), image_t::ENCODING_PNG, message);
    return;
  }
  for (const int quality : options_.jpeg_qualities) {
    cv::imencode(".jpg", image, bytes, {cv::IMWRITE_JPEG_QUALITY, quality});
    if (static_cast<int>(bytes.size()) > options_.max_image_bytes) continue;
    Note("images are encoded as JPEG of quality " + std::to_string(quality) + " to fit into " +
         std::to_string(options_.max_image_bytes) + " bytes");
    SetData(std::move(bytes), image_t::ENCODING_JPEG, message);
    return;
  }
  throw InputError(name + ": does not fit into " + std::to_string(options_.max_image_bytes) +
                   " bytes at any of the JPEG qualities");
}

}  // namespace airdos
