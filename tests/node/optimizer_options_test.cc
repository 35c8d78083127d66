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

// Every option of the file changes what the optimizer says. (That it reaches its own member and
// keeps its bounds: options_wiring_test.cc.)

namespace airdos {
namespace {

constexpr char kConfig[] = AIRDOS_SOURCE_DIR "/launch_scripts/config/optimizer.yaml";
using Overrides = std::vector<std::string>;

struct Change {
  std::string key;
  std::string value;     ///< another one than the file's
  Overrides where = {};  ///< options under which this one has an effect
};

std::vector<Change> AllOptions() {
  return {
      {"window.frames", "9"},
      {"window.max_fixed_key_frames", "1"},
      {"window.min_shared_landmarks", "37"},
      {"window.key_frame_max_shared", "0.95", {"window.key_frame_interval=1000"}},
      {"window.key_frame_interval", "2"},
      {"window.max_key_frames", "1"},
      {"window.forget_after_frames",
       "1",
       {"window.frames=3", "window.key_frame_interval=1000", "window.key_frame_max_shared=0",
        "output.publish_moved_m=1"}},
      {"window.min_disparity_px", "9"},
      {"window.max_rejections", "1"},
      {"solver.method", "ceres"},
      {"solver.max_iterations", "2"},
      {"solver.max_iterations_after_rejection", "1"},
      {"solver.function_tolerance", "0.1"},
      {"solver.huber_static_sigmas", "1.5"},
      {"solver.reject_static_sigmas", "2.5"},
      {"camera_motion.use_acceleration", "false"},
      {"camera_motion.sigma_factor", "0.2"},
      {"output.publish_moved_m", "0.02"},
      {"people.mode", "mask_only"},
      {"people.rigidity", "false"},
      {"people.motion", "false"},
      {"people.motion_form", "velocity_track"},
      {"people.window_frames", "5"},
      {"people.forget_after_frames", "2"},
      {"people.min_disparity_px", "25"},
      {"people.max_depth_m", "9"},
      {"people.huber_sigmas", "0.7"},
      {"people.rigidity_sigma_m", "0.03"},
      {"people.segment_length_sigma_m", "0.05"},
      {"people.motion_sigma_m", "0.09"},
      {"people.motion_max_gap_s", "0.05"},
      {"people.learn_track_noise", "false"},
      {"people.person_speed_m_s", "0.3"},
      {"people.person_acceleration_m_s2", "0.4"},
      {"people.free_rotation_sigma_rad", "0.7", {"people.motion_form=se3_parts"}},
      {"people.reject_joint_sigmas", "1.5"},
      {"people.reject_rigidity_sigmas", "1.4"},
      {"people.reject_motion_sigmas", "1.3"},
      {"trust.min_static_observations", "0"},
      {"trust.min_motion_factors", "99999"},
      {"trust.max_rejected_share", "0", {"people.reject_motion_sigmas=1.3"}},
      {"trust.max_relative_sigma", "0.01"},
      {"trust.max_shift_chi2", "1e-9"},
  };
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
  for (const Change& option : AllOptions()) tested.insert(option.key);
  EXPECT_EQ(tested, in_file);
}

/// Everything happens: outliers, far points, points and people who come and go, a static scene that
/// is weak and one that is gone.
SyntheticScene BusyScene() {
  SyntheticSceneOptions options;
  options.num_frames = 18;
  options.num_people = 2;
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
  for (const Change& option : AllOptions()) {
    if (before.count(option.where) == 0) before[option.where] = Result(option.where);
    Overrides changed = option.where;
    changed.push_back(option.key + "=" + option.value);
    EXPECT_NE(Result(changed), before[option.where]) << option.key << " has no effect";
  }
}

}  // namespace
}  // namespace airdos
