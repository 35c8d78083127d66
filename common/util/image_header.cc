#include "common/util/image_header.h"

#include <algorithm>
#include <array>
#include <string_view>

namespace airdos {
namespace {

std::int64_t BigEndian(const std::uint8_t* bytes, int size) {
  std::int64_t value = 0;
  for (int i = 0; i < size; ++i) value = value << 8 | bytes[i];
  return value;
}

bool StartsWith(const std::uint8_t* data, std::size_t size, std::string_view text) {
  return size >= text.size() && std::equal(text.begin(), text.end(), data, [](char a, auto b) {
           return static_cast<std::uint8_t>(a) == b;
         });
}

constexpr std::string_view kPngSignature("\x89PNG\r\n\x1A\n", 8);
constexpr std::size_t kPngChunkFrame = 12;  // length, name and checksum around its content

/// The orientation in an EXIF block ("MM" or "II", 42, offset of the directory, entries of 12
/// bytes).
int Orientation(const std::uint8_t* tiff, std::size_t size) {
  constexpr std::int64_t kOrientationTag = 0x0112;
  const bool is_big = StartsWith(tiff, size, "MM");
  if (size < 10 || (!is_big && !StartsWith(tiff, size, "II"))) return 1;
  const auto read = [&](std::size_t place, int num_bytes) {
    std::int64_t value = 0;
    for (int i = 0; i < num_bytes; ++i) {
      value = value << 8 | tiff[place + static_cast<std::size_t>(is_big ? i : num_bytes - 1 - i)];
    }
    return value;
  };
  const auto directory = static_cast<std::size_t>(read(4, 4));
  if (directory > size - 2) return 1;
  const std::int64_t num_entries = read(directory, 2);
  std::size_t entry = directory + 2;
  for (std::int64_t i = 0; i < num_entries && entry + 12 <= size; ++i, entry += 12) {
    if (read(entry, 2) != kOrientationTag) continue;
    const std::int64_t wish = read(entry + 8, 2);
    return wish >= 1 && wish <= 8 ? static_cast<int>(wish) : 1;
  }
  return 1;
}

std::optional<ImageHeader> ReadPng(const std::uint8_t* data, std::size_t size) {
  // Signature, then length and name of the first chunk, which must be IHDR: width, height, bit
  // depth, colour type.
  if (size < 33 || !StartsWith(data + 12, size - 12, "IHDR")) return std::nullopt;
  ImageHeader header{BigEndian(data + 16, 4), BigEndian(data + 20, 4)};
  header.is_png = true;
  header.bits = data[24];
  const int color_type = data[25];
  header.is_palette = color_type == 3;
  header.num_channels = color_type == 2 ? 3 : color_type == 4 ? 2 : color_type == 6 ? 4 : 1;
  std::size_t chunk = kPngSignature.size();
  while (chunk + kPngChunkFrame <= size) {
    const auto length = static_cast<std::size_t>(BigEndian(data + chunk, 4));
    if (StartsWith(data + chunk + 4, 4, "IDAT") || length > size - chunk - kPngChunkFrame) break;
    if (StartsWith(data + chunk + 4, 4, "eXIf"))
      header.orientation = Orientation(data + chunk + 8, length);
    chunk += kPngChunkFrame + length;
  }
  return header;
}

/// A start of frame of any process: C0 to CF except tables (C4), JPG (C8) and conditioning (CC).
bool IsFrameMarker(std::uint8_t marker) {
  return marker >= 0xC0 && marker <= 0xCF && marker != 0xC4 && marker != 0xC8 && marker != 0xCC;
}

/// Within compressed data, FF is always followed by 00, so whatever is found here starts a scan, of
/// the picture or of a thumbnail.
int CountScans(const std::uint8_t* data, std::size_t size) {
  int num_scans = 0;
  for (std::size_t i = 0; i + 1 < size; ++i) num_scans += data[i] == 0xFF && data[i + 1] == 0xDA;
  return num_scans;
}

/// Iterates over the segments before the first scan; at() is the position of the marker's FF.
class JpegSegments {
 public:
  JpegSegments(const std::uint8_t* data, std::size_t size) : data_(data), size_(size) { Settle(); }

  bool is_valid() const { return is_valid_; }
  std::size_t at() const { return at_; }
  std::uint8_t marker() const { return data_[at_ + 1]; }
  std::size_t length() const { return static_cast<std::size_t>(BigEndian(data_ + at_ + 2, 2)); }
  void Next() {
    at_ += 2 + length();
    Settle();
  }

 private:
  /// Skips padding; ends if there is no marker, or one with a missing or wrong length.
  void Settle() {
    while (at_ + 4 <= size_ && data_[at_] == 0xFF && data_[at_ + 1] == 0xFF) ++at_;
    is_valid_ = at_ + 4 <= size_ && data_[at_] == 0xFF && marker() >= 0xC0 &&
                !(marker() >= 0xD0 && marker() <= 0xD9) && length() >= 2;
  }

  const std::uint8_t* data_;
  std::size_t size_;
  std::size_t at_ = 2;
  bool is_valid_ = false;
};

constexpr std::uint8_t kStartOfScan = 0xDA;

std::optional<ImageHeader> ReadJpeg(const std::uint8_t* data, std::size_t size) {
  if (CountScans(data, size) > kMaxJpegScans) return std::nullopt;
  constexpr std::uint8_t kExif = 0xE1;
  constexpr std::string_view kExifName("Exif\0\0", 6);
  int orientation = 1;
  for (JpegSegments segment(data, size); segment.is_valid(); segment.Next()) {
    const std::size_t at = segment.at();
    if (segment.marker() == kStartOfScan || at + 10 > size) return std::nullopt;
    const std::size_t end = std::min(size, at + 2 + segment.length());
    const std::size_t content = at + 4 + kExifName.size();
    if (segment.marker() == kExif && content < end && StartsWith(data + at + 4, size, kExifName)) {
      orientation = Orientation(data + content, end - content);
    }
    if (!IsFrameMarker(segment.marker())) continue;
    ImageHeader header{BigEndian(data + at + 7, 2), BigEndian(data + at + 5, 2)};
    header.bits = data[at + 4];
    header.num_channels = data[at + 9];
    header.orientation = orientation;
    return header;
  }
  return std::nullopt;
}

bool IsPng(const std::uint8_t* data, std::size_t size) {
  return size > kPngSignature.size() && StartsWith(data, size, kPngSignature);
}

bool IsJpeg(const std::uint8_t* data, std::size_t size) {
  return size > 4 && data[0] == 0xFF && data[1] == 0xD8;
}

bool IsPngCutShort(const std::uint8_t* data, std::size_t size) {
  std::size_t chunk = kPngSignature.size();
  while (chunk + kPngChunkFrame <= size) {
    if (StartsWith(data + chunk + 4, 4, "IEND")) return false;
    const auto length = static_cast<std::size_t>(BigEndian(data + chunk, 4));
    if (length > size - chunk - kPngChunkFrame) return true;
    chunk += kPngChunkFrame + length;
  }
  return true;
}

bool IsJpegCutShort(const std::uint8_t* data, std::size_t size) {
  std::size_t scan = 0;
  for (JpegSegments segment(data, size); segment.is_valid(); segment.Next()) {
    scan = segment.at();
    if (segment.marker() == kStartOfScan) break;
  }
  // Thumbnails come before the scan and have their own end marker. In a scan, FF is followed by 00
  // or a restart marker, so a match is no accident. Searched backwards, since it is usually at the
  // end.
  for (std::size_t i = size; i >= scan + 4; --i) {
    if (data[i - 2] == 0xFF && data[i - 1] == 0xD9) return false;
  }
  return true;
}

}  // namespace

std::optional<ImageHeader> ReadImageHeader(const std::uint8_t* data, std::size_t size) {
  std::optional<ImageHeader> header;
  if (IsPng(data, size)) {
    header = ReadPng(data, size);
  } else if (IsJpeg(data, size)) {
    header = ReadJpeg(data, size);
  }
  if (!header || header->width < 1 || header->height < 1) return std::nullopt;
  if (header->width > kMaxImagePixels / header->height) return std::nullopt;
  return header;
}

bool IsCutShort(const std::uint8_t* data, std::size_t size) {
  if (IsPng(data, size)) return IsPngCutShort(data, size);
  return IsJpeg(data, size) && IsJpegCutShort(data, size);
}

std::string FileKindOf(const std::uint8_t* data, std::size_t size) {
  struct Kind {
    std::string_view start;
    const char* name;
  };
  using namespace std::string_view_literals;
  static constexpr std::array<Kind, 19> kKinds = {{
      {"\xFF\xD8\xFF"sv, "a JPEG file"},
      {kPngSignature, "a PNG file"},
      {"II*\0"sv, "a TIFF file"},
      {"MM\0*"sv, "a TIFF file"},
      {"BM"sv, "a BMP file"},
      {"GIF8"sv, "a GIF file"},
      {"RIFF"sv, "a WebP file"},
      {"\x93NUMPY"sv, "a NumPy array (.npy)"},
      {"PK\x03\x04"sv, "a zip archive (.npz is one)"},
      {"\x76\x2F\x31\x01"sv, "an OpenEXR file"},
      {"\xFF\x0A"sv, "a JPEG XL file"},
      {"\0\0\0\x0CjP"sv, "a JPEG 2000 file"},
      {"P5"sv, "a PGM file"},
      {"P6"sv, "a PPM file"},
      {"\x89HDF"sv, "an HDF5 file"},
      {"\x1F\x8B"sv, "a gzip archive"},
      {"version https://git-lfs"sv, "a Git LFS pointer, not the file itself"},
      {"<"sv, "a web page or XML, not the file itself"},
      {"{"sv, "a JSON file"},
  }};
  if (size == 0) return "empty";
  for (const Kind& kind : kKinds) {
    if (StartsWith(data, size, kind.start)) return kind.name;
  }
  return "a file of unknown kind";
}

std::string OrientationText(int orientation) {
  constexpr std::array<const char*, 9> kTexts = {"",
                                                 "as it is stored",
                                                 "mirrored",
                                                 "turned by 180 degrees",
                                                 "upside down and mirrored",
                                                 "turned by 90 degrees and mirrored",
                                                 "turned by 90 degrees",
                                                 "turned by 270 degrees and mirrored",
                                                 "turned by 270 degrees"};
  return orientation >= 1 && orientation <= 8 ? kTexts[static_cast<std::size_t>(orientation)] : "";
}

}  // namespace airdos
