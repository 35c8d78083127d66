#ifndef AIRDOS_COMMON_CHECK_JPEG_H_
#define AIRDOS_COMMON_CHECK_JPEG_H_

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/check/check_findings.h"

namespace airdos {

/// The quality setting (1..100) at which libjpeg would have produced the file, from its luminance
/// quantization table (ITU T.81, annex K.1; the scale is libjpeg's). Nothing if it is not a JPEG
/// file or has no such 8-bit table.
std::optional<int> JpegQuality(const std::vector<std::uint8_t>& file);

/// Reports how strongly the images are compressed: below quality 70, corners suffer.
class JpegCheck {
 public:
  void Add(const std::vector<std::uint8_t>& file);
  void Report(const std::string& where, FindingList* findings) const;

 private:
  std::vector<double> qualities_;
};

}  // namespace airdos

#endif  // AIRDOS_COMMON_CHECK_JPEG_H_
