#ifndef AIRDOS_COMMON_UTIL_IMAGE_HEADER_H_
#define AIRDOS_COMMON_UTIL_IMAGE_HEADER_H_

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

namespace airdos {

/// Larger images are refused in any format: 4000 x 3000 px. The most memory that any step needs per
/// image, four bytes per pixel, then stays below 64 MB.
inline constexpr std::int64_t kMaxImagePixels = 12000000;

/// Properties that an image file declares in its header.
struct ImageHeader {
  std::int64_t width = 0;   ///< px
  std::int64_t height = 0;  ///< px
  bool is_png = false;      ///< otherwise JPEG
  int bits = 8;             ///< per sample
  /// Samples per pixel. PNG: 1 grey or index, 2 grey and alpha, 3 RGB, 4 RGB and alpha. JPEG: 1
  /// grey, 3 colour, 4 CMYK.
  int num_channels = 1;
  bool is_palette = false;  ///< samples are indices into a palette (PNG)
  int orientation = 1;      ///< EXIF orientation, 1..8; 1 means as stored

  bool has_alpha() const { return is_png && (num_channels == 2 || num_channels == 4); }
};

/// Reads the header of a JPEG or PNG file without decoding it. Decoders allocate whatever the
/// header claims, so a file of 100 bytes can cost gigabytes, and a JPEG with a thousand scans can
/// take hours. Nothing if the bytes are no such file, if it claims no pixels or more than
/// kMaxImagePixels, or if a JPEG has more than kMaxJpegScans scans (progressive ones have about
/// ten).
inline constexpr int kMaxJpegScans = 64;
std::optional<ImageHeader> ReadImageHeader(const std::uint8_t* data, std::size_t size);

/// Whether a JPEG or PNG file is truncated: a JPEG without an end of image (FF D9) after its first
/// start of scan, or a PNG whose chunks do not lead to IEND. Anything after the end is ignored.
/// Decoders silently fill the missing part of such a JPEG with grey.
bool IsCutShort(const std::uint8_t* data, std::size_t size);

/// The kind of file that the first bytes indicate, in words: "a JPEG file", "a TIFF file", "a NumPy
/// array (.npy)", "a Git LFS pointer, not the file itself", "empty"; "a file of unknown kind".
std::string FileKindOf(const std::uint8_t* data, std::size_t size);

/// What an EXIF orientation of 2..8 asks for, such as "turned by 180 degrees".
std::string OrientationText(int orientation);

}  // namespace airdos

#endif  // AIRDOS_COMMON_UTIL_IMAGE_HEADER_H_
