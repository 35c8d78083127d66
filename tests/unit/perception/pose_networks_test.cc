// The heads of networks that find people, on networks of a few layers whose answers are known.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <opencv2/imgproc.hpp>

#include "common/perception/movenet.h"
#include "common/perception/simcc_pose.h"
#include "common/perception/yolo_pose.h"
#include "tests/support/input_errors.h"
#include "tests/support/scratch_folder.h"
#include "tests/support/tiny_networks.h"

namespace airdos {
namespace {

const cv::Scalar kRed(0, 0, 255);
const cv::Scalar kGreen(0, 255, 0);

double Sigmoid(double logit) { return 1 / (1 + std::exp(-logit)); }

class PoseNetworksTest : public ::testing::Test {
 protected:
  PoseNetworkOptions Options(const std::string& network, const cv::Size& input) {
    PoseNetworkOptions options;
    options.network.file = scratch_.Write("network.onnx", network);
    options.input.width_px = input.width;
    options.input.height_px = input.height;
    for (double* mean :
         {&options.input.mean_red, &options.input.mean_green, &options.input.mean_blue})
      *mean = 0;
    for (double* scale :
         {&options.input.scale_red, &options.input.scale_green, &options.input.scale_blue})
      *scale = 255;
    return options;
  }

  PoseNetworkOptions MoveNetOptions(bool has_channels_last = false) {
    PoseNetworkOptions options = Options(TinyMoveNet({128, 96}, has_channels_last), {128, 96});
    options.network.outputs = {"centre", "heatmaps", "regression", "offsets"};
    return options;
  }

  ScratchFolder scratch_{"pose_networks"};
};

constexpr int kMoveNetCell_px = 8;  // in an image of twice the input's size

void PaintCell(int x, int y, const cv::Scalar& color, cv::Mat* image) {
  cv::rectangle(*image, cv::Rect(kMoveNetCell_px * x, kMoveNetCell_px * y, 8, 8), color,
                cv::FILLED);
}

cv::Mat MoveNetImage() {
  cv::Mat image(192, 256, CV_8UC3, cv::Scalar::all(0));
  PaintCell(10, 8, kRed, &image);
  PaintCell(12, 3, kGreen, &image);
  PaintCell(20, 20, kGreen, &image);
  return image;
}

void ExpectThePersonOf(const std::vector<PersonPose>& people) {
  ASSERT_EQ(people.size(), 1u);
  EXPECT_NEAR(people[0].score, Sigmoid(6), 1e-5);
  // Joint 3 is expected 2 columns right of (10, 8) and 5 rows above: where the green cell is.
  for (const int joint : {3, 5}) {
    const BodyKeypoint& found = people[0].joints[static_cast<std::size_t>(joint)];
    EXPECT_NEAR(found.u_px, 2 * 4 * (12 - 0.5), 1e-3);
    EXPECT_NEAR(found.v_px, 2 * 4 * (3 + 0.25), 1e-3);
    EXPECT_NEAR(found.confidence, Sigmoid(6), 1e-5);
  }
  // Joint 16 is expected 13 rows below it, and nothing is near: it is where it is expected.
  EXPECT_NEAR(people[0].joints[16].u_px, 2 * 4 * (12 - 0.5), 1e-3);
  EXPECT_NEAR(people[0].joints[16].v_px, 2 * 4 * (16 + 0.25), 1e-3);
  EXPECT_NEAR(people[0].joints[16].confidence, Sigmoid(-6), 1e-5);
}

TEST_F(PoseNetworksTest, MoveNetTakesTheJointThatIsStrongAndNearWhereItIsExpected) {
  MoveNet network(MoveNetOptions());
  ExpectThePersonOf(network.Process(MoveNetImage()));
}

TEST_F(PoseNetworksTest, MoveNetMayHaveItsChannelsAtLast) {
  PoseNetworkOptions options = MoveNetOptions(true);
  options.input.layout = NetworkInputOptions::Layout::kChannelsLast;
  MoveNet network(options);
  ExpectThePersonOf(network.Process(MoveNetImage()));
}

TEST_F(PoseNetworksTest, MoveNetOutputsAreThoseThatAreNamed) {
  PoseNetworkOptions options = MoveNetOptions();
  options.network.outputs = {"centre", "heatmaps", "offsets", "regression"};  // the last swapped
  MoveNet network(options);
  const std::vector<PersonPose> people = network.Process(MoveNetImage());
  ASSERT_EQ(people.size(), 1u);
  EXPECT_GT(std::abs(people[0].joints[3].v_px - 26), 8);
}

TEST_F(PoseNetworksTest, MoveNetKnowsPeopleByTheirMiddles) {
  MoveNet network(MoveNetOptions());
  cv::Mat image = MoveNetImage();
  PaintCell(12, 9, cv::Scalar(0, 0, 200), &image);  // within 5 x 5 of a better one
  EXPECT_EQ(network.Process(image).size(), 1u);
  PaintCell(25, 20, cv::Scalar(0, 0, 200), &image);
  const std::vector<PersonPose> people = network.Process(image);
  ASSERT_EQ(people.size(), 2u);
  EXPECT_NEAR(people[1].score, Sigmoid(12 * 200 / 255. - 6), 1e-4);
  PaintCell(25, 5, cv::Scalar(0, 0, 90), &image);  // sigmoid(12 * 90 / 255 - 6) is .15
  EXPECT_EQ(network.Process(image).size(), 2u);
  EXPECT_TRUE(network.Process(cv::Mat::zeros(192, 256, CV_8UC3)).empty());
}

TEST_F(PoseNetworksTest, MoveNetHeedsItsLimits) {
  PoseNetworkOptions options = MoveNetOptions();
  cv::Mat image = MoveNetImage();
  PaintCell(25, 20, cv::Scalar(0, 0, 200), &image);
  options.max_people = 1;
  EXPECT_EQ(MoveNet(options).Process(image).size(), 1u);
  options.max_people = 60;
  options.min_score = 0.98;
  EXPECT_EQ(MoveNet(options).Process(image).size(), 1u);
  options.min_score = 0.999;
  EXPECT_EQ(MoveNet(options).Process(image).size(), 0u);
}

TEST_F(PoseNetworksTest, ColoursMayComeInTheOtherOrder) {
  PoseNetworkOptions options = MoveNetOptions();
  options.input.colours = NetworkInputOptions::Colours::kBgr;
  cv::Mat image = MoveNetImage();
  cv::cvtColor(image, image, cv::COLOR_BGR2RGB);
  ExpectThePersonOf(MoveNet(options).Process(image));
}

TEST_F(PoseNetworksTest, MoveNetSaysWhichOutputIsWrong) {
  PoseNetworkOptions options = MoveNetOptions();
  options.network.outputs = {"centre", "regression", "heatmaps", "offsets"};
  EXPECT_TRUE(Holds(ErrorOf([&] { MoveNet(options).Process(MoveNetImage()); }),
                    "network.onnx: the second output (heatmaps) must be an image of 17 channels"));
  options.network.outputs = {"centre"};
  EXPECT_TRUE(Holds(ErrorOf([&] { MoveNet network(options); }),
                    "four outputs must be named (centre, heatmaps, regression, offsets), not 1"));
}

/// Four quarters of 64 x 64 px, of which the input of 64 x 64 has a cell of 32 px each.
cv::Mat YoloImage() {
  cv::Mat image(128, 128, CV_8UC3, cv::Scalar::all(0));
  image(cv::Rect(64, 0, 64, 64)) = cv::Scalar(0, 128, 255);
  image(cv::Rect(0, 64, 64, 64)) = cv::Scalar(0, 255, 128);
  return image;
}

TEST_F(PoseNetworksTest, YoloReadsItsListEitherWay) {
  for (const bool is_transposed : {false, true}) {
    YoloPose network(Options(TinyYolo(is_transposed), {64, 64}));
    const std::vector<PersonPose> people = network.Process(YoloImage());
    ASSERT_EQ(people.size(), 2u);
    EXPECT_NEAR(people[0].score, 1, 1e-5);
    EXPECT_NEAR(people[1].score, 128 / 255., 1e-5);
    EXPECT_EQ(people[0].box_px, cv::Rect2d(2 * (48 - 10), 2 * (16 - 15), 2 * 20, 2 * 30));
    EXPECT_NEAR(people[0].joints[7].u_px, 2 * 1, 1e-4);
    EXPECT_NEAR(people[0].joints[7].v_px, 2 * 7, 1e-4);
    EXPECT_NEAR(people[0].joints[7].confidence, 128 / 255., 1e-5);
    EXPECT_NEAR(people[1].joints[7].u_px, 2 * 2, 1e-4);
    EXPECT_NEAR(people[1].joints[7].confidence, 1, 1e-5);
  }
}

TEST_F(PoseNetworksTest, YoloShowsTheImageInTheMiddleOfGrey) {
  PoseNetworkOptions options = Options(TinyYolo(true), {64, 64});
  options.min_score = 0.9;
  YoloPose network(options);
  // 128 x 64 fills the rows 16 to 47 of the input: in each cell half is of grey 114.
  cv::Mat image(64, 128, CV_8UC3, cv::Scalar(0, 0, 255));
  EXPECT_TRUE(network.Process(image).empty());  // (255 + 114) / 2 / 255 = 0.72
  options.min_score = 0.7;
  const std::vector<PersonPose> people = YoloPose(options).Process(image);
  ASSERT_EQ(people.size(), 4u);
  EXPECT_NEAR(people[0].score, (255 + 114) / 2. / 255, 1e-4);
  EXPECT_NEAR(people[0].joints[2].v_px, 2 * (2 - 16), 1e-4);
}

TEST_F(PoseNetworksTest, WhatIsNoListOfPeopleIsRefused) {
  EXPECT_TRUE(Holds(ErrorOf([&] {
                      YoloPose(Options(TinyMask({64, 64}), {64, 64})).Process(YoloImage());
                    }),
                    "network.onnx: the output must be a list of 56 or 57 columns"));
}

/// Finds one box, always.
class OneBox : public PoseNetwork {
 public:
  explicit OneBox(const cv::Rect2d& box) : box_(box) {}
  std::vector<PersonPose> Process(const cv::Mat&) override {
    PersonPose person;
    person.score = 0.75;
    person.box_px = box_;
    return {person};
  }

 private:
  cv::Rect2d box_;
};

TEST_F(PoseNetworksTest, SimccFindsJointsWithinTheBox) {
  // A box of 32 x 64 within an input of 40 x 80 that is a quarter larger: one pixel is one pixel.
  cv::Mat image(200, 200, CV_8UC3, cv::Scalar::all(0));
  cv::rectangle(image, cv::Rect(110, 80, 1, 1), kRed, cv::FILLED);
  for (const bool is_swapped : {false, true}) {
    SimccPose network(Options(TinySimcc({40, 80}, is_swapped), {40, 80}),
                      std::make_unique<OneBox>(cv::Rect2d(100, 50, 32, 64)));
    const std::vector<PersonPose> people = network.Process(image);
    ASSERT_EQ(people.size(), 1u);
    EXPECT_EQ(people[0].score, 0.75);
    EXPECT_NEAR(people[0].joints[4].u_px, 110, 1e-6);
    EXPECT_NEAR(people[0].joints[4].v_px, 80, 1e-6);
    EXPECT_NEAR(people[0].joints[4].confidence, 1 / 80., 1e-6);  // the lower of 1/80 and 1/40
    EXPECT_EQ(people[0].joints[16].confidence, 0);
  }
}

TEST_F(PoseNetworksTest, SimccScalesBoxesOfOtherSizesAndShapes) {
  // 128 wide and 64 high: the width decides, 160 px of the image are 40 of the input.
  cv::Mat image(300, 300, CV_8UC3, cv::Scalar::all(0));
  cv::rectangle(image, cv::Rect(140, 120, 4, 4), kRed, cv::FILLED);
  SimccPose network(Options(TinySimcc({40, 80}), {40, 80}),
                    std::make_unique<OneBox>(cv::Rect2d(100, 100, 128, 64)));
  const std::vector<PersonPose> people = network.Process(image);
  ASSERT_EQ(people.size(), 1u);
  EXPECT_NEAR(people[0].joints[0].u_px, 142, 4);
  EXPECT_NEAR(people[0].joints[0].v_px, 122, 4);
}

TEST_F(PoseNetworksTest, SimccNeedsItsSizeAndTwoLists) {
  const auto boxes = [] { return std::make_unique<OneBox>(cv::Rect2d(0, 0, 10, 10)); };
  EXPECT_TRUE(Holds(ErrorOf([&] {
                      SimccPose(Options(TinySimcc({40, 80}), {0, 0}), boxes());
                    }),
                    "needs the width and height"));
  const cv::Mat image(100, 100, CV_8UC3, cv::Scalar::all(0));
  EXPECT_TRUE(Holds(ErrorOf([&] {
                      SimccPose(Options(TinyMask({40, 80}), {40, 80}), boxes()).Process(image);
                    }),
                    "must have two outputs"));
}

TEST(PersonPoseTest, OfTwoBoxesThatAreOneTheBetterStays) {
  std::vector<PersonPose> people(3);
  people[0].score = 0.5;
  people[0].box_px = {0, 0, 10, 10};
  people[1].score = 0.9;
  people[1].box_px = {0, 0, 10, 8};  // 80 of 100 in common
  people[2].score = 0.4;
  people[2].box_px = {0, 0, 10, 5};  // 50 of 80
  std::vector<PersonPose> kept = people;
  KeepBest(0.81, &kept);
  EXPECT_EQ(kept.size(), 3u);
  kept = people;
  KeepBest(0.79, &kept);
  ASSERT_EQ(kept.size(), 2u);
  EXPECT_EQ(kept[0].score, 0.9);
  EXPECT_EQ(kept[1].score, 0.4);
  kept = people;
  KeepBest(0.6, &kept);
  EXPECT_EQ(kept.size(), 1u);
}

TEST(PersonPoseTest, TheBoxIsAroundJointsThatAreSeen) {
  PersonPose person;
  EXPECT_TRUE(BoxOfJoints(person, 0.1).empty());
  person.joints[0] = {10, 20, 0.5};
  person.joints[9] = {30, 5, 0.2};
  person.joints[16] = {100, 100, 0.1};
  const cv::Rect2d box = BoxOfJoints(person, 0.2);
  EXPECT_NEAR(box.x, 10, 1e-4);
  EXPECT_NEAR(box.y, 5, 1e-4);
  EXPECT_NEAR(box.width, 20, 1e-4);
  EXPECT_NEAR(box.height, 15, 1e-4);
}

TEST(PersonPoseTest, JointsBecomeThoseOfTheBodyModel) {
  PersonPose person;
  person.joints[5] = {1, 2, 0.5};   // left shoulder
  person.joints[6] = {3, 4, 0.25};  // right
  person.joints[16] = {7, 8, 0.125};
  const BodyKeypoints body = ToBody(person);
  EXPECT_EQ(body[kLeftShoulder].u_px, 1);
  EXPECT_EQ(body[kRightShoulder].v_px, 4);
  EXPECT_EQ(body[kRightAnkle].confidence, 0.125);
  EXPECT_EQ(body[kNeck].u_px, 2);
  EXPECT_EQ(body[kNeck].confidence, 0.25);
}

}  // namespace
}  // namespace airdos
