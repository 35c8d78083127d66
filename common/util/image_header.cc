#include "common/util/image_header.h"

#include <algorithm>
#include <array>

namespace airdos {
namespace {

std::int64_t BigEndian(const std::uint8_t* bytes, int size) {
  std::int64_t value = 0;
  for (int i = 0; i < size; ++i) value = value << 8 | bytes[i];
  return value;
}

std::optional<ImageHeader> ReadPng(const std::uint8_t* data, std::size_t size) {
  // Signature, then length and name of the first chunk, which must be IHDR: width, height.
  constexpr std::array<std::uint8_t, 4> kHeaderName{'I', 'H', 'D', 'R'};
  if (size < 33 || !std::equal(kHeaderName.begin(), kHeaderName.end(), data + 12))
    return std::nullopt;
  return ImageHeader{BigEndian(data + 16, 4), BigEndian(data + 20, 4)};
}

/// Start of frame, whatever the process: C0 to CF but for tables (C4), JPG (C8) and conditioning
/// (CC).
bool IsFrameMarker(std::uint8_t marker) {
  return marker >= 0xC0 && marker <= 0xCF && marker != 0xC4 && marker != 0xC8 && marker != 0xCC;
}

/// Inside of compressed data an FF is followed by 00, so what is found is a scan, or lies in a
/// thumbnail.
int CountScans(const std::uint8_t* data, std::size_t size) {
  int num_scans = 0;
  for (std::size_t i = 0; i + 1 < size; ++i) num_scans += data[i] == 0xFF && data[i + 1] == 0xDA;
  return num_scans;
}

std::optional<ImageHeader> ReadJpeg(const std::uint8_t* data, std::size_t size) {
  if (CountScans(data, size) > kMaxJpegScans) return std::nullopt;
  std::size_t position = 2;
  while (position + 9 <= size) {
    if (data[position] != 0xFF) return std::nullopt;
    const std::uint8_t marker = data[position + 1];
    if (marker == 0xFF) {  // padding
      ++position;
      continue;
    }
    const auto length = static_cast<std::size_t>(BigEndian(data + position + 2, 2));
    if (IsFrameMarker(marker))
      return ImageHeader{BigEndian(data + position + 7, 2), BigEndian(data + position + 5, 2)};
    // Pixels before the frame, a length that lies, or a marker that has none.
    if (marker < 0xC0 || (marker >= 0xD0 && marker <= 0xDA) || length < 2) return std::nullopt;
    position += 2 + length;
  }
  return std::nullopt;
}

}  // namespace

std::optional<ImageHeader> ReadImageHeader(const std::uint8_t* data, std::size_t size) {
  constexpr std::array<std::uint8_t, 8> kPng{0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n'};
  std::optional<ImageHeader> header;
  if (size > kPng.size() && std::equal(kPng.begin(), kPng.end(), data)) {
    header = ReadPng(data, size);
  } else if (size > 4 && data[0] == 0xFF && data[1] == 0xD8) {
    header = ReadJpeg(data, size);
  }
  if (!header || header->width < 1 || header->height < 1) return std::nullopt;
  if (header->width > kMaxImagePixels / header->height) return std::nullopt;
  return header;
}

}  // namespace airdos
