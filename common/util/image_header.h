#ifndef AIRDOS_COMMON_UTIL_IMAGE_HEADER_H_
#define AIRDOS_COMMON_UTIL_IMAGE_HEADER_H_

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

namespace airdos {

/// Images above this are refused, whatever they come in: 4000 x 3000. The most that any step makes
/// of an image, four bytes a pixel, then still is below 64 MB.
inline constexpr std::int64_t kMaxImagePixels = 12000000;

struct ImageHeader {
  std::int64_t width = 0;   ///< px
  std::int64_t height = 0;  ///< px
  bool is_png = false;      ///< else JPEG
  int bits = 8;             ///< of a sample
  /// Samples of a pixel. PNG: 1 grey or index, 2 grey and alpha, 3 RGB, 4 RGB and alpha. JPEG: 1
  /// grey, 3 colour, 4 CMYK.
  int num_channels = 1;
  bool is_palette = false;  ///< samples are indices into a palette (PNG)
  int orientation = 1;      ///< EXIF's wish to turn or mirror the picture, 1..8; 1: as it is stored

  bool has_alpha() const { return is_png && (num_channels == 2 || num_channels == 4); }
};

/// What a JPEG or PNG file says of itself before anything is decoded: decoders make room for what
/// the header claims, so a file of 100 bytes costs gigabytes, and a JPEG of a thousand scans costs
/// hours. Nothing where the bytes are no such file, where it claims no pixels or more than
/// kMaxImagePixels, or where a JPEG has more than kMaxJpegScans scans (progressive ones have about
/// ten).
inline constexpr int kMaxJpegScans = 64;
std::optional<ImageHeader> ReadImageHeader(const std::uint8_t* data, std::size_t size);

/// Whether a JPEG or PNG file ends before its picture does: a JPEG without an end of image (FF D9)
/// after its first start of scan, a PNG whose chunks do not lead to IEND. What follows the end does
/// not count. Decoders fill up the rest of such a JPEG with grey and say nothing.
bool IsCutShort(const std::uint8_t* data, std::size_t size);

/// What kind of file the first bytes are those of, in words: "a JPEG file", "a TIFF file", "a NumPy
/// array (.npy)", "a Git LFS pointer, not the file itself", "empty"; "a file of unknown kind".
std::string FileKindOf(const std::uint8_t* data, std::size_t size);

/// "turned by 180 degrees": what an EXIF orientation of 2..8 asks for.
std::string OrientationText(int orientation);

}  // namespace airdos

#endif  // AIRDOS_COMMON_UTIL_IMAGE_HEADER_H_
