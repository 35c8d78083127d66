#ifndef AIRDOS_PROCESSES_NODE_MESSAGE_IMAGE_CODEC_H_
#define AIRDOS_PROCESSES_NODE_MESSAGE_IMAGE_CODEC_H_

#include <opencv2/core.hpp>
#include <optional>
#include <string>

#include "airdos/image_t.hpp"
#include "airdos/person_mask_t.hpp"
#include "common/dataset/mask_file.h"

namespace airdos {

/// Decodes an image message to pixels, width x height as in the message: 8-bit grey (CV_8UC1) or
/// BGR (CV_8UC3), whatever the encoding, as stored (the EXIF orientation is ignored). Nothing if
/// the bytes cannot be decoded or are truncated, if the file's size differs from the message's
/// (checked before decoding, see common/util/image_header.h), if there are 16 bits per sample, or
/// if the encoding is unknown; `reason` then says why, for example "the image is cut short ...".
/// The result never points into the message.
std::optional<cv::Mat> DecodeGray(const image_t& message, std::string* reason = nullptr);
std::optional<cv::Mat> DecodeColor(const image_t& message, std::string* reason = nullptr);

/// Decodes a mask message like common/dataset/mask_file.h. Nothing in the same cases, if that
/// refuses the format, or if there is no mask; `reason` then says why.
std::optional<PersonMask> DecodeMaskMessage(const person_mask_t& message,
                                            std::string* reason = nullptr);
/// Only its pixels (CV_8UC1, 255 = person, 0 = background).
std::optional<cv::Mat> DecodeMask(const person_mask_t& message, std::string* reason = nullptr);

}  // namespace airdos

#endif  // AIRDOS_PROCESSES_NODE_MESSAGE_IMAGE_CODEC_H_
