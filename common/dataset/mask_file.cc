#include "common/dataset/mask_file.h"

#include <png.h>

#include <algorithm>
#include <csetjmp>
#include <cstring>
#include <filesystem>
#include <opencv2/imgcodecs.hpp>
#include <optional>

#include "common/dataset/image_file.h"
#include "common/dataset/sequence_files.h"
#include "common/util/error.h"
#include "common/util/image_header.h"

namespace airdos {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxSampleBytes = 48u << 20;  // four bytes per pixel of the largest image

/// The bytes that libpng reads.
struct ByteSource {
  const std::uint8_t* data;
  std::size_t left;
};

void ReadFromSource(png_structp png, png_bytep to, png_size_t num_bytes) {
  auto* source = static_cast<ByteSource*>(png_get_io_ptr(png));
  if (num_bytes > source->left) png_error(png, "end of data");
  std::memcpy(to, source->data, num_bytes);
  source->data += num_bytes;
  source->left -= num_bytes;
}

void Leave(png_structp png, png_const_charp /*message*/) { png_longjmp(png, 1); }
void Ignore(png_structp /*png*/, png_const_charp /*message*/) {}

/// Samples of one or two bytes (in native byte order), row by row.
struct PngSamples {
  int bytes_per_sample = 1;
  int num_channels = 1;
  std::size_t row_bytes = 0;
  std::vector<png_byte> samples;
  bool is_index_0_black = true;  // of the palette
  bool has_black = false;
};

void ReadPalette(png_structp png, png_infop info, PngSamples* out) {
  png_colorp palette = nullptr;
  int num_colors = 0;
  if (png_get_PLTE(png, info, &palette, &num_colors) == 0) return;
  for (int i = 0; i < num_colors; ++i) {
    const bool is_black = palette[i].red == 0 && palette[i].green == 0 && palette[i].blue == 0;
    if (i == 0) out->is_index_0_black = is_black;
    out->has_black = out->has_black || is_black;
  }
}

/// libpng reports errors by longjmp, so after setjmp this function has no object with a destructor.
bool DecodeRows(png_structp png, png_infop info, ByteSource* source, const ImageHeader& header,
                PngSamples* out) {
  if (setjmp(png_jmpbuf(png)) != 0) return false;
  png_set_read_fn(png, source, ReadFromSource);
  png_set_user_limits(png, static_cast<png_uint_32>(header.width),
                      static_cast<png_uint_32>(header.height));
  png_read_info(png, info);
  const auto height = static_cast<std::size_t>(header.height);
  const std::size_t pixel_bytes =
      png_get_channels(png, info) * (png_get_bit_depth(png, info) == 16 ? 2U : 1U);
  // Before libpng allocates a row of them.
  if (static_cast<std::size_t>(header.width) * pixel_bytes > kMaxSampleBytes / height) return false;
  png_set_packing(png);  // 1, 2 and 4 bits to one byte each, not scaled
  if (png_get_bit_depth(png, info) == 16) png_set_swap(png);
  const int num_passes = png_set_interlace_handling(png);
  png_read_update_info(png, info);
  const png_size_t row_bytes = png_get_rowbytes(png, info);
  ReadPalette(png, info, out);
  out->bytes_per_sample = png_get_bit_depth(png, info) == 16 ? 2 : 1;
  out->num_channels = png_get_channels(png, info);
  out->row_bytes = row_bytes;
  out->samples.resize(row_bytes * height);
  // Not png_read_image(): it needs one pointer per row, eight times the samples of a narrow image.
  for (int pass = 0; pass < num_passes; ++pass) {
    for (std::size_t i = 0; i < height; ++i)
      png_read_row(png, out->samples.data() + i * row_bytes, nullptr);
  }
  png_read_end(png, nullptr);
  return true;
}

bool DecodePng(const std::uint8_t* data, std::size_t size, const ImageHeader& header,
               PngSamples* out) {
  png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, nullptr, Leave, Ignore);
  png_infop info = png == nullptr ? nullptr : png_create_info_struct(png);
  ByteSource source{data, size};
  const bool is_good = info != nullptr && DecodeRows(png, info, &source, header, out);
  png_destroy_read_struct(&png, &info, nullptr);
  return is_good;
}

/// The largest sample of each pixel.
template <class Sample>
cv::Mat LargestSamples(const PngSamples& png, const ImageHeader& header, int type) {
  cv::Mat values(static_cast<int>(header.height), static_cast<int>(header.width), type);
  for (int row = 0; row < values.rows; ++row) {
    const auto* from = reinterpret_cast<const Sample*>(
        png.samples.data() + static_cast<std::size_t>(row) * png.row_bytes);
    auto* to = values.ptr<Sample>(row);
    for (int i = 0; i < values.cols; ++i, from += png.num_channels)
      to[i] = *std::max_element(from, from + png.num_channels);
  }
  return values;
}

constexpr char kWanted[] = "; masks must be PNG with 0 for the background";

std::string KindOf(const ImageHeader& header) {
  if (header.is_palette) return "palette";
  const std::string bits = std::to_string(header.bits) + "-bit ";
  return header.num_channels == 3 ? (header.bits == 8 ? "RGB" : bits + "RGB") : bits + "grey";
}

bool IsPlain(const ImageHeader& header) {
  return header.is_png && header.bits == 8 && header.num_channels == 1 && !header.is_palette;
}

}  // namespace

std::string WhyNoMask(const std::uint8_t* data, std::size_t size) {
  const std::string kind = FileKindOf(data, size);
  if (kind == "empty") return "is empty";
  if (kind == "a JPEG file") {
    return std::string("is a JPEG file, which blurs the values of a mask") + kWanted;
  }
  if (kind != "a PNG file") return "is " + kind + kWanted;
  const std::string why = WhyNoPicture(data, size);
  if (!why.empty()) return why;
  const std::optional<ImageHeader> header = ReadImageHeader(data, size);
  if (header->has_alpha()) {
    return std::string("has an alpha channel (") +
           (header->num_channels == 4 ? "RGBA" : "grey and alpha") +
           "), so it is not clear which of its channels is the mask; save it without alpha, 0 for "
           "the background";
  }
  return "";
}

PersonMask DecodePersonMask(const std::uint8_t* data, std::size_t size, const std::string& name) {
  const std::string why = WhyNoMask(data, size);
  if (!why.empty()) throw InputError(name + ": " + why);
  const ImageHeader header = *ReadImageHeader(data, size);
  PngSamples png;
  if (!DecodePng(data, size, header, &png)) {
    throw InputError(name + ": cannot be decoded as a mask (is it damaged?)");
  }
  PersonMask mask;
  mask.kind = KindOf(header);
  mask.values = png.bytes_per_sample == 2 ? LargestSamples<std::uint16_t>(png, header, CV_16UC1)
                                          : LargestSamples<std::uint8_t>(png, header, CV_8UC1);
  mask.pixels = mask.values != 0;
  if (header.is_palette && !png.is_index_0_black && png.has_black) {
    mask.doubt = "black is not the first colour of its palette, but index 0 is the background";
  }
  return mask;
}

std::vector<std::uint8_t> ReadMaskFile(const std::string& path, int width, int height) {
  std::vector<std::uint8_t> bytes = ReadBytes(path);
  const std::string why = WhyNoMask(bytes.data(), bytes.size());
  if (!why.empty()) throw InputError(path + ": " + why);
  const ImageHeader header = *ReadImageHeader(bytes.data(), bytes.size());
  if (header.width != width || header.height != height) {
    throw InputError(path + ": " +
                     SizeMismatchText(header.width, header.height, "the images", width, height));
  }
  if (IsPlain(header)) return bytes;
  std::vector<std::uint8_t> plain;
  cv::imencode(".png", DecodePersonMask(bytes.data(), bytes.size(), path).pixels, plain);
  return plain;
}

double RippledShare(const PersonMask& mask) {
  constexpr int kMaxStep = 12;
  cv::Mat values;
  mask.values.convertTo(values, CV_32S);
  // A local maximum or minimum between two neighbours of similar value. A smoothed edge, as
  // produced by resizing, is monotonic.
  const auto is_extreme = [](int before, int value, int after) {
    const int step_before = value - before;
    const int step_after = value - after;
    return step_before != 0 && step_after != 0 && (step_before > 0) == (step_after > 0) &&
           std::max(std::abs(step_before), std::abs(step_after)) <= kMaxStep;
  };
  std::int64_t num_marked = 0;
  std::int64_t num_rippled = 0;
  for (int row = 1; row + 1 < values.rows; ++row) {
    const int* above = values.ptr<int>(row - 1);
    const int* here = values.ptr<int>(row);
    const int* below = values.ptr<int>(row + 1);
    for (int i = 1; i + 1 < values.cols; ++i) {
      if (here[i] == 0) continue;
      ++num_marked;
      num_rippled +=
          is_extreme(here[i - 1], here[i], here[i + 1]) || is_extreme(above[i], here[i], below[i]);
    }
  }
  return num_marked == 0 ? 0 : static_cast<double>(num_rippled) / static_cast<double>(num_marked);
}

std::vector<std::string> ListOtherMaskFiles(const std::string& folder) {
  std::vector<std::string> names;
  std::error_code error;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    const std::string name = it->path().filename().string();
    if (it->path().extension() == ".png" || name[0] == '.' || it->is_directory(error)) continue;
    names.push_back(name);
  }
  std::sort(names.begin(), names.end());
  return names;
}

}  // namespace airdos
