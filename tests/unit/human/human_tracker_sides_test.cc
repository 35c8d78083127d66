// A detector that takes left for right in one of the two images.
#include <gtest/gtest.h>

#include <vector>

#include "common/human/human_tracker.h"

namespace airdos {
namespace {

const StereoCamera kCamera{640, 360, 700, 680, 310, 190, 0.25};

/// In C; walking past at an angle, so that the sides differ in all coordinates.
std::vector<Eigen::Vector3d> Joints(int k) {
  const Eigen::Vector3d middle(0.25 + 0.03 * k, 0, 4);
  std::vector<Eigen::Vector3d> joints;
  for (const Eigen::Vector3d& p : std::vector<Eigen::Vector3d>{{0.05, -.6, -.05},
                                                               {0, -.4, 0},
                                                               {-.15, -.4, .08},
                                                               {-.2, -.1, .1},
                                                               {-.1, .15, .12},
                                                               {.15, -.4, -.08},
                                                               {.22, -.12, -.1},
                                                               {.3, .1, -.15},
                                                               {-.1, .1, .06},
                                                               {-.15, .5, .1},
                                                               {-.12, .9, .1},
                                                               {.1, .1, -.06},
                                                               {.2, .48, -.1},
                                                               {.25, .88, -.08}})
    joints.push_back(middle + p);
  return joints;
}

BodyKeypoints Seen(int k, bool is_right) {
  BodyKeypoints person;
  const std::vector<Eigen::Vector3d> joints = Joints(k);
  for (std::size_t j = 0; j < person.size(); ++j) {
    const Eigen::Vector3d uvu = kCamera.ProjectStereo(joints[j]);
    person[j] = {is_right ? uvu.z() : uvu.x(), uvu.y(), 0.9};
  }
  return person;
}

TEST(HumanTrackerSides, SidesExchangedInTheRightImageAreExchangedBack) {
  HumanTracker tracker(HumanTrackerOptions{});
  for (int k = 0; k < 4; ++k) {
    SCOPED_TRACE(k);
    const SideSwap swap = k % 2 == 0 ? SideSwap::kAll : SideSwap::kNone;
    const TrackedFrame frame = tracker.Process(
        kCamera,
        {cv::Mat(), cv::Mat(), cv::Mat(), {Seen(k, false)}, {SwapSides(Seen(k, true), swap)}});
    ASSERT_EQ(frame.humans.size(), 1u);
    EXPECT_EQ(frame.humans[0].id.value, 1);
    for (std::size_t j = 0; j < kNumJoints; ++j) {
      ASSERT_TRUE(frame.humans[0].joints[j]) << j;
      EXPECT_LT((frame.humans[0].joints[j]->p_C - Joints(k)[j]).norm(), 1e-6) << j;
    }
  }
}

}  // namespace
}  // namespace airdos
