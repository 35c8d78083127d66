#ifndef AIRDOS_COMMON_UTIL_IMAGE_HEADER_H_
#define AIRDOS_COMMON_UTIL_IMAGE_HEADER_H_

#include <cstddef>
#include <cstdint>
#include <optional>

namespace airdos {

/// Images above this are refused, whatever they come in: 4000 x 3000. The most that any step makes
/// of an image, four bytes a pixel, then still is below 64 MB.
inline constexpr std::int64_t kMaxImagePixels = 12000000;

struct ImageHeader {
  std::int64_t width = 0;   ///< px
  std::int64_t height = 0;  ///< px
};

/// What a JPEG or PNG file says of itself before anything is decoded: decoders make room for what
/// the header claims, so a file of 100 bytes costs gigabytes, and a JPEG of a thousand scans costs
/// hours. Nothing where the bytes are no such file, where it claims no pixels or more than
/// kMaxImagePixels, or where a JPEG has more than kMaxJpegScans scans (progressive ones have about
/// ten).
inline constexpr int kMaxJpegScans = 64;
std::optional<ImageHeader> ReadImageHeader(const std::uint8_t* data, std::size_t size);

}  // namespace airdos

#endif  // AIRDOS_COMMON_UTIL_IMAGE_HEADER_H_
