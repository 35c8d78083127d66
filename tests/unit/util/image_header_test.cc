#include "common/util/image_header.h"

#include <gtest/gtest.h>

#include <opencv2/imgcodecs.hpp>
#include <string>
#include <vector>

namespace airdos {
namespace {

using Bytes = std::vector<std::uint8_t>;

Bytes File(const std::string& extension, const std::vector<int>& parameters = {}) {
  Bytes bytes;
  cv::imencode(extension, cv::Mat(12, 16, CV_8UC3, cv::Scalar(10, 60, 90)), bytes, parameters);
  return bytes;
}

std::string Read(const Bytes& bytes) {
  const auto header = ReadImageHeader(bytes.data(), bytes.size());
  return header ? std::to_string(header->width) + "x" + std::to_string(header->height) : "none";
}

void SetBigEndian(std::uint32_t value, int num_bytes, std::size_t place, Bytes* bytes) {
  for (int i = num_bytes; i > 0; --i, value >>= 8)
    (*bytes)[place + static_cast<std::size_t>(i) - 1] = static_cast<std::uint8_t>(value);
}

std::size_t FrameOf(const Bytes& jpeg, std::uint8_t marker) {
  for (std::size_t i = 0; i + 1 < jpeg.size(); ++i) {
    if (jpeg[i] == 0xFF && jpeg[i + 1] == marker) return i;
  }
  return 0;
}

TEST(ImageHeaderTest, SaysWhatTheDecoderWouldFind) {
  EXPECT_EQ(Read(File(".png")), "16x12");
  EXPECT_EQ(Read(File(".jpg")), "16x12");
  EXPECT_EQ(Read(File(".jpg", {cv::IMWRITE_JPEG_PROGRESSIVE, 1})), "16x12");
}

TEST(ImageHeaderTest, ClaimsAboveTheBoundAreRefused) {
  Bytes png = File(".png");
  SetBigEndian(4000, 4, 16, &png);
  SetBigEndian(3000, 4, 20, &png);
  EXPECT_EQ(Read(png), "4000x3000");
  SetBigEndian(3001, 4, 20, &png);
  EXPECT_EQ(Read(png), "none");
  SetBigEndian(0xFFFFFFFF, 4, 16, &png);
  SetBigEndian(0xFFFFFFFF, 4, 20, &png);
  EXPECT_EQ(Read(png), "none") << "the product must not overflow";
  SetBigEndian(0, 4, 16, &png);
  EXPECT_EQ(Read(png), "none");

  Bytes jpeg = File(".jpg");
  const std::size_t frame = FrameOf(jpeg, 0xC0);
  SetBigEndian(65500, 2, frame + 5, &jpeg);
  SetBigEndian(65500, 2, frame + 7, &jpeg);
  EXPECT_EQ(Read(jpeg), "none");
}

// Each scan of a progressive JPEG costs as much as the whole picture has pixels.
TEST(ImageHeaderTest, AJpegOfManyScansIsRefused) {
  Bytes jpeg = File(".jpg");
  const Bytes scan = {0xFF, 0xDA, 0x00, 0x08, 0x01, 0x01, 0x00, 0x00, 0x3F, 0x00};
  for (int i = 1; i < kMaxJpegScans; ++i) jpeg.insert(jpeg.end() - 2, scan.begin(), scan.end());
  EXPECT_EQ(Read(jpeg), "16x12");
  jpeg.insert(jpeg.end() - 2, scan.begin(), scan.end());
  EXPECT_EQ(Read(jpeg), "none");
}

TEST(ImageHeaderTest, EveryShorterFileIsReadWithinItsBounds) {
  for (const Bytes& whole : {File(".png"), File(".jpg")}) {
    for (std::size_t size = 0; size < whole.size(); ++size) {
      const Bytes part(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size));
      EXPECT_NE(Read(part), "") << size;  // a sanitizer sees a byte beyond
    }
  }
  EXPECT_EQ(Read({}), "none");
  EXPECT_EQ(Read(Bytes(100, 0xFF)), "none");
  EXPECT_EQ(Read({0xFF, 0xD8, 0xFF, 0xE0, 0, 0, 0, 0, 0, 0, 0, 0, 0}), "none") << "length 0";
}

}  // namespace
}  // namespace airdos
