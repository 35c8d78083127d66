#include "processes/stereo_player/stereo_player.h"

#include <gtest/gtest.h>

#include <limits>
#include <opencv2/imgcodecs.hpp>
#include <string>
#include <vector>

#include "airdos/person_keypoints_t.hpp"
#include "airdos/person_mask_t.hpp"
#include "airdos/pose_t.hpp"
#include "airdos/stereo_calibration_t.hpp"
#include "common/util/error.h"
#include "processes/node/message/channels.h"

namespace airdos {
namespace {

std::vector<std::uint8_t> ImageFile(const std::string& extension, int size_px, bool is_noise) {
  cv::Mat image(size_px, size_px, CV_8UC1, cv::Scalar(90));
  if (is_noise) {
    cv::RNG random(1);
    random.fill(image, cv::RNG::UNIFORM, 0, 256);
  }
  std::vector<std::uint8_t> file;
  cv::imencode(extension, image, file);
  return file;
}

/// Ten frames a second; what a test wants in `frame`.
class FakeSequence : public StereoSequence {
 public:
  FakeSequence() { frame.left_image_file = frame.right_image_file = ImageFile(".jpg", 64, false); }
  const StereoCamera& camera() const override { return camera_; }
  std::size_t num_frames() const override { return 30; }
  TrajectoryAxes ground_truth_axes() const override { return TrajectoryAxes::kNed; }
  bool has_people() const override { return true; }
  SequenceFrame Load(std::size_t index) const override {
    SequenceFrame result = frame;
    result.utime = 100000 * static_cast<std::int64_t>(index);
    return result;
  }
  SequenceFrame frame;

 private:
  StereoCamera camera_{64, 64, 50, 50, 32, 32, 0.2};
};

template <class Message>
Message Find(const StereoPlayer::Frame& frame, const std::string& channel) {
  Message message = {};
  for (const Envelope& envelope : frame.messages) {
    if (envelope.channel != channel) continue;
    EXPECT_TRUE(Decode(envelope.payload.data(), envelope.payload.size(), &message));
    EXPECT_EQ(Validate(message), "");
    return message;
  }
  ADD_FAILURE() << "nothing on " << channel;
  return message;
}

std::vector<std::string> Channels(const StereoPlayer::Frame& frame) {
  std::vector<std::string> channels;
  for (const Envelope& message : frame.messages) channels.push_back(message.channel);
  return channels;
}

TEST(StereoPlayerTest, EachFrameHasOneMessageAChannelEvenWithoutPeople) {
  FakeSequence sequence;
  StereoPlayer player(&sequence, 5, {});
  const StereoPlayer::Frame frame = player.Load(3);
  EXPECT_EQ(Channels(frame), (std::vector<std::string>{"CALIBRATION", "CAMERA_LEFT", "CAMERA_RIGHT",
                                                       "PERSON_KEYPOINTS_LEFT",
                                                       "PERSON_KEYPOINTS_RIGHT", "PERSON_MASK"}));
  const auto image = Find<image_t>(frame, channel::kCameraRight);
  EXPECT_EQ(image.utime, 300000);
  EXPECT_EQ(image.seq, 3);
  EXPECT_EQ(image.session, 5);
  EXPECT_EQ(image.width, 64);
  EXPECT_EQ(image.data, sequence.frame.right_image_file);
  EXPECT_EQ(Find<stereo_calibration_t>(frame, channel::kCalibration).baseline_m, 0.2);
  EXPECT_EQ(Find<person_keypoints_t>(frame, channel::kPersonKeypointsLeft).num_people, 0);
  EXPECT_EQ(Find<person_mask_t>(frame, channel::kPersonMask).encoding,
            +person_mask_t::ENCODING_NONE);
}

TEST(StereoPlayerTest, TheCalibrationComesOnceASecondOfCaptureTime) {
  FakeSequence sequence;
  StereoPlayer player(&sequence, 5, {});
  std::string seqs;
  for (std::size_t i = 2; i < 30; ++i) {
    if (Channels(player.Load(i))[0] == channel::kCalibration) seqs += std::to_string(i) + " ";
  }
  EXPECT_EQ(seqs, "2 12 22 ");
}

TEST(StereoPlayerTest, PeopleMasksAndGroundTruthTravel) {
  FakeSequence sequence;
  PersonKeypoints person(18);
  person[4] = {10, 20, 1.04F};
  sequence.frame.keypoints_right = {person, person};
  sequence.frame.person_mask_file = ImageFile(".png", 64, false);
  sequence.frame.ground_truth = Se3{Eigen::Quaterniond(0, 1, 0, 0), {1, 2, 3}};
  StereoPlayer player(&sequence, 5, {});
  const StereoPlayer::Frame frame = player.Load(0);
  const auto keypoints = Find<person_keypoints_t>(frame, channel::kPersonKeypointsRight);
  EXPECT_EQ(keypoints.num_people, 2);
  EXPECT_EQ(keypoints.layout, +person_keypoints_t::LAYOUT_COCO18);
  EXPECT_EQ(keypoints.v_px[1][4], 20);
  EXPECT_EQ(keypoints.confidence[1][4], 1) << "detectors give scores above 1";
  EXPECT_EQ(Find<person_mask_t>(frame, channel::kPersonMask).data, sequence.frame.person_mask_file);
  const auto truth = Find<pose_t>(frame, channel::kGroundTruth);
  EXPECT_EQ(truth.axes, +pose_t::AXES_NED);
  EXPECT_EQ(truth.position[2], 3);
  EXPECT_EQ(truth.orientation[1], 1);
}

TEST(StereoPlayerTest, AFrameThatReceiversWouldRejectIsTheDataSetsFault) {
  FakeSequence sequence;
  PersonKeypoints person(18);
  person[4].u_px = std::numeric_limits<float>::quiet_NaN();
  sequence.frame.keypoints_left = {person};
  StereoPlayer player(&sequence, 5, {});
  EXPECT_THROW(player.Load(0), InputError);
  FakeSequence broken;
  broken.frame.left_image_file = {1, 2, 3};
  StereoPlayer broken_player(&broken, 5, {});
  EXPECT_THROW(broken_player.Load(0), InputError);
}

TEST(ImagePackerTest, SmallFilesTravelUnchanged) {
  for (const char* extension : {".jpg", ".png"}) {
    const std::vector<std::uint8_t> file = ImageFile(extension, 64, true);
    ImagePacker packer({});
    image_t message = {};
    packer.Pack(file, "f", &message);
    EXPECT_EQ(message.data, file);
    EXPECT_EQ(message.encoding == image_t::ENCODING_PNG, extension == std::string(".png"));
    EXPECT_TRUE(packer.TakeNotes().empty());
  }
}

TEST(ImagePackerTest, LargeImagesGetTheBestQualityThatFits) {
  ImagePackerOptions options;
  options.max_image_bytes = 15000;
  options.jpeg_qualities = {90, 50, 20};
  ImagePacker packer(options);
  image_t message = {};
  const std::vector<std::uint8_t> file = ImageFile(".png", 160, true);
  packer.Pack(file, "f", &message);
  EXPECT_EQ(message.encoding, +image_t::ENCODING_JPEG);
  EXPECT_LE(message.num_bytes, 15000);
  std::vector<std::uint8_t> expected;
  cv::imencode(".jpg", cv::imdecode(file, cv::IMREAD_GRAYSCALE), expected,
               {cv::IMWRITE_JPEG_QUALITY, 50});
  EXPECT_EQ(message.data, expected);
  packer.Pack(file, "f", &message);
  EXPECT_EQ(packer.TakeNotes().size(), 1u) << "said once";
  options.max_image_bytes = 1000;
  EXPECT_THROW(ImagePacker(options).Pack(file, "f", &message), InputError);
}

TEST(ImagePackerTest, PngIsLosslessWhateverTheSize) {
  ImagePackerOptions options;
  options.max_image_bytes = 1000;
  options.encoding = ImagePackerOptions::Encoding::kPng;
  ImagePacker packer(options);
  image_t message = {};
  packer.Pack(ImageFile(".jpg", 160, true), "f", &message);
  EXPECT_EQ(message.encoding, +image_t::ENCODING_PNG);
  EXPECT_GT(message.num_bytes, 1000);
  EXPECT_EQ(packer.TakeNotes().size(), 1u);
}

}  // namespace
}  // namespace airdos
