// Each key of each process's configuration file sets its own field of the options and no other one.
#include <gtest/gtest.h>

#include <functional>
#include <iomanip>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "common/config/config_reader.h"
#include "processes/frontend/frontend_node.h"
#include "processes/human_tracker/human_tracker_node.h"
#include "processes/optimizer/optimizer_options.h"

namespace airdos {
namespace {

/// A key, another value than the file has, and the fields that get it.
template <class Options>
struct Wire {
  std::string key;
  double value;
  std::vector<std::function<double(const Options&)>> fields;
};

ConfigReader FileOf(const std::string& process) {
  return ConfigReader::FromFile(AIRDOS_SOURCE_DIR "/launch_scripts/config/" + process + ".yaml");
}

std::set<std::string> KeysOf(const std::string& process) {
  std::istringstream lines(FileOf(process).Resolved());
  std::set<std::string> keys;
  for (std::string line; std::getline(lines, line);) keys.insert(line.substr(0, line.find(':')));
  return keys;
}

template <class Options>
std::vector<double> AllFields(const std::vector<Wire<Options>>& wires, const Options& options) {
  std::vector<double> values;
  for (const Wire<Options>& wire : wires) {
    for (const auto& field : wire.fields) values.push_back(field(options));
  }
  return values;
}

/// `text` is what stands for the value where it is no number.
template <class Options>
void ExpectWired(const std::string& process, Options (*read)(ConfigReader*),
                 const std::vector<Wire<Options>>& wires,
                 const std::map<std::string, std::string>& texts) {
  std::set<std::string> keys;
  ConfigReader plain = FileOf(process);
  const Options as_configured = read(&plain);
  const std::vector<double> before = AllFields(wires, as_configured);
  std::size_t first = 0;
  for (const Wire<Options>& wire : wires) {
    SCOPED_TRACE(wire.key);
    keys.insert(wire.key);
    std::ostringstream text;
    text << std::setprecision(17) << wire.value;
    ConfigReader config = FileOf(process);
    config.Override(wire.key + "=" + (texts.count(wire.key) > 0 ? texts.at(wire.key) : text.str()));
    const std::vector<double> after = AllFields(wires, read(&config));
    for (std::size_t i = 0; i < after.size(); ++i) {
      const bool is_own = i >= first && i < first + wire.fields.size();
      EXPECT_EQ(after[i], is_own ? wire.value : before[i]) << "field " << i;
      if (is_own) {
        EXPECT_NE(before[i], wire.value) << "the file has this value";
      }
    }
    first += wire.fields.size();
  }
  EXPECT_EQ(keys, KeysOf(process)) << "a key without a line in this test";
}

#define FIELD(Options, field) \
  [](const Options& o) -> double { return static_cast<double>(o.field); }

TEST(OptionsWiringTest, Frontend) {
  using O = FrontendOptions;
  using W = Wire<O>;
  const std::vector<W> wires = {
      W{"masks.use", 0, {FIELD(O, use_masks)}},
      W{"masks.dilation_px", 11, {FIELD(O, mask_dilation_px)}},
      W{"feedback.lag_frames", 7, {FIELD(O, feedback_lag)}},
      W{"features.num_levels", 5, {FIELD(O, odometry.extractor.num_levels)}},
      W{"features.fast_threshold", 13, {FIELD(O, odometry.extractor.fast_threshold)}},
      W{"features.cell_size_px", 37, {FIELD(O, odometry.extractor.cell_size_px)}},
      W{"features.max_per_cell", 9, {FIELD(O, odometry.extractor.max_features_per_cell)}},
      W{"stereo.min_depth_m", 0.625, {FIELD(O, odometry.stereo.min_depth_m)}},
      W{"stereo.min_disparity_px", 0.875, {FIELD(O, odometry.stereo.min_disparity_px)}},
      W{"stereo.max_row_error_px", 1.75, {FIELD(O, odometry.stereo.max_row_error_px)}},
      W{"stereo.max_hamming_bits", 71, {FIELD(O, odometry.stereo.max_hamming_bits)}},
      W{"stereo.min_correlation", 0.9375, {FIELD(O, odometry.stereo.min_correlation)}},
      W{"stereo.rich_observations", 151, {FIELD(O, odometry.rich_observations)}},
      W{"stereo.rich_min_correlation", 0.96875, {FIELD(O, odometry.rich_min_correlation)}},
      W{"map.max_landmarks", 6001, {FIELD(O, odometry.map.max_landmarks)}},
      W{"map.max_frames_unconfirmed", 17, {FIELD(O, odometry.map.max_frames_unconfirmed)}},
      W{"map.min_found_ratio", 0.1875, {FIELD(O, odometry.map.min_found_ratio)}},
      W{"tracking.wide_radius_px", 31, {FIELD(O, odometry.wide_radius_px)}},
      W{"tracking.wide_max_hamming_bits", 67, {FIELD(O, odometry.wide_max_hamming_bits)}},
      W{"tracking.narrow_max_hamming_bits", 93, {FIELD(O, odometry.narrow_max_hamming_bits)}},
      W{"tracking.min_inliers_tracking", 23, {FIELD(O, odometry.min_inliers_tracking)}},
      W{"tracking.min_inliers_weak", 3, {FIELD(O, odometry.min_inliers_weak)}},
      W{"tracking.min_correlation", 0.8125, {FIELD(O, odometry.min_correlation)}},
      W{"tracking.aligned_sigma_px", 0.21875, {FIELD(O, odometry.aligned_sigma_px)}},
      W{"tracking.corner_sigma_px", 0.75, {FIELD(O, odometry.corner_sigma_px)}},
      W{"tracking.max_observations", 301, {FIELD(O, odometry.max_observations)}},
      W{"tracking.observation_cell_px", 19, {FIELD(O, odometry.observation_cell_px)}},
      W{"motion.linear_start_m_s2", 5.5, {FIELD(O, odometry.motion.linear_start_m_s2)}},
      W{"motion.linear_floor_m_s2", 3.25, {FIELD(O, odometry.motion.linear_floor_m_s2)}},
      W{"motion.linear_ceiling_m_s2", 33, {FIELD(O, odometry.motion.linear_ceiling_m_s2)}},
      W{"motion.angular_start_rad_s2", 10.5, {FIELD(O, odometry.motion.angular_start_rad_s2)}},
      W{"motion.angular_floor_rad_s2", 3.5, {FIELD(O, odometry.motion.angular_floor_rad_s2)}},
      W{"motion.angular_ceiling_rad_s2", 53, {FIELD(O, odometry.motion.angular_ceiling_rad_s2)}},
      W{"motion.initial_speed_m_s", 2.25, {FIELD(O, odometry.motion.initial_speed_m_s)}},
      W{"motion.initial_turn_rad_s", 1.125, {FIELD(O, odometry.motion.initial_turn_rad_s)}},
      W{"motion.memory_s", 3.75, {FIELD(O, odometry.motion.memory_s)}},
      W{"people.use", 0, {FIELD(O, use_people)}},
      W{"people.min_keypoint_confidence", 0.125, {FIELD(O, min_keypoint_confidence)}},
      W{"people.max_static", 14, {FIELD(O, odometry.max_static_for_people)}},
      W{"people.acceleration_m_s2", 2.875, {FIELD(O, odometry.people.acceleration_m_s2)}},
      W{"people.initial_speed_m_s", 1.25, {FIELD(O, odometry.people.initial_speed_m_s)}},
      W{"people.wobble_m", 0.03125, {FIELD(O, odometry.people.wobble_m)}},
      W{"people.max_joint_sigmas", 4.25, {FIELD(O, odometry.people.max_joint_sigmas)}},
      W{"people.max_missed_frames", 6, {FIELD(O, odometry.people.max_missed_frames)}},
      W{"people.min_seen_frames", 2, {FIELD(O, odometry.people.min_seen_frames)}},
  };
  ExpectWired("frontend", ReadFrontendOptions, wires,
              {{"masks.use", "false"}, {"people.use", "false"}});
}

std::vector<Wire<HumanTrackerOptions>> JointsAndPairing() {
  using O = HumanTrackerOptions;
  return {
      {"keypoints.min_confidence",
       0.125,
       {FIELD(O, matcher.min_confidence), FIELD(O, triangulator.min_confidence),
        FIELD(O, track.min_confidence)}},
      {"keypoints.sigma_min_px",
       0.875,
       {FIELD(O, matcher.noise.min_px), FIELD(O, triangulator.noise.min_px),
        FIELD(O, track.noise.min_px)}},
      {"keypoints.sigma_per_height",
       0.0078125,
       {FIELD(O, matcher.noise.per_height), FIELD(O, triangulator.noise.per_height),
        FIELD(O, track.noise.per_height)}},
      {"keypoints.full_confidence",
       0.8125,
       {FIELD(O, matcher.noise.full_confidence), FIELD(O, triangulator.noise.full_confidence),
        FIELD(O, track.noise.full_confidence)}},
      {"keypoints.sigma_per_confidence",
       3.5,
       {FIELD(O, matcher.noise.per_confidence), FIELD(O, triangulator.noise.per_confidence),
        FIELD(O, track.noise.per_confidence)}},
      {"keypoints.sigma_max_factor",
       4.5,
       {FIELD(O, matcher.noise.max_factor), FIELD(O, triangulator.noise.max_factor),
        FIELD(O, track.noise.max_factor)}},
      {"range.min_depth_m",
       0.625,
       {FIELD(O, matcher.min_depth_m), FIELD(O, triangulator.min_depth_m)}},
      {"range.max_depth_m",
       41,
       {FIELD(O, matcher.max_depth_m), FIELD(O, triangulator.max_depth_m)}},
      {"pairing.min_joints", 5, {FIELD(O, matcher.min_joints)}},
      {"pairing.max_joint_squared_sigmas", 8.5, {FIELD(O, matcher.max_joint_squared_sigmas)}},
      {"pairing.max_mean_squared_sigmas", 3.25, {FIELD(O, matcher.max_mean_squared_sigmas)}},
      {"pairing.body_extent_m", 0.1875, {FIELD(O, matcher.body_extent_m)}},
      {"joints.max_row_error_sigmas", 4.25, {FIELD(O, triangulator.max_row_error_sigmas)}},
      {"joints.body_extent_m", 0.3125, {FIELD(O, triangulator.body_extent_m)}},
      {"joints.max_extent_error_sigmas", 3.625, {FIELD(O, triangulator.max_extent_error_sigmas)}},
      {"joints.max_limb_ratio", 1.625, {FIELD(O, triangulator.max_limb_ratio)}},
      {"joints.min_limb_ratio", 0.375, {FIELD(O, triangulator.min_limb_ratio)}},
      {"joints.limb_sigmas", 3.125, {FIELD(O, triangulator.limb_sigmas)}},
      {"joints.refine", 0, {FIELD(O, triangulator.is_refined)}},
      {"joints.refined_sigma_px", 0.4375, {FIELD(O, triangulator.refined_sigma_px)}},
      {"joints.surface_depth_m", 0.0625, {FIELD(O, triangulator.surface_depth_m)}},
      {"joints.min_refined_confidence", 0.46875, {FIELD(O, triangulator.min_refined_confidence)}},
      {"joints.patch_per_height", 0.03125, {FIELD(O, triangulator.refiner.patch_per_height)}},
      {"joints.min_correlation", 0.71875, {FIELD(O, triangulator.refiner.min_correlation)}},
  };
}

TEST(OptionsWiringTest, HumanTracker) {
  using O = HumanTrackerOptions;
  using W = Wire<O>;
  std::vector<W> wires = JointsAndPairing();
  const std::vector<W> tracking = {
      W{"flow.window_px", 15, {FIELD(O, flow.window_px)}},
      W{"flow.num_levels", 3, {FIELD(O, flow.num_levels)}},
      W{"flow.max_return_error_px", 1.5, {FIELD(O, flow.max_return_error_px)}},
      W{"tracking.max_squared_sigmas", 12.5, {FIELD(O, max_squared_sigmas)}},
      W{"tracking.left_only_max_squared_sigmas", 6.5, {FIELD(O, left_only_max_squared_sigmas)}},
      W{"tracking.motion_sigma_per_height", 0.140625, {FIELD(O, track.motion_sigma_per_height)}},
      W{"tracking.motion_sigma_growth_per_height",
        0.0234375,
        {FIELD(O, track.motion_sigma_growth_per_height)}},
      W{"tracking.max_motion_per_height", 0.65625, {FIELD(O, track.max_motion_per_height)}},
      W{"tracking.max_motion_growth_per_height",
        0.046875,
        {FIELD(O, track.max_motion_growth_per_height)}},
      W{"tracking.depth_sigma", 0.109375, {FIELD(O, track.depth_sigma)}},
      W{"tracking.appearance_sigma", 0.28125, {FIELD(O, track.appearance_sigma)}},
      W{"tracking.max_missed_frames", 11, {FIELD(O, max_missed_frames)}},
      W{"tracking.min_seen", 2, {FIELD(O, min_seen_to_report)}},
      W{"tracking.min_joints", 7, {FIELD(O, min_joints)}},
      W{"tracking.use_left_only", 0, {FIELD(O, use_left_only)}},
      W{"tracking.max_carried_frames", 9, {FIELD(O, max_carried_frames)}},
      W{"tracking.min_swap_gain_squared_sigmas", 21, {FIELD(O, min_swap_gain_squared_sigmas)}},
      W{"tracking.min_doubtful_swap_gain_squared_sigmas",
        2.75,
        {FIELD(O, min_doubtful_swap_gain_squared_sigmas)}},
      W{"tracking.use_shift_vote", 0, {FIELD(O, use_shift_vote)}},
  };
  wires.insert(wires.end(), tracking.begin(), tracking.end());
  ExpectWired("human_tracker", ReadHumanTrackerOptions, wires,
              {{"joints.refine", "false"},
               {"tracking.use_left_only", "false"},
               {"tracking.use_shift_vote", "false"}});
}

std::vector<Wire<OptimizerOptions>> PeopleOfTheOptimizer() {
  using O = OptimizerOptions;
  return {
      {"people.rigidity", 0, {FIELD(O, window.bundle.use_rigidity)}},
      {"people.motion", 0, {FIELD(O, window.bundle.use_motion)}},
      {"people.motion_form", 2, {FIELD(O, window.bundle.motion_form)}},
      {"people.window_frames", 7, {FIELD(O, window.people.window_frames)}},
      {"people.forget_after_frames", 101, {FIELD(O, window.people.forget_after_frames)}},
      {"people.min_disparity_px", 0.5625, {FIELD(O, window.people.min_disparity_px)}},
      {"people.max_depth_m", 61, {FIELD(O, window.people.max_depth_m)}},
      {"people.huber_sigmas", 2.125, {FIELD(O, window.bundle.huber_dynamic_sigmas)}},
      {"people.rigidity_sigma_m", 0.0234375, {FIELD(O, window.bundle.rigidity_sigma_m)}},
      {"people.segment_length_sigma_m",
       0.01171875,
       {FIELD(O, window.bundle.segment_length_sigma_m)}},
      {"people.motion_sigma_m", 0.0390625, {FIELD(O, window.bundle.motion_sigma_m)}},
      {"people.learn_track_noise", 0, {FIELD(O, window.learn_track_noise)}},
      {"people.motion_max_gap_s", 0.53125, {FIELD(O, window.bundle.motion_max_gap_s)}},
      {"people.person_acceleration_m_s2", 2.25, {FIELD(O, window.bundle.person_acceleration_m_s2)}},
      {"people.person_speed_m_s", 1.0625, {FIELD(O, window.bundle.person_speed_m_s)}},
      {"people.free_rotation_sigma_rad",
       0.09375,
       {FIELD(O, window.bundle.free_rotation_sigma_rad)}},
      {"people.reject_joint_sigmas", 4.125, {FIELD(O, window.bundle.reject_joint_sigmas)}},
      {"people.reject_rigidity_sigmas", 4.375, {FIELD(O, window.bundle.reject_rigidity_sigmas)}},
      {"people.reject_motion_sigmas", 4.625, {FIELD(O, window.bundle.reject_motion_sigmas)}},
      {"trust.min_static_observations", 16, {FIELD(O, window.trust.min_static_observations)}},
      {"trust.min_motion_factors", 27, {FIELD(O, window.trust.min_motion_factors)}},
      {"trust.max_rejected_share", 0.28125, {FIELD(O, window.trust.max_rejected_share)}},
      {"trust.max_relative_sigma", 0.84375, {FIELD(O, window.trust.max_relative_sigma)}},
      {"trust.max_shift_chi2", 23.5, {FIELD(O, window.trust.max_shift_chi2)}},
  };
}

TEST(OptionsWiringTest, Optimizer) {
  using O = OptimizerOptions;
  using W = Wire<O>;
  std::vector<W> wires = PeopleOfTheOptimizer();
  const std::vector<W> window = {
      W{"window.frames", 13, {FIELD(O, window.map.window_frames)}},
      W{"window.max_fixed_key_frames", 9, {FIELD(O, window.map.max_fixed_key_frames)}},
      W{"window.min_shared_landmarks", 18, {FIELD(O, window.map.min_shared_landmarks)}},
      W{"window.key_frame_max_shared", 0.625, {FIELD(O, window.map.key_frame_max_shared)}},
      W{"window.key_frame_interval", 6, {FIELD(O, window.map.key_frame_interval)}},
      W{"window.max_key_frames", 63, {FIELD(O, window.map.max_key_frames)}},
      W{"window.forget_after_frames", 203, {FIELD(O, window.map.forget_after_frames)}},
      W{"window.min_disparity_px", 0.46875, {FIELD(O, window.map.min_disparity_px)}},
      W{"window.max_rejections", 3, {FIELD(O, window.map.max_rejections)}},
      W{"solver.method", 1, {FIELD(O, window.bundle.solver)}},
      W{"solver.max_iterations", 10, {FIELD(O, window.bundle.max_iterations)}},
      W{"solver.max_iterations_after_rejection",
        5,
        {FIELD(O, window.bundle.max_iterations_after_rejection)}},
      W{"solver.function_tolerance", 0.00390625, {FIELD(O, window.bundle.function_tolerance)}},
      W{"solver.huber_static_sigmas", 2.375, {FIELD(O, window.bundle.huber_static_sigmas)}},
      W{"solver.reject_static_sigmas", 4.875, {FIELD(O, window.bundle.reject_static_sigmas)}},
      W{"camera_motion.use_acceleration", 0, {FIELD(O, window.camera_motion.use_acceleration)}},
      W{"camera_motion.sigma_factor", 0.6875, {FIELD(O, window.camera_motion.sigma_factor)}},
      W{"output.publish_moved_m", 0.001953125, {FIELD(O, window.publish_moved_m)}},
  };
  wires.insert(wires.end(), window.begin(), window.end());
  // Whether people are looked at follows from their mode: "on" is 2.
  wires.push_back(W{"people.mode", 0, {FIELD(O, people), FIELD(O, window.bundle.use_people)}});
  ExpectWired("optimizer", ReadOptimizerOptions, wires,
              {{"people.mode", "off"},
               {"people.rigidity", "false"},
               {"people.motion", "false"},
               {"people.motion_form", "se3_parts"},
               {"people.learn_track_noise", "false"},
               {"solver.method", "ceres"},
               {"camera_motion.use_acceleration", "false"}});
}

TEST(OptionsWiringTest, TheOptimizerLooksAtPeopleOnlyWhereTheyAreOn) {
  const std::pair<const char*, PeopleMode> modes[] = {
      {"off", PeopleMode::kOff}, {"mask_only", PeopleMode::kMaskOnly}, {"on", PeopleMode::kOn}};
  for (const auto& [text, mode] : modes) {
    ConfigReader config = FileOf("optimizer");
    config.Override(std::string("people.mode=") + text);
    const OptimizerOptions options = ReadOptimizerOptions(&config);
    EXPECT_EQ(options.people, mode);
    EXPECT_EQ(options.window.bundle.use_people, mode == PeopleMode::kOn);
  }
  const std::pair<const char*, MotionForm> forms[] = {
      {"velocity", MotionForm::kVelocity},
      {"velocity_track", MotionForm::kVelocityTrack},
      {"se3_parts", MotionForm::kSe3Parts}};
  for (const auto& [text, form] : forms) {
    ConfigReader config = FileOf("optimizer");
    config.Override(std::string("people.motion_form=") + text);
    EXPECT_EQ(ReadOptimizerOptions(&config).window.bundle.motion_form, form);
  }
}

}  // namespace
}  // namespace airdos
