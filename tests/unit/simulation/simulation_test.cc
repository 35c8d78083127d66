#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "common/simulation/feature_simulator.h"
#include "common/simulation/settings.h"
#include "common/util/error.h"

namespace airdos {
namespace {

TEST(SimulationTest, ASeedRepeatsAndAnotherDoesNot) {
  const SimulatedSequence a = Simulate(SettingByName("group1", 3));
  const SimulatedSequence b = Simulate(SettingByName("group1", 3));
  const SimulatedSequence other = Simulate(SettingByName("group1", 4));
  ASSERT_EQ(a.frames.size(), b.frames.size());
  for (std::size_t k = 0; k < a.frames.size(); ++k) {
    ASSERT_EQ(a.frames[k].object_points.size(), b.frames[k].object_points.size());
    for (std::size_t i = 0; i < a.frames[k].object_points.size(); ++i) {
      ASSERT_EQ(a.frames[k].object_points[i].p_C, b.frames[k].object_points[i].p_C);
    }
    ASSERT_EQ(a.frames[k].T_W_C_odometry.translation, b.frames[k].T_W_C_odometry.translation);
  }
  EXPECT_NE(a.frames[1].T_W_C_odometry.translation, other.frames[1].T_W_C_odometry.translation);
}

TEST(SimulationTest, EverySettingCanBeSimulated) {
  for (const std::string& name : SettingNames()) {
    const SimulatedSequence sequence = Simulate(SettingByName(name, 5));
    EXPECT_EQ(static_cast<int>(sequence.frames.size()), sequence.options.num_frames) << name;
    EXPECT_LT(Boxminus(sequence.frames[0].T_W_C, Se3()).norm(), 1e-9) << name;
    for (const SimulatedFrame& frame : sequence.frames) {
      EXPECT_EQ(static_cast<int>(frame.static_points.size()), sequence.options.static_per_frame)
          << name;
    }
  }
  EXPECT_THROW(SettingByName("group5", 1), InputError);
}

TEST(SimulationTest, TheGroupsHaveThePapersNumbers) {
  const int frames[] = {38, 50, 70, 80}, points[] = {36, 30, 24, 34}, objects[] = {4, 4, 3, 4};
  for (std::size_t i = 0; i < 4; ++i) {
    double num_static = 0, num_dynamic = 0;
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
      const SimulatedSequence sequence = Simulate(SettingByName(PaperGroups()[i], seed));
      EXPECT_EQ(static_cast<int>(sequence.frames.size()), frames[i]);
      EXPECT_EQ(static_cast<int>(sequence.objects.size()), objects[i]);
      for (const SimulatedFrame& frame : sequence.frames) {
        EXPECT_EQ(static_cast<int>(frame.static_points.size()), points[i]);
        num_static += static_cast<double>(frame.static_points.size());
        num_dynamic += static_cast<double>(frame.object_points.size());
      }
    }
    EXPECT_NEAR(num_dynamic / num_static, 1.8, 0.15) << PaperGroups()[i];
  }
}

TEST(SimulationTest, WithoutNoiseTheMeasurementsAreTheTruth) {
  for (const bool has_point_noise : {true, false}) {
    SimulationOptions options = SettingByName("walkers8", 2);
    options.has_point_noise = has_point_noise;
    options.point_sigma_m = options.pixel_sigma_px = 0;
    options.odometry_sigma_m = options.odometry_sigma_deg = 0;
    const SimulatedSequence sequence = Simulate(options);
    for (std::size_t k = 0; k < sequence.frames.size(); ++k) {
      const SimulatedFrame& frame = sequence.frames[k];
      EXPECT_LT(Boxminus(frame.T_W_C_odometry, frame.T_W_C).norm(), 1e-9);
      for (const SimulatedMeasurement& seen : frame.static_points) {
        const Eigen::Vector3d& p_W = sequence.landmarks_W[static_cast<std::size_t>(seen.index)];
        ASSERT_LT((frame.T_W_C * seen.p_C - p_W).norm(), 1e-9);
        ASSERT_TRUE(options.camera.IsInImage(seen.uvu_px.head<2>()));
      }
      for (const SimulatedMeasurement& seen : frame.object_points) {
        const MovingObject& object = sequence.objects[static_cast<std::size_t>(seen.object)];
        const Eigen::Vector3d& p_W = object.points_W[k][static_cast<std::size_t>(seen.index)];
        ASSERT_LT((frame.T_W_C * seen.p_C - p_W).norm(), 1e-9);
        ASSERT_LT((options.camera.ProjectStereo(seen.p_C) - seen.uvu_px).norm(), 1e-6);
      }
    }
  }
}

TEST(SimulationTest, TheNoiseHasItsSigma) {
  for (const char* name : {"group1", "walkers8"}) {
    const SimulatedSequence sequence = Simulate(SettingByName(name, 6));
    double sum = 0;
    int num = 0;
    for (const SimulatedFrame& frame : sequence.frames) {
      for (const SimulatedMeasurement& seen : frame.static_points) {
        const Eigen::Vector3d p_C =
            frame.T_W_C.inverse() * sequence.landmarks_W[static_cast<std::size_t>(seen.index)];
        const SimulationOptions& options = sequence.options;
        const Eigen::Vector3d error =
            options.has_point_noise
                ? Eigen::Vector3d((seen.p_C - p_C) / options.point_sigma_m)
                : Eigen::Vector3d((seen.uvu_px - options.camera.ProjectStereo(p_C)) /
                                  options.pixel_sigma_px);
        sum += error.squaredNorm();
        num += 3;
      }
    }
    // The relative standard error of a variance of n numbers is sqrt(2 / n).
    EXPECT_NEAR(sum / num, 1, 4 * std::sqrt(2.0 / num)) << name;
  }
}

TEST(SimulationTest, SegmentsKeepTheirLengths) {
  for (const char* name : {"group1", "turn8", "stop8", "sit8"}) {
    const SimulatedSequence sequence = Simulate(SettingByName(name, 7));
    for (const MovingObject& object : sequence.objects) {
      for (const auto& [a, b] : object.segments) {
        const auto length_m = [&, i = static_cast<std::size_t>(a),
                               j = static_cast<std::size_t>(b)](std::size_t k) {
          return (object.points_W[k][i] - object.points_W[k][j]).norm();
        };
        for (std::size_t k = 1; k < object.points_W.size(); ++k) {
          ASSERT_NEAR(length_m(k), length_m(0), 1e-9) << name << " " << a << " " << b;
        }
      }
    }
  }
}

/// The middle of a person's torso.
Eigen::Vector3d Middle(const MovingObject& object, std::size_t k) {
  return 0.5 * (object.points_W[k][8] + object.points_W[k][11]);
}

TEST(SimulationTest, PeopleDoWhatTheirSettingSays) {
  double slowest = 10, fastest_cruiser_change = 0;
  for (const MovingObject& object : Simulate(SettingByName("stop8", 8)).objects) {
    for (std::size_t k = 2; k < object.points_W.size(); ++k) {
      const Eigen::Vector3d now = Middle(object, k) - Middle(object, k - 1);
      const Eigen::Vector3d before = Middle(object, k - 1) - Middle(object, k - 2);
      const auto flat = [](const Eigen::Vector3d& v) { return std::hypot(v.x(), v.z()) / 0.1; };
      if (object.behaviour == Behaviour::kStop) slowest = std::min(slowest, flat(now));
      if (object.behaviour == Behaviour::kCruise) {
        fastest_cruiser_change = std::max(fastest_cruiser_change, flat(now - before));
      }
    }
  }
  EXPECT_LT(slowest, 0.02);
  EXPECT_LT(fastest_cruiser_change, 0.2);  // m/s from frame to frame: 2 m/s^2 at the very most

  double deepest_m = 0;
  for (const MovingObject& object : Simulate(SettingByName("sit8", 8)).objects) {
    const std::size_t last = object.points_W.size() - 1;
    deepest_m = std::max(deepest_m, Middle(object, last).y() - Middle(object, 0).y());
  }
  EXPECT_GT(deepest_m, 0.3);
}

TEST(SimulationTest, SwappedPeopleAreTakenForEachOther) {
  const SimulatedSequence sequence = Simulate(SettingByName("swap8", 9));
  std::set<std::size_t> at_the_end;
  int num_swapped = 0;
  const int last = sequence.options.num_frames - 1;
  for (int object = 0; object < static_cast<int>(sequence.objects.size()); ++object) {
    EXPECT_EQ(sequence.TrueObject(object, 0), static_cast<std::size_t>(object));
    const std::size_t taken = sequence.TrueObject(object, last);
    at_the_end.insert(taken);
    if (taken != static_cast<std::size_t>(object)) {
      ++num_swapped;
      EXPECT_EQ(sequence.TrueObject(static_cast<int>(taken), last),
                static_cast<std::size_t>(object));
    }
  }
  EXPECT_EQ(at_the_end.size(), sequence.objects.size());
  EXPECT_EQ(num_swapped, 6);
}

TEST(SimulationTest, ThePanningCameraTurnsAsItShould) {
  const SimulatedSequence sequence = Simulate(SettingByName("walkers8", 10));
  for (std::size_t k = 1; k < sequence.frames.size(); ++k) {
    const Se3 step = sequence.frames[k - 1].T_W_C.inverse() * sequence.frames[k].T_W_C;
    const double turn_deg = LogSo3(step.rotation).norm() * 180 / M_PI;
    EXPECT_GT(turn_deg, 10);
    EXPECT_LT(turn_deg, 23);
  }
}

TEST(SimulationTest, OptionsThatMakeNoSenseAreRefused) {
  SimulationOptions options;
  options.num_frames = 1;
  EXPECT_THROW(Simulate(options), InputError);
  options = {};
  options.objects = {{true, Behaviour::kCruise, 1, 30}};
  EXPECT_THROW(Simulate(options), InputError);
  options = {};
  options.farthest_m = 1;
  EXPECT_THROW(Simulate(options), InputError);
}

}  // namespace
}  // namespace airdos
