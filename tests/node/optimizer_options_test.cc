#include "processes/optimizer/optimizer_options.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "common/util/error.h"
#include "tests/support/synthetic_scene.h"

// Every option of the file: it reaches the member that is meant and no other, its bounds hold, and
// it changes what the optimizer says.

namespace airdos {
namespace {

constexpr char kConfig[] = AIRDOS_SOURCE_DIR "/launch_scripts/config/optimizer.yaml";
using Overrides = std::vector<std::string>;

struct Option {
  std::string key;
  std::string value;  ///< another one than the file's
  std::function<double(const OptimizerOptions&)> member;
  double expected;       ///< of the member
  std::string outside;   ///< values that are refused, separated by blanks
  Overrides where = {};  ///< options under which this one has an effect
};

#define AIRDOS_MEMBER(expression) \
  [](const OptimizerOptions& o) { return static_cast<double>(o.expression); }

std::vector<Option> WindowOptions() {
  return {
      {"window.frames", "9", AIRDOS_MEMBER(window.map.window_frames), 9, "1 101"},
      {"window.max_fixed_key_frames", "1", AIRDOS_MEMBER(window.map.max_fixed_key_frames), 1,
       "-1 101"},
      {"window.min_shared_landmarks", "37", AIRDOS_MEMBER(window.map.min_shared_landmarks), 37,
       "0 10001"},
      {"window.key_frame_max_shared",
       "0.95",
       AIRDOS_MEMBER(window.map.key_frame_max_shared),
       0.95,
       "-0.1 1.1",
       {"window.key_frame_interval=1000"}},
      {"window.key_frame_interval", "2", AIRDOS_MEMBER(window.map.key_frame_interval), 2, "0 1001"},
      {"window.max_key_frames", "1", AIRDOS_MEMBER(window.map.max_key_frames), 1, "0 10001"},
      {"window.forget_after_frames",
       "1",
       AIRDOS_MEMBER(window.map.forget_after_frames),
       1,
       "0 1000001",
       {"window.frames=3", "window.key_frame_interval=1000", "window.key_frame_max_shared=0",
        "output.publish_moved_m=1"}},
      {"window.min_disparity_px", "9", AIRDOS_MEMBER(window.map.min_disparity_px), 9, "0.009 101"},
      {"window.max_eliminations", "1", AIRDOS_MEMBER(window.map.max_eliminations), 1, "0 101"},
      {"solver.method", "ceres", AIRDOS_MEMBER(window.bundle.solver), 1, "Structured"},
      {"solver.max_iterations", "2", AIRDOS_MEMBER(window.bundle.max_iterations), 2, "0 1001"},
      {"solver.max_iterations_after_elimination", "1",
       AIRDOS_MEMBER(window.bundle.max_iterations_after_elimination), 1, "-1 1001"},
      {"solver.function_tolerance", "0.1", AIRDOS_MEMBER(window.bundle.function_tolerance), 0.1,
       "-1e-9 1.1"},
      {"solver.huber_static", "1.5", AIRDOS_MEMBER(window.bundle.huber_static), 1.5, "0 1.1e6"},
      {"solver.eliminate_static", "2.5", AIRDOS_MEMBER(window.bundle.eliminate_static), 2.5,
       "0 1.1e9"},
      {"camera_motion.use_acceleration", "false",
       AIRDOS_MEMBER(window.camera_motion.use_acceleration), 0, "2"},
      {"camera_motion.sigma_factor", "0.2", AIRDOS_MEMBER(window.camera_motion.sigma_factor), 0.2,
       "-0.1 1001"},
      {"output.publish_moved_m", "0.02", AIRDOS_MEMBER(window.publish_moved_m), 0.02, "-1e-9 1.1"},
  };
}

std::vector<Option> PeopleOptions() {
  return {
      {"people.mode", "mask_only", AIRDOS_MEMBER(people), 1, "maybe"},
      {"people.rigidity", "false", AIRDOS_MEMBER(window.bundle.use_rigidity), 0, "2"},
      {"people.motion", "false", AIRDOS_MEMBER(window.bundle.use_motion), 0, "2"},
      {"people.motion_form", "velocity_track", AIRDOS_MEMBER(window.bundle.motion_form), 1,
       "se3_track"},
      {"people.window_frames", "5", AIRDOS_MEMBER(window.people.window_frames), 5, "1 101"},
      {"people.forget_after_frames", "2", AIRDOS_MEMBER(window.people.forget_after_frames), 2,
       "0 1000001"},
      {"people.min_disparity_px", "25", AIRDOS_MEMBER(window.people.min_disparity_px), 25,
       "0.009 101"},
      {"people.max_depth_m", "9", AIRDOS_MEMBER(window.people.max_depth_m), 9, "0.09 10001"},
      {"people.huber", "0.7", AIRDOS_MEMBER(window.bundle.huber_dynamic), 0.7, "0 1.1e6"},
      {"people.rigidity_sigma_m", "0.03", AIRDOS_MEMBER(window.bundle.rigidity_sigma_m), 0.03,
       "0 101"},
      {"people.segment_length_sigma_m", "0.05", AIRDOS_MEMBER(window.bundle.segment_length_sigma_m),
       0.05, "0 101"},
      {"people.motion_sigma_m", "0.09", AIRDOS_MEMBER(window.bundle.motion_sigma_m), 0.09, "0 101"},
      {"people.motion_max_gap_s", "0.05", AIRDOS_MEMBER(window.bundle.motion_max_gap_s), 0.05,
       "-0.1 101"},
      {"people.learn_track_noise", "false", AIRDOS_MEMBER(window.learn_track_noise), 0, "2"},
      {"people.person_speed_m_s", "0.3", AIRDOS_MEMBER(window.bundle.person_speed_m_s), 0.3,
       "-0.1 1001"},
      {"people.person_acceleration_m_s2", "0.4",
       AIRDOS_MEMBER(window.bundle.person_acceleration_m_s2), 0.4, "0 10001"},
      {"people.free_rotation_sigma_rad",
       "0.7",
       AIRDOS_MEMBER(window.bundle.free_rotation_sigma_rad),
       0.7,
       "0 101",
       {"people.motion_form=se3_parts"}},
      {"people.eliminate_joint", "1.5", AIRDOS_MEMBER(window.bundle.eliminate_joint), 1.5,
       "0 1.1e9"},
      {"people.eliminate_rigidity", "1.4", AIRDOS_MEMBER(window.bundle.eliminate_rigidity), 1.4,
       "0 1.1e9"},
      {"people.eliminate_motion", "1.3", AIRDOS_MEMBER(window.bundle.eliminate_motion), 1.3,
       "0 1.1e9"},
      {"trust.min_static_observations", "0", AIRDOS_MEMBER(window.trust.min_static_observations), 0,
       "-1 100001"},
      {"trust.min_motion_factors", "99999", AIRDOS_MEMBER(window.trust.min_motion_factors), 99999,
       "0 1000001"},
      {"trust.max_eliminated_share",
       "0",
       AIRDOS_MEMBER(window.trust.max_eliminated_share),
       0,
       "-0.1 1.1",
       {"people.eliminate_motion=1.3"}},
      {"trust.max_relative_sigma", "0.01", AIRDOS_MEMBER(window.trust.max_relative_sigma), 0.01,
       "-0.1 1.1"},
      {"trust.max_shift_chi2", "1e-9", AIRDOS_MEMBER(window.trust.max_shift_chi2), 1e-9,
       "-0.1 1.1e12"},
  };
}

std::vector<Option> AllOptions() {
  std::vector<Option> all = WindowOptions();
  for (const Option& option : PeopleOptions()) all.push_back(option);
  return all;
}

OptimizerOptions Read(const Overrides& overrides) {
  ConfigReader config = ConfigReader::FromFile(kConfig);
  for (const std::string& text : overrides) config.Override(text);
  const OptimizerOptions options = ReadOptimizerOptions(&config);
  config.Finish();
  return options;
}

TEST(OptimizerOptions, EveryKeyOfTheFileIsTested) {
  std::set<std::string> in_file, tested;
  std::istringstream lines(ConfigReader::FromFile(kConfig).Resolved());
  for (std::string line; std::getline(lines, line);) in_file.insert(line.substr(0, line.find(':')));
  for (const Option& option : AllOptions()) tested.insert(option.key);
  EXPECT_EQ(tested, in_file);
}

TEST(OptimizerOptions, EachReachesItsOwnMember) {
  const std::vector<Option> all = AllOptions();
  const OptimizerOptions before = Read({});
  for (const Option& option : all) {
    const OptimizerOptions options = Read({option.key + "=" + option.value});
    for (const Option& other : all) {
      if (other.key == option.key) {
        EXPECT_EQ(other.member(options), option.expected) << option.key;
        EXPECT_NE(other.member(before), option.expected) << option.key << ": the test says nothing";
      } else {
        EXPECT_EQ(other.member(options), other.member(before)) << option.key << ", " << other.key;
      }
    }
  }
  EXPECT_TRUE(before.window.bundle.use_people);
  EXPECT_FALSE(Read({"people.mode=off"}).window.bundle.use_people);
  EXPECT_FALSE(Read({"people.mode=mask_only"}).window.bundle.use_people);
}

TEST(OptimizerOptions, WhatIsOutsideTheBoundsIsNamed) {
  for (const Option& option : AllOptions()) {
    std::istringstream values(option.outside);
    for (std::string value; values >> value;) {
      try {
        Read({option.key + "=" + value});
        ADD_FAILURE() << option.key << " takes " << value;
      } catch (const InputError& error) {
        EXPECT_NE(std::string(error.what()).find(option.key), std::string::npos) << error.what();
        EXPECT_NE(std::string(error.what()).find(value), std::string::npos) << error.what();
      }
    }
  }
}

/// Everything happens: outliers, far points, points and people who come and go, a static scene that
/// is weak and one that is gone.
SyntheticScene BusyScene() {
  SyntheticSceneOptions options;
  options.num_frames = 18;
  options.num_people = 4;
  options.max_static_per_frame = 25;
  options.speed_m_s = 3;
  options.joint_sigma_px = 0.5;
  options.outlier_ratio = 0.05;
  options.mono_ratio = 0.1;
  SyntheticScene scene = MakeSyntheticScene(options);
  for (FrameInput& input : scene.frames) {
    const std::int64_t k = input.id.value;
    input.motion_sigma_position_m = 0.03;
    input.motion_sigma_orientation_rad = 0.02;
    // Not in the first key frame, which remembers all its landmarks; then seen, and long not seen.
    const auto is_hidden = [k](const auto& feature) {
      return (k == 0 || (k >= 5 && k < 10)) && feature.id.value % 8 == 0;
    };
    input.features.erase(std::remove_if(input.features.begin(), input.features.end(), is_hidden),
                         input.features.end());
    const bool is_weak = k >= 10 && k % 8 >= 4;
    if (is_weak) input.features.resize(std::min<std::size_t>(input.features.size(), k % 3 * 4));
    for (auto human = input.humans.begin(); human != input.humans.end();) {
      const bool is_away = human->id.value == 1 && k >= 5 && k < 9;
      human = is_away ? input.humans.erase(human) : std::next(human);
    }
    if (!input.humans.empty() && k % 5 == 0) input.humans[0].joints[2].uvu_px.x() += 6;
  }
  return scene;
}

void Add(double value, std::vector<double>* numbers) { numbers->push_back(value); }

void Add(const Se3& pose, std::vector<double>* numbers) {
  for (int i = 0; i < 3; ++i) Add(pose.translation[i], numbers);
  for (int i = 0; i < 4; ++i) Add(pose.rotation.coeffs()[i], numbers);
}

/// All that the optimizer says of the scene.
std::vector<double> Result(const Overrides& overrides) {
  static const SyntheticScene scene = BusyScene();
  SlidingWindowOptimizer optimizer(Read(overrides).window, scene.camera);
  std::vector<double> numbers;
  for (const FrameInput& input : scene.frames) {
    const FrameResult result = optimizer.Process(input);
    Add(result.estimate.T_W_C, &numbers);
    Add(result.estimate.T_W_C_with_people, &numbers);
    Add(result.estimate.trusts_people, &numbers);
    Add(result.estimate.covariance.norm(), &numbers);
    for (const MapChanges::Landmark& landmark : result.changes.landmarks) {
      Add(static_cast<double>(landmark.id.value), &numbers);
      Add(landmark.p_W.norm(), &numbers);
    }
    for (const LandmarkId id : result.changes.removed)
      Add(-1.0 * static_cast<double>(id.value), &numbers);
    for (const HumanState& human : result.changes.humans) {
      for (const HumanState::JointPosition& joint : human.joints) Add(joint.p_W.norm(), &numbers);
      for (const auto& segment : human.segments) Add(segment.length_m, &numbers);
      for (const BundleProblem::PartMotion& motion : human.motions) Add(motion.motion_W, &numbers);
    }
  }
  return numbers;
}

TEST(OptimizerOptions, EachChangesTheResult) {
  std::map<Overrides, std::vector<double>> before;
  for (const Option& option : AllOptions()) {
    if (before.count(option.where) == 0) before[option.where] = Result(option.where);
    Overrides changed = option.where;
    changed.push_back(option.key + "=" + option.value);
    EXPECT_NE(Result(changed), before[option.where]) << option.key << " has no effect";
  }
}

}  // namespace
}  // namespace airdos
