#include "processes/node/message/image_codec.h"

#include <cstddef>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "common/dataset/image_file.h"
#include "common/util/error.h"
#include "common/util/image_header.h"

namespace airdos {
namespace {

constexpr char kDoesNotDecode[] = "the image cannot be decoded";

/// Checks what the file claims before the decoder allocates memory for it. Empty if it may be
/// decoded.
std::string WhyNoFile(const image_t& message) {
  const std::vector<std::uint8_t>& data = message.data;
  const std::string why = WhyNoPicture(data.data(), data.size());
  if (!why.empty()) return "the image " + why;
  const ImageHeader header = *ReadImageHeader(data.data(), data.size());
  if (header.width != message.width || header.height != message.height) {
    return "the image " + SizeMismatchText(header.width, header.height, "its message says",
                                           message.width, message.height);
  }
  if (header.bits == 16) {
    return "the image has 16 bits per sample, but the range depends on the whole sequence: send 8 "
           "bits";
  }
  return "";
}

std::optional<cv::Mat> DecodeFile(const image_t& message, int flags, std::string* reason) {
  *reason = WhyNoFile(message);
  if (!reason->empty()) return std::nullopt;
  *reason = kDoesNotDecode;
  try {
    const cv::Mat file(1, static_cast<int>(message.data.size()), CV_8UC1,
                       const_cast<unsigned char*>(message.data.data()));
    // Pixels as stored: left and right must not differ because of an orientation in a header.
    cv::Mat image = cv::imdecode(file, flags | cv::IMREAD_IGNORE_ORIENTATION);
    if (image.empty() || image.cols != message.width || image.rows != message.height) {
      return std::nullopt;
    }
    return image;
  } catch (const cv::Exception&) {  // e.g. a format that OpenCV does not support
    return std::nullopt;
  }
}

// Wraps pixels without padding; `type` is CV_8UC1 or CV_8UC3.
std::optional<cv::Mat> WrapRaw(const image_t& message, int type) {
  if (message.width <= 0 || message.height <= 0) return std::nullopt;
  const std::size_t num_bytes = static_cast<std::size_t>(message.width) *
                                static_cast<std::size_t>(message.height) *
                                static_cast<std::size_t>(CV_MAT_CN(type));
  if (message.data.size() != num_bytes) return std::nullopt;
  return cv::Mat(message.height, message.width, type,
                 const_cast<unsigned char*>(message.data.data()));
}

std::optional<cv::Mat> Decode(const image_t& message, bool is_color, std::string* reason) {
  std::string unused;
  if (reason == nullptr) reason = &unused;
  const int own_type = is_color ? CV_8UC3 : CV_8UC1;
  switch (message.encoding) {
    case image_t::ENCODING_JPEG:
    case image_t::ENCODING_PNG:
      return DecodeFile(message, is_color ? cv::IMREAD_COLOR : cv::IMREAD_GRAYSCALE, reason);
    case image_t::ENCODING_RAW_GRAY8:
    case image_t::ENCODING_RAW_BGR8:
      break;
    default:
      *reason = "the image has the unknown encoding " + std::to_string(message.encoding);
      return std::nullopt;
  }
  const int raw_type = message.encoding == image_t::ENCODING_RAW_BGR8 ? CV_8UC3 : CV_8UC1;
  const std::optional<cv::Mat> raw = WrapRaw(message, raw_type);
  if (!raw) {
    *reason = "the raw image has not as many bytes as its width and height say";
    return std::nullopt;
  }
  if (raw_type == own_type) return raw->clone();
  cv::Mat converted;
  cv::cvtColor(*raw, converted, is_color ? cv::COLOR_GRAY2BGR : cv::COLOR_BGR2GRAY);
  return converted;
}

}  // namespace

std::optional<cv::Mat> DecodeGray(const image_t& message, std::string* reason) {
  return Decode(message, false, reason);
}

std::optional<cv::Mat> DecodeColor(const image_t& message, std::string* reason) {
  return Decode(message, true, reason);
}

std::optional<PersonMask> DecodeMaskMessage(const person_mask_t& message, std::string* reason) {
  std::string unused;
  if (reason == nullptr) reason = &unused;
  PersonMask mask;
  if (message.encoding == person_mask_t::ENCODING_PNG) {
    try {
      mask = DecodePersonMask(message.data.data(), message.data.size(), "the mask");
    } catch (const InputError& error) {
      *reason = error.what();
      return std::nullopt;
    }
    if (mask.pixels.cols == message.width && mask.pixels.rows == message.height) return mask;
    *reason = "the mask " + SizeMismatchText(mask.pixels.cols, mask.pixels.rows, "its message says",
                                             message.width, message.height);
    return std::nullopt;
  }
  if (message.encoding != person_mask_t::ENCODING_RAW_GRAY8) {
    *reason = "the mask has the unknown encoding " + std::to_string(message.encoding);
    return std::nullopt;
  }
  image_t image;
  image.width = message.width;
  image.height = message.height;
  image.num_bytes = message.num_bytes;
  image.encoding = image_t::ENCODING_RAW_GRAY8;
  image.data = message.data;
  const std::optional<cv::Mat> values = DecodeGray(image, reason);
  if (!values) return std::nullopt;
  return PersonMask{*values != 0, *values, "8-bit grey", ""};
}

std::optional<cv::Mat> DecodeMask(const person_mask_t& message, std::string* reason) {
  const std::optional<PersonMask> mask = DecodeMaskMessage(message, reason);
  if (!mask) return std::nullopt;
  return mask->pixels;
}

}  // namespace airdos
