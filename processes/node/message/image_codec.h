#ifndef AIRDOS_PROCESSES_NODE_MESSAGE_IMAGE_CODEC_H_
#define AIRDOS_PROCESSES_NODE_MESSAGE_IMAGE_CODEC_H_

#include <opencv2/core.hpp>
#include <optional>
#include <string>

#include "airdos/image_t.hpp"
#include "airdos/person_mask_t.hpp"
#include "common/dataset/mask_file.h"

namespace airdos {

/// Pixels of an image message, width x height as its header says: 8-bit grey (CV_8UC1) or
/// blue-green-red (CV_8UC3), whatever the encoding, as they are stored (EXIF's wish to turn them is
/// ignored). Nothing where the bytes do not decode or are cut short, where the file has another
/// size than the message says (looked at before it is decoded, see common/util/image_header.h), 16
/// bits a sample, or where the encoding is unknown; `reason` then says which, "the image is cut
/// short
/// ...". A result never points into the message.
std::optional<cv::Mat> DecodeGray(const image_t& message, std::string* reason = nullptr);
std::optional<cv::Mat> DecodeColor(const image_t& message, std::string* reason = nullptr);

/// A mask message as common/dataset/mask_file.h reads it; nothing in the same cases, where that
/// refuses the kind of mask, or where it holds none: `reason` then says which.
std::optional<PersonMask> DecodeMaskMessage(const person_mask_t& message,
                                            std::string* reason = nullptr);
/// Its pixels alone (CV_8UC1, 255 = a person, 0 = background).
std::optional<cv::Mat> DecodeMask(const person_mask_t& message, std::string* reason = nullptr);

}  // namespace airdos

#endif  // AIRDOS_PROCESSES_NODE_MESSAGE_IMAGE_CODEC_H_
