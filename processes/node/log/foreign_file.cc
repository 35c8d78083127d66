#include "processes/node/log/foreign_file.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <string_view>

namespace airdos {
namespace {

using std::string_view_literals::operator""sv;

struct Format {
  std::size_t offset;
  std::string_view signature;
  const char* description;
};

constexpr char kCompressed[] = "is compressed: unpack it first";
constexpr char kBag[] =
    "is a ROS bag, not an LCM log: write its images into a folder, or publish them on LCM";
constexpr char kVideo[] = "is a video, not an LCM log: stereo pairs are read as images in folders";
constexpr char kPicture[] = "is an image, not an LCM log: the folder of a sequence is expected";
constexpr char kCapture[] =
    "is a capture of network packets, not an LCM log: record with airdos-record or lcm-logger";

constexpr std::array<Format, 26> kFormats{{
    {0, "#ROSBAG"sv, kBag},
    {0, "\x89MCAP"sv, kBag},
    {0, "SQLite format 3\0"sv, "is a database (a ROS 2 bag?), not an LCM log"},
    {0, "\x1f\x8b"sv, kCompressed},
    {0, "\x28\xb5\x2f\xfd"sv, kCompressed},
    {0,
     "\xfd"
     "7zXZ\0"sv,
     kCompressed},
    {0, "BZh"sv, kCompressed},
    {0, "\x04\x22\x4d\x18"sv, kCompressed},
    {0, "PK\x03\x04"sv, "is a zip archive: unpack it first"},
    {0, "7z\xbc\xaf\x27\x1c"sv, "is a 7z archive: unpack it first"},
    {0, "Rar!\x1a\x07"sv, "is a rar archive: unpack it first"},
    {257, "ustar"sv, "is a tar archive: unpack it first"},
    {4, "ftyp"sv, kVideo},
    {0, "\x1a\x45\xdf\xa3"sv, kVideo},
    {8, "AVI "sv, kVideo},
    {0, "\xff\xd8\xff"sv, kPicture},
    {0, "\x89PNG"sv, kPicture},
    {0, "II*\0"sv, kPicture},
    {0, "MM\0*"sv, kPicture},
    {0, "\x89HDF\r\n\x1a\n"sv, "is an HDF5 file, not an LCM log"},
    {0, "\x93NUMPY"sv, "is a NumPy array, not an LCM log"},
    {0, "\xd4\xc3\xb2\xa1"sv, kCapture},
    {0, "\xa1\xb2\xc3\xd4"sv, kCapture},
    {0, "\x0a\x0d\x0d\x0a"sv, kCapture},
    {0, "AIRDOSM\n"sv, "is a map, not an LCM log: airdos-map reads it"},
    {0,
     "\x7f"
     "ELF"sv,
     "is a program, not an LCM log"},
}};

}  // namespace

std::string DescribeForeignFile(const std::vector<std::uint8_t>& first_bytes) {
  const std::string_view bytes(reinterpret_cast<const char*>(first_bytes.data()),
                               first_bytes.size());
  for (const Format& format : kFormats) {
    const bool fits = bytes.size() > format.offset &&
                      bytes.substr(format.offset, format.signature.size()) == format.signature;
    if (fits) return format.description;
  }
  return "";
}

bool LooksLikeText(const std::vector<std::uint8_t>& first_bytes) {
  return !first_bytes.empty() &&
         std::all_of(first_bytes.begin(), first_bytes.end(), [](std::uint8_t byte) {
           return byte >= 0x20 || byte == '\n' || byte == '\r' || byte == '\t';
         });
}

}  // namespace airdos
