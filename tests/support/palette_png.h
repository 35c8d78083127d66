#ifndef AIRDOS_TESTS_SUPPORT_PALETTE_PNG_H_
#define AIRDOS_TESTS_SUPPORT_PALETTE_PNG_H_

#include <png.h>

#include <cstdint>
#include <vector>

namespace airdos {

/// An 8-bit PNG whose samples are palette indices, row by row; OpenCV cannot write these.
inline std::vector<std::uint8_t> PalettePng(const std::vector<png_color>& palette, int width,
                                            const std::vector<std::uint8_t>& indices,
                                            int interlacing = PNG_INTERLACE_NONE) {
  std::vector<std::uint8_t> bytes;
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png_create_info_struct(png);
  const auto append = [](png_structp of, png_bytep data, png_size_t size) {
    auto* to = static_cast<std::vector<std::uint8_t>*>(png_get_io_ptr(of));
    to->insert(to->end(), data, data + size);
  };
  png_set_write_fn(png, &bytes, append, nullptr);
  const int height = static_cast<int>(indices.size()) / width;
  png_set_IHDR(png, info, static_cast<png_uint_32>(width), static_cast<png_uint_32>(height), 8,
               PNG_COLOR_TYPE_PALETTE, interlacing, PNG_COMPRESSION_TYPE_DEFAULT,
               PNG_FILTER_TYPE_DEFAULT);
  png_set_PLTE(png, info, palette.data(), static_cast<int>(palette.size()));
  png_write_info(png, info);
  for (int pass = png_set_interlace_handling(png); pass > 0; --pass) {
    for (int row = 0; row < height; ++row) png_write_row(png, indices.data() + row * width);
  }
  png_write_end(png, info);
  png_destroy_write_struct(&png, &info);
  return bytes;
}

}  // namespace airdos

#endif  // AIRDOS_TESTS_SUPPORT_PALETTE_PNG_H_
