#include "processes/node/image_codec.h"

#include <cstddef>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "common/util/image_header.h"

namespace airdos {
namespace {

std::optional<cv::Mat> DecodeFile(const image_t& message, int flags) {
  // What the file claims is looked at before the decoder makes room for it.
  const std::optional<ImageHeader> header =
      ReadImageHeader(message.data.data(), message.data.size());
  if (!header || header->width != message.width || header->height != message.height) {
    return std::nullopt;
  }
  try {
    const cv::Mat file(1, static_cast<int>(message.data.size()), CV_8UC1,
                       const_cast<unsigned char*>(message.data.data()));
    cv::Mat image = cv::imdecode(file, flags);
    if (image.empty() || image.cols != message.width || image.rows != message.height) {
      return std::nullopt;
    }
    return image;
  } catch (const cv::Exception&) {  // e.g. a kind of file that OpenCV does not know
    return std::nullopt;
  }
}

// Pixels without padding; `type` is CV_8UC1 or CV_8UC3.
std::optional<cv::Mat> WrapRaw(const image_t& message, int type) {
  if (message.width <= 0 || message.height <= 0) return std::nullopt;
  const std::size_t num_bytes = static_cast<std::size_t>(message.width) *
                                static_cast<std::size_t>(message.height) *
                                static_cast<std::size_t>(CV_MAT_CN(type));
  if (message.data.size() != num_bytes) return std::nullopt;
  return cv::Mat(message.height, message.width, type,
                 const_cast<unsigned char*>(message.data.data()));
}

std::optional<cv::Mat> Decode(const image_t& message, bool is_color) {
  const int own_type = is_color ? CV_8UC3 : CV_8UC1;
  switch (message.encoding) {
    case image_t::ENCODING_JPEG:
    case image_t::ENCODING_PNG:
      return DecodeFile(message, is_color ? cv::IMREAD_COLOR : cv::IMREAD_GRAYSCALE);
    case image_t::ENCODING_RAW_GRAY8:
    case image_t::ENCODING_RAW_BGR8:
      break;
    default:
      return std::nullopt;
  }
  const int raw_type = message.encoding == image_t::ENCODING_RAW_BGR8 ? CV_8UC3 : CV_8UC1;
  const std::optional<cv::Mat> raw = WrapRaw(message, raw_type);
  if (!raw) return std::nullopt;
  if (raw_type == own_type) return raw->clone();
  cv::Mat converted;
  cv::cvtColor(*raw, converted, is_color ? cv::COLOR_GRAY2BGR : cv::COLOR_BGR2GRAY);
  return converted;
}

}  // namespace

std::optional<cv::Mat> DecodeGray(const image_t& message) { return Decode(message, false); }

std::optional<cv::Mat> DecodeColor(const image_t& message) { return Decode(message, true); }

std::optional<cv::Mat> DecodeMask(const person_mask_t& message) {
  image_t image;
  image.width = message.width;
  image.height = message.height;
  image.num_bytes = message.num_bytes;
  image.data = message.data;
  switch (message.encoding) {
    case person_mask_t::ENCODING_PNG:
      image.encoding = image_t::ENCODING_PNG;
      break;
    case person_mask_t::ENCODING_RAW_GRAY8:
      image.encoding = image_t::ENCODING_RAW_GRAY8;
      break;
    default:
      return std::nullopt;
  }
  return DecodeGray(image);
}

}  // namespace airdos
