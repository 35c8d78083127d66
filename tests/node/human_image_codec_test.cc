#include <gtest/gtest.h>

#include <opencv2/imgcodecs.hpp>
#include <string>
#include <vector>

#include "processes/node/message/image_codec.h"

namespace airdos {
namespace {

// A colour ramp, so that a swap of rows and columns or of channels shows.
cv::Mat Picture() {
  cv::Mat picture(6, 10, CV_8UC3);
  for (int v = 0; v < picture.rows; ++v) {
    for (int u = 0; u < picture.cols; ++u) {
      picture.at<cv::Vec3b>(v, u) =
          cv::Vec3b(static_cast<unsigned char>(20 * u), static_cast<unsigned char>(30 * v), 77);
    }
  }
  return picture;
}

image_t Message(int encoding, std::vector<unsigned char> bytes) {
  image_t message{};
  message.width = 10;
  message.height = 6;
  message.encoding = static_cast<int8_t>(encoding);
  message.num_bytes = static_cast<int32_t>(bytes.size());
  message.data = std::move(bytes);
  return message;
}

image_t PngMessage() {
  std::vector<unsigned char> bytes;
  cv::imencode(".png", Picture(), bytes);
  return Message(image_t::ENCODING_PNG, bytes);
}

TEST(ImageCodec, RawAndPngGiveTheSamePixels) {
  const cv::Mat picture = Picture();
  const image_t raw = Message(image_t::ENCODING_RAW_BGR8,
                              std::vector<unsigned char>(picture.datastart, picture.dataend));
  for (const image_t& message : {raw, PngMessage()}) {
    const auto color = DecodeColor(message);
    ASSERT_TRUE(color);
    EXPECT_EQ(cv::norm(*color, picture, cv::NORM_INF), 0);
    const auto gray = DecodeGray(message);
    ASSERT_TRUE(gray);
    EXPECT_EQ(gray->type(), CV_8UC1);
    // 0.114 * blue + 0.587 * green + 0.299 * red at u = 3, v = 2.
    EXPECT_NEAR(gray->at<unsigned char>(2, 3), 0.114 * 60 + 0.587 * 60 + 0.299 * 77, 1.5);
  }
}

TEST(ImageCodec, GrayRawBecomesColour) {
  const image_t message = Message(image_t::ENCODING_RAW_GRAY8, std::vector<unsigned char>(60, 123));
  const auto color = DecodeColor(message);
  ASSERT_TRUE(color);
  EXPECT_EQ(color->at<cv::Vec3b>(5, 9), cv::Vec3b(123, 123, 123));
}

TEST(ImageCodec, BadBytesGiveNothing) {
  EXPECT_FALSE(DecodeGray(Message(image_t::ENCODING_JPEG, {})));
  EXPECT_FALSE(DecodeGray(Message(image_t::ENCODING_JPEG, std::vector<unsigned char>(500, 9))));
  EXPECT_FALSE(DecodeGray(Message(image_t::ENCODING_RAW_GRAY8, std::vector<unsigned char>(59, 0))));
  EXPECT_FALSE(DecodeGray(Message(image_t::ENCODING_INVALID, std::vector<unsigned char>(60, 0))));
  image_t other_size = PngMessage();
  other_size.width = 11;
  EXPECT_FALSE(DecodeColor(other_size));
}

}  // namespace
}  // namespace airdos
