// What the player makes of users' pictures, and why a message's picture or mask is rejected.
#include <gtest/gtest.h>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "common/util/error.h"
#include "processes/node/message/image_codec.h"
#include "processes/stereo_player/image_packer.h"

namespace airdos {
namespace {

using Bytes = std::vector<std::uint8_t>;

cv::Mat Scene() {
  cv::Mat image(48, 64, CV_8UC1);
  for (int row = 0; row < image.rows; ++row) {
    for (int column = 0; column < image.cols; ++column)
      image.at<std::uint8_t>(row, column) = static_cast<std::uint8_t>(2 * column + 3 * row);
  }
  return image;
}

Bytes File(const std::string& ending, const cv::Mat& image) {
  Bytes bytes;
  cv::imencode(ending, image, bytes);
  return bytes;
}

image_t Message(const Bytes& file, std::int8_t encoding) {
  image_t message;
  message.width = 64;
  message.height = 48;
  message.encoding = encoding;
  message.num_bytes = static_cast<std::int32_t>(file.size());
  message.data = file;
  return message;
}

TEST(UserCases, Case54bPicturesOf16BitsTravelInTheRangeOfTheSequence) {
  ImagePackerOptions options;
  options.encoding = ImagePackerOptions::Encoding::kPng;
  ImagePacker packer(options);
  packer.SetSixteenBitRange({12});
  cv::Mat wide;
  Scene().convertTo(wide, CV_16U, 16);
  image_t message;
  packer.Pack(File(".png", wide), "f", &message);
  const auto picture = DecodeGray(message);
  ASSERT_TRUE(picture);
  EXPECT_EQ(cv::norm(*picture, Scene(), cv::NORM_INF), 0);
  const std::vector<std::string> said = {"16-bit images with 12 significant bits: divided by 16"};
  EXPECT_EQ(packer.TakeNotes(), said);
  packer.Pack(File(".png", wide), "g", &message);
  EXPECT_TRUE(packer.TakeNotes().empty()) << "said once";
  packer.Pack(File(".png", cv::Mat(wide * 16)), "h", &message);
  ASSERT_EQ(packer.TakeNotes().size(), 1U) << "what lies above the range is cut off, and said";
}

TEST(UserCases, Case58eALogsPictureThatIsCutShortIsRejectedWithTheReason) {
  Bytes file = File(".jpg", Scene());
  std::string reason;
  EXPECT_TRUE(DecodeGray(Message(file, image_t::ENCODING_JPEG), &reason));
  file.resize(file.size() - 40);
  EXPECT_FALSE(DecodeGray(Message(file, image_t::ENCODING_JPEG), &reason));
  EXPECT_NE(reason.find("cut short"), std::string::npos) << reason;
}

TEST(UserCases, Case54cALogsPictureOf16BitsIsRejectedWithTheReason) {
  cv::Mat wide;
  Scene().convertTo(wide, CV_16U, 16);
  std::string reason;
  EXPECT_FALSE(DecodeColor(Message(File(".png", wide), image_t::ENCODING_PNG), &reason));
  EXPECT_NE(reason.find("16 bits"), std::string::npos) << reason;
}

TEST(UserCases, Case45cALogsMasksOfAnyKind) {
  cv::Mat ids = cv::Mat::zeros(48, 64, CV_16UC1);
  cv::circle(ids, {30, 20}, 8, 7, cv::FILLED);
  cv::Mat rgba;
  cv::cvtColor(Scene(), rgba, cv::COLOR_GRAY2BGRA);
  person_mask_t message;
  message.width = 64;
  message.height = 48;
  message.encoding = person_mask_t::ENCODING_PNG;
  message.data = File(".png", ids);
  const auto mask = DecodeMask(message);
  ASSERT_TRUE(mask);
  EXPECT_EQ(cv::norm(*mask, cv::Mat(ids == 7), cv::NORM_INF), 0);
  std::string reason;
  message.data = File(".png", rgba);
  EXPECT_FALSE(DecodeMask(message, &reason));
  EXPECT_NE(reason.find("alpha channel"), std::string::npos) << reason;
  message.data = File(".jpg", Scene());
  EXPECT_FALSE(DecodeMask(message, &reason));
  EXPECT_NE(reason.find("JPEG"), std::string::npos) << reason;
}

}  // namespace
}  // namespace airdos
