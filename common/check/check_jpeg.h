#ifndef AIRDOS_COMMON_CHECK_JPEG_H_
#define AIRDOS_COMMON_CHECK_JPEG_H_

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/check/check_findings.h"

namespace airdos {

/// The quality (1..100) with which libjpeg would have written such a file, from the quantization of
/// its brightness (ITU T.81, annex K.1; the scale is libjpeg's). Nothing where it is no JPEG file
/// or holds no such table of 8 bits.
std::optional<int> JpegQuality(const std::vector<std::uint8_t>& file);

/// Says how well images are compressed: below 70 corners suffer.
class JpegCheck {
 public:
  void Add(const std::vector<std::uint8_t>& file);
  void Report(const std::string& where, FindingList* findings) const;

 private:
  std::vector<double> qualities_;
};

}  // namespace airdos

#endif  // AIRDOS_COMMON_CHECK_JPEG_H_
