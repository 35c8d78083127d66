#ifndef AIRDOS_PROCESSES_NODE_IMAGE_CODEC_H_
#define AIRDOS_PROCESSES_NODE_IMAGE_CODEC_H_

#include <opencv2/core.hpp>
#include <optional>

#include "airdos/image_t.hpp"
#include "airdos/person_mask_t.hpp"

namespace airdos {

/// Pixels of an image message, width x height as its header says: 8-bit grey (CV_8UC1) or
/// blue-green-red (CV_8UC3), whatever the encoding. Nothing where the bytes do not decode, where
/// the file has another size than the message says (looked at before it is decoded, see
/// common/util/image_header.h), or where the encoding is unknown. A result never points into the
/// message.
std::optional<cv::Mat> DecodeGray(const image_t& message);
std::optional<cv::Mat> DecodeColor(const image_t& message);

/// Pixels of a mask message (CV_8UC1, not 0 = a person); nothing in the same cases, or where it
/// holds no mask.
std::optional<cv::Mat> DecodeMask(const person_mask_t& message);

}  // namespace airdos

#endif  // AIRDOS_PROCESSES_NODE_IMAGE_CODEC_H_
