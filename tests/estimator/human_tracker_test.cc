#include "common/human/human_tracker.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <set>

#include "tests/support/synthetic_people.h"

namespace airdos {
namespace {

constexpr double kFramesPerSecond = 10;

// Two people who cross in front of the camera at 4.5 and 6 m, meeting in the image at frame 20.
std::vector<Joints3d> CrossingPeople(int frame) {
  const double along = 1.2 * (frame - 20) / kFramesPerSecond;
  return {WalkingPerson({along, 0.1, 4.5}, 0.6 * frame, 1.0),
          WalkingPerson({-along, 0.1, 6.0}, 0.6 * frame + 1, 1.05)};
}

PeopleFrame DetectAll(const std::vector<Joints3d>& people, double sigma_px, std::mt19937* random) {
  PeopleFrame frame;
  for (const Joints3d& person : people) {
    frame.left.push_back(Detect(kTestCamera, person, false, sigma_px, random));
    frame.right.push_back(Detect(kTestCamera, person, true, sigma_px, random));
  }
  std::shuffle(frame.left.begin(), frame.left.end(), *random);
  std::shuffle(frame.right.begin(), frame.right.end(), *random);
  return frame;
}

double MeanError(const TrackedHuman& human, const Joints3d& truth) {
  double sum = 0;
  int num = 0;
  for (std::size_t joint = 0; joint < truth.size(); ++joint) {
    if (!human.joints[joint]) continue;
    EXPECT_TRUE(human.joints[joint]->p_C.allFinite());
    EXPECT_TRUE(human.joints[joint]->covariance_C.allFinite());
    sum += (human.joints[joint]->p_C - truth[joint]).norm();
    ++num;
  }
  return num == 0 ? 1e9 : sum / num;
}

// Which of the true people a track is on.
std::size_t NearestOf(const TrackedHuman& human, const std::vector<Joints3d>& people) {
  std::size_t nearest = 0;
  for (std::size_t i = 1; i < people.size(); ++i) {
    if (MeanError(human, people[i]) < MeanError(human, people[nearest])) nearest = i;
  }
  return nearest;
}

TEST(HumanTracker, NoNoiseNoError) {
  HumanTracker tracker({});
  std::mt19937 random(1);
  for (int frame = 0; frame < 40; ++frame) {
    const std::vector<Joints3d> people = CrossingPeople(frame);
    const TrackedFrame tracked = tracker.Process(kTestCamera, DetectAll(people, 0, &random));
    ASSERT_EQ(tracked.humans.size(), 2U) << frame;
    EXPECT_EQ(tracked.num_rejected, 0);
    for (const TrackedHuman& human : tracked.humans) {
      const std::size_t person = NearestOf(human, people);
      EXPECT_EQ(NumObserved(human.joints), kNumJoints);
      EXPECT_NEAR(MeanError(human, people[person]), 0, 1e-9);
    }
  }
}

TEST(HumanTracker, NoiseGivesABoundedErrorAndCrossingPeopleKeepTheirIds) {
  for (const unsigned seed : {1U, 2U, 3U}) {
    HumanTracker tracker({});
    std::mt19937 random(seed);
    std::map<std::size_t, std::set<std::int64_t>> ids;
    double sum = 0;
    int num = 0;
    for (int frame = 0; frame < 40; ++frame) {
      const std::vector<Joints3d> people = CrossingPeople(frame);
      const TrackedFrame tracked = tracker.Process(kTestCamera, DetectAll(people, 1, &random));
      for (const TrackedHuman& human : tracked.humans) {
        const std::size_t person = NearestOf(human, people);
        ids[person].insert(human.id.value);
        sum += MeanError(human, people[person]);
        ++num;
      }
    }
    EXPECT_GE(num, 78);
    // Depth: z^2 / (f b) * sqrt(2) * 1 px is 0.15 m at 4.5 m and 0.26 m at 6 m; the mean of the
    // size of a Gaussian error is 0.8 sigma.
    EXPECT_LT(sum / num, 0.2);
    EXPECT_GT(sum / num, 0.1);
    EXPECT_EQ(ids[0].size(), 1U) << "seed " << seed;
    EXPECT_EQ(ids[1].size(), 1U) << "seed " << seed;
    EXPECT_NE(*ids[0].begin(), *ids[1].begin());
  }
}

TEST(HumanTracker, SurvivesMissesAndForgetsAfterTheLimit) {
  HumanTrackerOptions options;
  HumanTracker tracker(options);
  std::mt19937 random(4);
  const auto process = [&](int frame, bool is_missed) {
    const std::vector<Joints3d> people = {WalkingPerson({0.1 * frame - 0.5, 0.1, 5}, 0.5 * frame)};
    return tracker.Process(kTestCamera, is_missed ? PeopleFrame() : DetectAll(people, 1, &random));
  };
  std::set<std::int64_t> ids;
  for (int frame = 0; frame < 12; ++frame) {
    const bool is_missed = frame >= 5 && frame < 9;
    const TrackedFrame tracked = process(frame, is_missed);
    if (is_missed) {
      EXPECT_TRUE(tracked.humans.empty());
    } else {
      ASSERT_EQ(tracked.humans.size(), 1U) << frame;
      ids.insert(tracked.humans[0].id.value);
    }
  }
  EXPECT_EQ(ids.size(), 1U);
  for (int frame = 0; frame <= options.max_missed_frames; ++frame) process(12, true);
  const TrackedFrame again = process(12, false);
  ASSERT_EQ(again.humans.size(), 1U);
  EXPECT_EQ(ids.count(again.humans[0].id.value), 0U);  // ids are never used again
}

TEST(HumanTracker, PutsExchangedSidesRight) {
  HumanTracker tracker({});
  std::mt19937 random(5);
  for (int frame = 0; frame < 12; ++frame) {
    const Joints3d person = WalkingPerson({0, 0.1, 4}, 0.4 * frame);
    PeopleFrame detections = DetectAll({person}, 0.5, &random);
    if (frame == 4) detections.left[0] = SwapSides(detections.left[0], SideSwap::kAll);
    if (frame == 6) detections.right[0] = SwapSides(detections.right[0], SideSwap::kAll);
    if (frame == 8) detections.left[0] = SwapSides(detections.left[0], SideSwap::kLowerLegs);
    const TrackedFrame tracked = tracker.Process(kTestCamera, detections);
    ASSERT_EQ(tracked.humans.size(), 1U) << frame;
    EXPECT_LT(MeanError(tracked.humans[0], person), 0.12) << frame;
  }
}

TEST(HumanTracker, FollowsThroughAFastTurnOfTheCamera) {
  HumanTracker tracker({});
  std::mt19937 random(6);
  std::map<std::size_t, std::set<std::int64_t>> ids;
  for (int frame = 0; frame < 8; ++frame) {
    // 5 degrees a frame, started at once: 67 px, more than the distance between the two.
    const double turn = frame < 2 ? 0 : 5 * M_PI / 180 * (frame - 2);
    const Eigen::Matrix3d turned =
        Eigen::AngleAxisd(-turn, Eigen::Vector3d::UnitY()).toRotationMatrix();
    std::vector<Joints3d> people = {WalkingPerson({1.6, 0.1, 5}, frame),
                                    WalkingPerson({2.0, 0.1, 5.5}, frame + 1.0),
                                    WalkingPerson({1.0, 0.1, 4}, frame + 2.0)};
    for (Joints3d& person : people) {
      for (Eigen::Vector3d& joint : person) joint = turned * joint;
    }
    const TrackedFrame tracked = tracker.Process(kTestCamera, DetectAll(people, 1, &random));
    for (const TrackedHuman& human : tracked.humans) {
      ids[NearestOf(human, people)].insert(human.id.value);
    }
  }
  for (const auto& [person, its_ids] : ids) EXPECT_EQ(its_ids.size(), 1U) << person;
  EXPECT_EQ(ids.size(), 3U);
}

TEST(HumanTracker, SameFramesSameResult) {
  const auto run = [] {
    HumanTracker tracker({});
    std::mt19937 random(7);
    std::vector<double> numbers;
    for (int frame = 0; frame < 30; ++frame) {
      for (const TrackedHuman& human :
           tracker.Process(kTestCamera, DetectAll(CrossingPeople(frame), 1, &random)).humans) {
        numbers.push_back(static_cast<double>(human.id.value));
        for (const auto& joint : human.joints) numbers.push_back(joint ? joint->p_C.z() : -1);
      }
    }
    return numbers;
  };
  EXPECT_EQ(run(), run());
}

TEST(HumanTracker, NobodyAndNonsense) {
  HumanTracker tracker({});
  EXPECT_TRUE(tracker.Process(kTestCamera, {}).humans.empty());
  PeopleFrame unseen;
  unseen.left.resize(2);
  unseen.right.resize(1);
  const TrackedFrame tracked = tracker.Process(kTestCamera, unseen);
  EXPECT_TRUE(tracked.humans.empty());
  EXPECT_EQ(tracked.num_rejected, 3);
}

}  // namespace
}  // namespace airdos
