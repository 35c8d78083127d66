#include "common/perception/person_detector.h"

#include <gtest/gtest.h>

#include <memory>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "tests/support/input_errors.h"
#include "tests/support/scratch_folder.h"
#include "tests/support/tiny_networks.h"

namespace airdos {
namespace {

constexpr int kDisparity_px = 12;

/// Texture that is the same each time, and moved to the left by `shift_px`.
cv::Mat Texture(int shift_px) {
  cv::RNG random(7);
  cv::Mat noise(60, 100, CV_8UC3);
  random.fill(noise, cv::RNG::UNIFORM, 0, 256);
  cv::Mat wide;
  cv::resize(noise, wide, {400, 240}, 0, 0, cv::INTER_CUBIC);
  return wide(cv::Rect(40 + shift_px, 0, 320, 240)).clone();
}

/// 17 joints on a grid of 5 columns, from (u, v) on.
PersonPose PersonAt(double u_px, double v_px) {
  PersonPose person;
  person.score = 0.8;
  for (int joint = 0; joint < kNumPoseJoints; ++joint) {
    const int column = joint % 5;
    const int row = joint / 5;
    person.joints[static_cast<std::size_t>(joint)] = {u_px + 12 * column, v_px + 25 * row, 0.9};
  }
  person.box_px = BoxOfJoints(person, 0.1);
  return person;
}

/// Finds whom it is told, and counts how often it is asked.
class FakeNetwork : public PoseNetwork {
 public:
  FakeNetwork(std::vector<PersonPose> people, int* num_calls)
      : people_(std::move(people)), num_calls_(num_calls) {}
  std::vector<PersonPose> Process(const cv::Mat&) override {
    ++*num_calls_;
    return people_;
  }

 private:
  std::vector<PersonPose> people_;
  int* num_calls_;
};

class PersonDetectorTest : public ::testing::Test {
 protected:
  PersonDetectorTest() {
    options_.right = PersonDetectorOptions::Right::kNetwork;
    options_.use_masks = false;
    options_.masks.use_network = false;
  }
  PersonDetector Make(const std::vector<PersonPose>& people) {
    num_calls_ = 0;
    return {options_, std::make_unique<FakeNetwork>(people, &num_calls_)};
  }

  PersonDetectorOptions options_;
  int num_calls_ = 0;
  ScratchFolder scratch_{"person_detector"};
};

TEST_F(PersonDetectorTest, TheNetworkLooksAtEachImageThatIsThere) {
  PersonDetector detector = Make({PersonAt(100, 80)});
  EXPECT_EQ(detector.Process(Texture(0), Texture(0)).right.size(), 1u);
  EXPECT_EQ(num_calls_, 2);
  const DetectedPeople left_only = detector.Process(Texture(0), {});
  EXPECT_EQ(left_only.left.size(), 1u);
  EXPECT_TRUE(left_only.right.empty());
  EXPECT_EQ(num_calls_, 3);
  EXPECT_TRUE(detector.Process({}, {}).left.empty());
}

TEST_F(PersonDetectorTest, JointsAndPeopleMustBeCertain) {
  PersonPose doubtful = PersonAt(100, 80);
  for (std::size_t joint = 0; joint < 13; ++joint) doubtful.joints[joint].confidence = 0.2;
  options_.min_joint_score = 0.3;
  options_.min_joints = 4;
  const std::vector<PersonPose> people = Make({doubtful}).Process(Texture(0), {}).left;
  ASSERT_EQ(people.size(), 1u);
  EXPECT_EQ(people[0].joints[12].confidence, 0);
  EXPECT_EQ(people[0].joints[13].confidence, 0.9);
  options_.min_joints = 5;
  EXPECT_TRUE(Make({doubtful}).Process(Texture(0), {}).left.empty());
}

TEST_F(PersonDetectorTest, BetweenDetectionsJointsFollowTheImage) {
  options_.detect_every = 3;
  PersonDetector detector = Make({PersonAt(100, 80)});
  detector.Process(Texture(0), Texture(0));
  const DetectedPeople second = detector.Process(Texture(2), Texture(3));
  const DetectedPeople third = detector.Process(Texture(4), Texture(6));
  EXPECT_EQ(num_calls_, 2);
  ASSERT_EQ(third.left.size(), 1u);
  ASSERT_EQ(third.right.size(), 1u);
  EXPECT_NEAR(second.left[0].joints[7].u_px, 124 - 2, 0.3);
  EXPECT_NEAR(third.left[0].joints[7].u_px, 124 - 4, 0.3);
  EXPECT_NEAR(third.left[0].joints[7].v_px, 105, 0.3);
  EXPECT_NEAR(third.right[0].joints[7].u_px, 124 - 6, 0.3);
  detector.Process(Texture(6), Texture(9));
  EXPECT_EQ(num_calls_, 4);
}

TEST_F(PersonDetectorTest, WhoCannotBeFollowedIsLost) {
  options_.detect_every = 2;
  PersonDetector detector = Make({PersonAt(100, 80)});
  detector.Process(Texture(0), {});
  EXPECT_TRUE(detector.Process(cv::Mat(240, 320, CV_8UC3, cv::Scalar::all(9)), {}).left.empty());
}

TEST_F(PersonDetectorTest, AJointThatIsLostMovesAsTheOthersDo) {
  options_.detect_every = 2;
  PersonDetector detector = Make({PersonAt(2, 80)});
  detector.Process(Texture(0), {});
  const std::vector<PersonPose> people = detector.Process(Texture(3), {}).left;
  ASSERT_EQ(people.size(), 1u);
  EXPECT_NEAR(people[0].joints[0].u_px, 2 - 3, 0.5);  // beyond the border
  EXPECT_NEAR(people[0].joints[0].confidence, 0.81, 1e-12);
  EXPECT_EQ(people[0].joints[14].confidence, 0.9);
}

TEST_F(PersonDetectorTest, AfterAResetItDetects) {
  options_.detect_every = 100;
  PersonDetector detector = Make({PersonAt(100, 80)});
  detector.Process(Texture(0), {});
  detector.Process(Texture(0), {});
  EXPECT_EQ(num_calls_, 1);
  detector.Reset();
  detector.Process(Texture(0), {});
  EXPECT_EQ(num_calls_, 2);
}

TEST_F(PersonDetectorTest, PeopleAreFoundAlongTheRows) {
  options_.right = PersonDetectorOptions::Right::kRows;
  PersonDetector detector = Make({PersonAt(100, 80)});
  const DetectedPeople people = detector.Process(Texture(0), Texture(kDisparity_px));
  EXPECT_EQ(num_calls_, 1);
  ASSERT_EQ(people.right.size(), 1u);
  for (std::size_t joint = 0; joint < kNumPoseJoints; ++joint) {
    const BodyKeypoint& left = people.left[0].joints[joint];
    const BodyKeypoint& right = people.right[0].joints[joint];
    EXPECT_NEAR(left.u_px - right.u_px, kDisparity_px, 0.3);
    EXPECT_EQ(left.v_px, right.v_px);
    EXPECT_EQ(right.confidence, 0.9);
  }
  EXPECT_TRUE(detector.Process(Texture(0), {}).right.empty());
}

TEST_F(PersonDetectorTest, AJointThatIsHiddenOnTheRightIsGuessed) {
  options_.right = PersonDetectorOptions::Right::kRows;
  cv::Mat right = Texture(kDisparity_px);
  cv::rectangle(right, cv::Rect(78, 70, 20, 20), cv::Scalar::all(100), cv::FILLED);  // of joint 0
  const DetectedPeople people = Make({PersonAt(100, 80)}).Process(Texture(0), right);
  ASSERT_EQ(people.right.size(), 1u);
  EXPECT_NEAR(people.right[0].joints[0].u_px, 100 - kDisparity_px, 0.3);
  EXPECT_EQ(people.right[0].joints[0].confidence, 0.45);
  EXPECT_EQ(people.right[0].joints[9].confidence, 0.9);
}

TEST_F(PersonDetectorTest, WhoIsNotInTheRightImageIsNotFoundThere) {
  options_.right = PersonDetectorOptions::Right::kRows;
  const cv::Mat plain(240, 320, CV_8UC3, cv::Scalar::all(90));
  EXPECT_TRUE(Make({PersonAt(100, 80)}).Process(Texture(0), plain).right.empty());
}

TEST_F(PersonDetectorTest, MasksAreLeftOutOnRequest) {
  EXPECT_TRUE(Make({PersonAt(100, 80)}).Process(Texture(0), {}).mask.empty());
  options_.use_masks = true;
  PersonDetector detector = Make({PersonAt(100, 80)});
  const cv::Mat mask = detector.Process(Texture(0), {}).mask;
  EXPECT_EQ(mask.size(), cv::Size(320, 240));
  EXPECT_EQ(mask.at<unsigned char>(105, 124), 255);
  EXPECT_EQ(mask.at<unsigned char>(10, 10), 0);
  EXPECT_TRUE(detector.Process({}, Texture(0)).mask.empty());
}

TEST_F(PersonDetectorTest, ALargePersonIsMarkedByTheNetwork) {
  options_.use_masks = true;
  cv::Mat image(240, 320, CV_8UC3, cv::Scalar::all(0));
  image(cv::Rect(150, 40, 20, 20)) = cv::Scalar(0, 0, 255);  // beside the body, in his square
  image(cv::Rect(280, 40, 20, 20)) = cv::Scalar(0, 0, 255);  // beyond it
  const auto mark_of = [&](int u_px) {
    const std::vector<PersonPose> people = {PersonAt(100, 80)};  // 75 px high
    return Make(people).Process(image, {}).mask.at<unsigned char>(76, u_px);
  };
  image(cv::Rect(163, 70, 10, 12)) = cv::Scalar(0, 0, 255);
  EXPECT_EQ(mark_of(168), 0);
  options_.masks.use_network = true;
  options_.masks.side_px = 64;
  options_.masks.image_short_side_px = 0;
  options_.masks.network.file = scratch_.Write("mask.onnx", TinyMask({64, 64}));
  options_.masks.min_height_px = 75;
  EXPECT_EQ(mark_of(168), 255);
  options_.masks.min_height_px = 76;
  EXPECT_EQ(mark_of(168), 0);
  options_.masks.network.outputs = {"nothing"};
  EXPECT_TRUE(Holds(ErrorOf([&] { mark_of(0); }), "has no output 'nothing'"));
}

// Whoever fills the image has hardly a joint in it.
TEST_F(PersonDetectorTest, TheMaskNetworkLooksAtTheWholeImage) {
  options_.use_masks = true;
  options_.masks.use_network = true;
  options_.masks.network.file = scratch_.Write("mask.onnx", TinyMask({96, 64}));
  options_.masks.image_short_side_px = 64;
  cv::Mat image(240, 320, CV_8UC3, cv::Scalar::all(0));
  image(cv::Rect(200, 60, 100, 90)) = cv::Scalar(0, 0, 255);
  const cv::Mat mask = Make({}).Process(image, {}).mask;
  EXPECT_EQ(mask.size(), image.size());
  cv::Mat expected(240, 320, CV_8UC1, cv::Scalar::all(0));
  expected(cv::Rect(200, 60, 100, 90)) = 255;
  EXPECT_LT(cv::countNonZero(mask != expected), 0.1 * 100 * 90) << "but for pixels at its edge";
  options_.masks.image_short_side_px = 0;
  EXPECT_EQ(cv::countNonZero(Make({}).Process(image, {}).mask), 0);
}

TEST_F(PersonDetectorTest, TheHeadDecidesTheNetwork) {
  cv::Mat image(64, 64, CV_8UC3, cv::Scalar::all(0));
  image(cv::Rect(32, 0, 32, 32)) = cv::Scalar(0, 128, 255);
  options_.head = PersonDetectorOptions::Head::kYolo;
  options_.pose = BoxNetworkOptions();
  options_.pose.network.file = scratch_.Write("yolo.onnx", TinyYolo(true));
  options_.pose.input.width_px = options_.pose.input.height_px = 64;
  EXPECT_EQ(PersonDetector(options_).Process(image, {}).left.size(), 1u);
  options_.head = PersonDetectorOptions::Head::kSimcc;
  options_.boxes = options_.pose;
  options_.pose.network.file = scratch_.Write("simcc.onnx", TinySimcc({40, 80}));
  options_.pose.input.width_px = 40;
  options_.pose.input.height_px = 80;
  const std::vector<PersonPose> people = PersonDetector(options_).Process(image, {}).left;
  ASSERT_EQ(people.size(), 1u);
  EXPECT_EQ(people[0].joints[16].confidence, 0);
  options_.head = PersonDetectorOptions::Head::kMoveNet;
  EXPECT_TRUE(Holds(ErrorOf([&] { PersonDetector detector(options_); }), "four outputs"));
}

}  // namespace
}  // namespace airdos
