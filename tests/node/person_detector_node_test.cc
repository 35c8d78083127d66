#include "processes/person_detector/person_detector_node.h"

#include <gtest/gtest.h>

#include <memory>
#include <opencv2/imgproc.hpp>
#include <set>
#include <string>
#include <vector>

#include "airdos/person_keypoints_t.hpp"
#include "airdos/person_mask_t.hpp"
#include "processes/node/message/channels.h"
#include "processes/node/message/image_codec.h"
#include "processes/person_detector/person_detector_messages.h"
#include "tests/support/input_errors.h"
#include "tests/support/scratch_folder.h"
#include "tests/support/tiny_networks.h"

namespace airdos {
namespace {

constexpr char kConfigFile[] = AIRDOS_SOURCE_DIR "/launch_scripts/config/person_detector.yaml";

using Settings = std::vector<std::string>;

/// The messages of one frame, of all channels together.
struct Output {
  person_keypoints_t left;
  person_keypoints_t right;
  person_mask_t mask;
  std::string bytes;
};

class PersonDetectorNodeTest : public ::testing::Test {
 protected:
  /// On the tiny network with the heads of MoveNet, whose input has half the image's size.
  std::unique_ptr<Node> MakeNode(const Settings& further = {}) {
    ConfigReader config = ConfigReader::FromFile(kConfigFile);
    Settings settings = {"network.file=" + scratch_.Write("n.onnx", TinyMoveNet({128, 96})),
                         "network.outputs=centre,heatmaps,regression,offsets",
                         "network.width_px=128",
                         "network.height_px=96",
                         "stereo.right=network",
                         "masks.file=" + scratch_.Write("mask.onnx", TinyMask({64, 64})),
                         "masks.outputs=mask",
                         "masks.side_px=64",
                         "masks.min_height_px=40"};
    for (const std::string colour : {"red", "green", "blue"}) {
      settings.push_back("network.mean_" + colour + "=0");
      settings.push_back("network.scale_" + colour + "=255");
    }
    settings.insert(settings.end(), further.begin(), further.end());
    for (const std::string& setting : settings) config.Override(setting);
    std::unique_ptr<Node> node = MakePersonDetectorNode(&config);
    config.Finish();
    return node;
  }

  ScratchFolder scratch_{"person_detector_node"};
};

/// Somebody whose joints 1 to 6 are in one green cell, `shift` cells from where they are otherwise.
cv::Mat Image(int shift = 0) {
  cv::Mat image(192, 256, CV_8UC3, cv::Scalar::all(0));
  cv::rectangle(image, cv::Rect(8 * (10 + shift), 64, 8, 8), cv::Scalar(0, 0, 255), cv::FILLED);
  for (int i = 0; i < 17; ++i) {
    cv::rectangle(image, cv::Rect(8 * (12 + shift), 8 * i, 8, 8), cv::Scalar(0, 255, 0),
                  cv::FILLED);
  }
  return image;
}

void SendImage(const std::string& channel, const Header& header, const cv::Mat& image, Node* node,
               bool is_broken = false) {
  auto message = MessageOf<image_t>(header);
  message.width = image.cols;
  message.height = image.rows;
  message.encoding = is_broken ? image_t::ENCODING_JPEG : image_t::ENCODING_RAW_BGR8;
  message.data.assign(image.datastart, image.dataend);
  message.num_bytes = static_cast<std::int32_t>(message.data.size());
  const std::vector<std::uint8_t> bytes = Encode(message);
  node->Receive(channel, bytes.data(), bytes.size());
}

Header HeaderAt(std::int64_t seq, std::int64_t session = 7) { return {1000 * seq, seq, session}; }

/// Exactly one message on each channel, valid, with the header of the frame.
Output TakeOne(const Header& header, Node* node) {
  while (node->Step()) {
  }
  Output output;
  std::multiset<std::string> channels;
  const auto decode = [&](const Envelope& envelope, auto* message) {
    EXPECT_TRUE(Decode(envelope.payload.data(), envelope.payload.size(), message));
    EXPECT_EQ(Validate(*message), "");
    EXPECT_EQ(message->utime, header.utime);
    EXPECT_EQ(message->seq, header.seq);
    EXPECT_EQ(message->session, header.session);
  };
  for (const Envelope& envelope : node->TakeOutput()) {
    channels.insert(envelope.channel);
    output.bytes += envelope.channel;
    output.bytes.append(envelope.payload.begin(), envelope.payload.end());
    if (envelope.channel == channel::kPersonKeypointsLeft) decode(envelope, &output.left);
    if (envelope.channel == channel::kPersonKeypointsRight) decode(envelope, &output.right);
    if (envelope.channel == channel::kPersonMask) decode(envelope, &output.mask);
  }
  EXPECT_EQ(channels,
            (std::multiset<std::string>{channel::kPersonKeypointsLeft,
                                        channel::kPersonKeypointsRight, channel::kPersonMask}));
  return output;
}

Output Feed(const cv::Mat& left, const cv::Mat& right, const Header& header, Node* node) {
  SendImage(channel::kCameraLeft, header, left, node);
  SendImage(channel::kCameraRight, header, right, node);
  return TakeOne(header, node);
}

TEST_F(PersonDetectorNodeTest, FindsPeopleInBothImages) {
  const auto node = MakeNode();
  const Output output = Feed(Image(0), Image(-3), HeaderAt(5), node.get());
  ASSERT_EQ(output.left.num_people, 1);
  ASSERT_EQ(output.right.num_people, 1);
  EXPECT_EQ(output.left.layout, int{person_keypoints_t::LAYOUT_COCO17});
  EXPECT_EQ(output.left.num_joints, 17);
  for (std::size_t joint = 0; joint < 17; ++joint) {
    EXPECT_NEAR(output.left.u_px[0][joint], 8 * (12 - 0.5), 1e-3);
    EXPECT_NEAR(output.left.v_px[0][joint], 8 * (static_cast<double>(joint) + 0.25), 1e-3);
    EXPECT_NEAR(output.left.confidence[0][joint], 0.9975, 1e-4);
    EXPECT_NEAR(output.right.u_px[0][joint], 8 * (9 - 0.5), 1e-3);
  }
  const std::optional<cv::Mat> mask = DecodeMask(output.mask);
  ASSERT_TRUE(mask);
  EXPECT_EQ(mask->size(), cv::Size(256, 192));
  EXPECT_EQ(mask->at<unsigned char>(100, 92), 255);
  EXPECT_EQ(mask->at<unsigned char>(100, 250), 0);
}

TEST_F(PersonDetectorNodeTest, AMissingNetworkIsSaidWithItsKey) {
  const auto error_of = [&](const Settings& settings) {
    return ErrorOf([&] { MakeNode(settings); });
  };
  EXPECT_TRUE(Holds(error_of({"network.file=/nowhere/n.onnx"}), "/nowhere/n.onnx"));
  EXPECT_TRUE(Holds(error_of({"network.head=yolo", "network.file="}), "network.file: is empty"));
  EXPECT_TRUE(Holds(error_of({"network.head=simcc"}), "boxes.file: is empty"));
  EXPECT_TRUE(Holds(error_of({"network.width_px=0"}), "network.height_px: one of them is 0"));
  EXPECT_TRUE(Holds(error_of({"boxes.width_px=32"}), "boxes.height_px: one of them is 0"));
  // There is no installed folder beside a test, and the build folder may have them or not.
  const std::string fetched = error_of({"masks.file=", "masks.outputs=", "masks.side_px=256"});
  EXPECT_TRUE(fetched.empty() || Holds(fetched, "launch_scripts/fetch_networks.sh fetches it"))
      << fetched;
}

TEST_F(PersonDetectorNodeTest, NobodyIsSaidAsWell) {
  const auto node = MakeNode();
  const cv::Mat empty(192, 256, CV_8UC3, cv::Scalar::all(0));
  const Output output = Feed(empty, empty, HeaderAt(0), node.get());
  EXPECT_EQ(output.left.num_people, 0);
  EXPECT_EQ(output.right.num_people, 0);
  const std::optional<cv::Mat> mask = DecodeMask(output.mask);
  ASSERT_TRUE(mask);
  EXPECT_EQ(cv::countNonZero(*mask), 0);
}

TEST_F(PersonDetectorNodeTest, AnImageThatIsMissingOrBrokenHasNobody) {
  const auto node = MakeNode();
  SendImage(channel::kCameraLeft, HeaderAt(1), Image(), node.get());
  EXPECT_TRUE(node->CompleteOldest());
  Output output = TakeOne(HeaderAt(1), node.get());
  EXPECT_EQ(output.left.num_people, 1);
  EXPECT_EQ(output.right.num_people, 0);
  SendImage(channel::kCameraLeft, HeaderAt(2), Image(), node.get(), true);
  SendImage(channel::kCameraRight, HeaderAt(2), Image(), node.get());
  output = TakeOne(HeaderAt(2), node.get());
  EXPECT_EQ(output.left.num_people, 0);
  EXPECT_EQ(output.right.num_people, 1);
  EXPECT_EQ(output.mask.encoding, int{person_mask_t::ENCODING_NONE});
  EXPECT_EQ(node->channels().at(channel::kCameraLeft).num_rejected, 1);
}

TEST_F(PersonDetectorNodeTest, TheSameImagesGiveTheSameBytes) {
  const auto first = MakeNode({"time.detect_every=3"});
  const auto second = MakeNode({"time.detect_every=3"});
  for (int seq = 0; seq < 5; ++seq) {
    const Header header = HeaderAt(seq);
    EXPECT_EQ(Feed(Image(), Image(-2), header, first.get()).bytes,
              Feed(Image(), Image(-2), header, second.get()).bytes);
  }
}

TEST_F(PersonDetectorNodeTest, ANewSessionBeginsWithADetection) {
  const auto node = MakeNode({"time.detect_every=100"});
  Feed(Image(), Image(), HeaderAt(0, 1), node.get());
  const cv::Mat empty(192, 256, CV_8UC3, cv::Scalar::all(0));
  const Output output = Feed(empty, empty, HeaderAt(0, 2), node.get());
  EXPECT_EQ(output.left.num_people, 0);
  EXPECT_EQ(Feed(Image(), Image(), HeaderAt(1, 2), node.get()).left.num_people, 0);
}

TEST_F(PersonDetectorNodeTest, ANetworkThatDoesNotFitIsSaidAndTheFrameGoesOn) {
  const auto node = MakeNode({"network.outputs=centre,regression,heatmaps,offsets"});
  SendImage(channel::kCameraLeft, HeaderAt(0), Image(), node.get());
  SendImage(channel::kCameraRight, HeaderAt(0), Image(), node.get());
  EXPECT_TRUE(Holds(ErrorOf([&] { node->Step(); }), "n.onnx: the second output (heatmaps)"));
  const Output output = TakeOne(HeaderAt(0), node.get());
  EXPECT_EQ(output.left.num_people, 0);
}

}  // namespace
}  // namespace airdos
