#include "processes/human_tracker/human_tracker_node.h"

namespace airdos {
namespace {

// Keypoints and range mean the same to each step, so the file names them once.
void ReadShared(ConfigReader* config, HumanTrackerOptions* options) {
  KeypointNoise noise;
  double min_confidence = 0;
  config->Read("keypoints.min_confidence", &min_confidence, 0.001, 1);
  config->Read("keypoints.sigma_min_px", &noise.min_px, 0.01, 100);
  config->Read("keypoints.sigma_per_height", &noise.per_height, 0, 1);
  config->Read("keypoints.full_confidence", &noise.full_confidence, 0, 1);
  config->Read("keypoints.sigma_per_confidence", &noise.per_confidence, 0, 100);
  config->Read("keypoints.sigma_max_factor", &noise.max_factor, 1, 100);
  options->matcher.noise = options->triangulator.noise = options->track.noise = noise;
  options->matcher.min_confidence = min_confidence;
  options->triangulator.min_confidence = min_confidence;
  options->track.min_confidence = min_confidence;
  config->Read("range.min_depth_m", &options->matcher.min_depth_m, 0.05, 1000);
  config->Read("range.max_depth_m", &options->matcher.max_depth_m, options->matcher.min_depth_m,
               1000);
  options->triangulator.min_depth_m = options->matcher.min_depth_m;
  options->triangulator.max_depth_m = options->matcher.max_depth_m;
}

void ReadMatcher(ConfigReader* config, PersonPairingOptions* matcher) {
  config->Read("pairing.min_joints", &matcher->min_joints, 1, kNumJoints);
  config->Read("pairing.max_joint_cost", &matcher->max_joint_cost, 0.1, 1000);
  config->Read("pairing.gate", &matcher->gate, 0.01, 1000);
  config->Read("pairing.body_extent_m", &matcher->body_extent_m, 0, 10);
}

void ReadTriangulator(ConfigReader* config, JointTriangulatorOptions* triangulator) {
  config->Read("joints.max_row_error", &triangulator->max_row_error, 0.1, 1000);
  config->Read("joints.body_extent_m", &triangulator->body_extent_m, 0.01, 10);
  config->Read("joints.max_extent_error", &triangulator->max_extent_error, 0.1, 1000);
  config->Read("joints.max_limb_ratio", &triangulator->max_limb_ratio, 1, 100);
  config->Read("joints.min_limb_ratio", &triangulator->min_limb_ratio, 0, 1);
  config->Read("joints.limb_sigmas", &triangulator->limb_sigmas, 0, 100);
  config->Read("joints.refine", &triangulator->is_refined);
  config->Read("joints.refined_sigma_px", &triangulator->refined_sigma_px, 0.01, 10);
  config->Read("joints.surface_depth_m", &triangulator->surface_depth_m, 0, 0.5);
  config->Read("joints.min_refined_confidence", &triangulator->min_refined_confidence, 0, 1);
  config->Read("joints.patch_per_height", &triangulator->refiner.patch_per_height, 0, 1);
  config->Read("joints.min_correlation", &triangulator->refiner.min_correlation, 0, 1);
}

void ReadTracking(ConfigReader* config, HumanTrackerOptions* options) {
  HumanTrackOptions* track = &options->track;
  config->Read("tracking.gate", &options->gate, 0.01, 1e6);
  config->Read("tracking.left_only_gate", &options->left_only_gate, 0.01, 1e6);
  config->Read("tracking.motion_sigma", &track->motion_sigma, 0.001, 10);
  config->Read("tracking.motion_sigma_growth", &track->motion_sigma_growth, 0, 10);
  config->Read("tracking.max_motion", &track->max_motion, 0.001, 100);
  config->Read("tracking.max_motion_growth", &track->max_motion_growth, 0, 10);
  config->Read("tracking.depth_sigma", &track->depth_sigma, 0.001, 10);
  config->Read("tracking.appearance_sigma", &track->appearance_sigma, 0.001, 100);
  config->Read("tracking.max_missed_frames", &options->max_missed_frames, 0, 10000);
  config->Read("tracking.min_seen", &options->min_seen_to_report, 1, 1000);
  config->Read("tracking.min_joints", &options->min_joints, 1, kNumJoints);
  config->Read("tracking.use_left_only", &options->use_left_only);
  config->Read("tracking.max_carried_frames", &options->max_carried_frames, 0, 1000);
  config->Read("tracking.min_swap_gain", &options->min_swap_gain, 0, 1e6);
  config->Read("tracking.min_swap_gain_doubtful", &options->min_swap_gain_doubtful, 0, 1e6);
  config->Read("tracking.use_shift_vote", &options->use_shift_vote);
}

}  // namespace

HumanTrackerOptions ReadHumanTrackerOptions(ConfigReader* config) {
  HumanTrackerOptions options;
  ReadShared(config, &options);
  ReadMatcher(config, &options.matcher);
  ReadTriangulator(config, &options.triangulator);
  config->Read("flow.window_px", &options.flow.window_px, 3, 101);
  config->Read("flow.num_levels", &options.flow.num_levels, 0, 8);
  config->Read("flow.max_return_error_px", &options.flow.max_return_error_px, 0.01, 100);
  ReadTracking(config, &options);
  return options;
}

std::unique_ptr<Node> MakeHumanTrackerNode(ConfigReader* config) {
  return std::make_unique<HumanTrackerNode>(ReadHumanTrackerOptions(config));
}

}  // namespace airdos
