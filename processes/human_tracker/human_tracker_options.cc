#include "processes/human_tracker/human_tracker_options.h"

#include "common/human/body_keypoints.h"

namespace airdos {
namespace {

// Keypoints and range mean the same to each step, so the file names them once.
void AddShared(HumanTrackerOptions* options, OptionTable* table) {
  PersonPairingOptions* matcher = &options->matcher;
  JointTriangulatorOptions* triangulator = &options->triangulator;
  HumanTrackOptions* track = &options->track;
  const auto noise = [&](double KeypointNoise::*member) -> std::vector<double*> {
    return {&(matcher->noise.*member), &(triangulator->noise.*member), &(track->noise.*member)};
  };
  table->AddSection("keypoints");
  table->AddShared(
      "keypoints.min_confidence",
      {&matcher->min_confidence, &triangulator->min_confidence, &track->min_confidence}, {0.001, 1},
      "0..1", "keypoints below it are ignored");
  table->AddShared("keypoints.sigma_min_px", noise(&KeypointNoise::min_px), {0.01, 100}, "px",
                   "least standard deviation of a keypoint");
  table->AddShared("keypoints.sigma_per_height", noise(&KeypointNoise::per_height), {0, 1},
                   "heights", "standard deviation of a keypoint of full_confidence");
  table->AddShared("keypoints.full_confidence", noise(&KeypointNoise::full_confidence), {0, 1},
                   "0..1", "from here on a joint counts as plainly seen");
  table->AddShared("keypoints.sigma_per_confidence", noise(&KeypointNoise::per_confidence),
                   {0, 100}, "",
                   "growth of the standard deviation with confidence lost: 1 + this * loss");
  table->AddShared("keypoints.sigma_max_factor", noise(&KeypointNoise::max_factor), {1, 100},
                   "times", "the most by which lost confidence raises it");
  table->AddSection("range");
  table->AddShared("range.min_depth_m", {&matcher->min_depth_m, &triangulator->min_depth_m},
                   {0.05, 1000}, "m", "nearer joints are dropped");
  table->AddShared("range.max_depth_m", {&matcher->max_depth_m, &triangulator->max_depth_m},
                   {0.05, 1000}, "m", "farther joints are dropped");
  table->RequireNotBelow("range.max_depth_m", "range.min_depth_m");
}

void AddPairing(PersonPairingOptions* matcher, OptionTable* table) {
  table->AddSection("pairing");
  table->Add("pairing.min_joints", &matcher->min_joints, {1, kNumJoints}, "joints",
             "both images must see at least this many of a person");
  table->Add("pairing.max_joint_squared_sigmas", &matcher->max_joint_squared_sigmas, {0.1, 1000},
             "squared sigmas", "a joint with a larger error counts as an outlier");
  table->Add("pairing.max_mean_squared_sigmas", &matcher->max_mean_squared_sigmas, {0.01, 1000},
             "squared sigmas", "mean error above which two detections are not one person");
  table->Add("pairing.body_extent_m", &matcher->body_extent_m, {0, 10}, "m",
             "standard deviation of the depth of a person's joints");
}

void AddJoints(JointTriangulatorOptions* joints, OptionTable* table) {
  table->AddSection("joints");
  table->Add("joints.max_row_error_sigmas", &joints->max_row_error_sigmas, {0.1, 1000}, "sigmas",
             "allowed between the rows in the two images");
  table->Add("joints.body_extent_m", &joints->body_extent_m, {0.01, 10}, "m",
             "standard deviation of the depth of a person's joints");
  table->Add("joints.max_extent_error_sigmas", &joints->max_extent_error_sigmas, {0.1, 1000},
             "sigmas", "allowed between a joint's disparity and the person's");
  table->Add("joints.max_limb_ratio", &joints->max_limb_ratio, {1, 100}, "times",
             "longest believable limb, relative to a grown person's");
  table->Add("joints.min_limb_ratio", &joints->min_limb_ratio, {0, 1}, "times",
             "shortest believable limb, relative to a grown person's");
  table->Add("joints.limb_sigmas", &joints->limb_sigmas, {0, 100}, "sigmas",
             "of noise, by which a limb may be off beyond these ratios");
  table->Add("joints.refine", &joints->is_refined, "measure disparities in the images as well");
  table->Add("joints.refined_sigma_px", &joints->refined_sigma_px, {0.01, 10}, "px",
             "standard deviation of a disparity measured in the images");
  table->Add("joints.surface_depth_m", &joints->surface_depth_m, {0, 0.5}, "m",
             "how far joints lie behind the clothes that are seen");
  table->Add("joints.min_refined_confidence", &joints->min_refined_confidence, {0, 1}, "0..1",
             "less plainly seen joints are not measured in the images");
  table->Add("joints.patch_per_height", &joints->refiner.patch_per_height, {0, 1}, "heights",
             "half the side of the patch that is compared");
  table->Add("joints.min_correlation", &joints->refiner.min_correlation, {0, 1}, "0..1",
             "of a patch and its partner");
}

void AddFlow(ImageFlowOptions* flow, OptionTable* table) {
  table->AddSection("flow");
  table->Add("flow.window_px", &flow->window_px, {3, 101}, "px",
             "side of the patch that is followed");
  table->Add("flow.num_levels", &flow->num_levels, {0, 8}, "",
             "pyramid levels above the full image");
  table->Add("flow.max_return_error_px", &flow->max_return_error_px, {0.01, 100}, "px",
             "allowed between a joint and where the way there and back ends");
}

void AddTracking(HumanTrackerOptions* options, OptionTable* table) {
  HumanTrackOptions* track = &options->track;
  table->AddSection("tracking");
  table->Add("tracking.max_squared_sigmas", &options->max_squared_sigmas, {0.01, 1e6},
             "squared sigmas", "error above which a detection is not the tracked person");
  table->Add("tracking.left_only_max_squared_sigmas", &options->left_only_max_squared_sigmas,
             {0.01, 1e6}, "squared sigmas", "the same for people whom only the left image has");
  table->Add("tracking.motion_sigma_per_height", &track->motion_sigma_per_height, {0.001, 10},
             "heights", "standard deviation of predicted joints");
  table->Add("tracking.motion_sigma_growth_per_height", &track->motion_sigma_growth_per_height,
             {0, 10}, "heights", "added for each frame without a detection");
  table->Add("tracking.max_motion_per_height", &track->max_motion_per_height, {0.001, 100},
             "heights", "farther from the prediction it is somebody else");
  table->Add("tracking.max_motion_growth_per_height", &track->max_motion_growth_per_height, {0, 10},
             "heights", "added for each frame without a detection");
  table->Add("tracking.depth_sigma", &track->depth_sigma, {0.001, 10}, "",
             "standard deviation of the relative change of depth from frame to frame");
  table->Add("tracking.appearance_sigma", &track->appearance_sigma, {0.001, 100}, "",
             "standard deviation of the difference of clothes (0..1)");
  table->Add("tracking.max_missed_frames", &options->max_missed_frames, {0, 10000}, "frames",
             "a track ends after this many without a detection");
  table->Add("tracking.min_seen", &options->min_seen_to_report, {1, 1000}, "frames",
             "a person must have been detected in this many to be reported");
  table->Add("tracking.min_joints", &options->min_joints, {1, kNumJoints}, "joints",
             "a person with fewer is not reported");
  table->Add("tracking.use_left_only", &options->use_left_only,
             "report known people whom only the left detections have");
  table->Add("tracking.max_carried_frames", &options->max_carried_frames, {0, 1000}, "frames",
             "a missed person is reported from optical flow for this long");
  table->Add("tracking.min_swap_gain_squared_sigmas", &options->min_swap_gain_squared_sigmas,
             {0, 1e6}, "squared sigmas", "exchanging left and right limbs must save this much");
  table->Add("tracking.min_doubtful_swap_gain_squared_sigmas",
             &options->min_doubtful_swap_gain_squared_sigmas, {0, 1e6}, "squared sigmas",
             "the same where the two detections disagree on sides");
  table->Add("tracking.use_shift_vote", &options->use_shift_vote,
             "let the people tell how far the camera turned between frames");
}

}  // namespace

OptionTable TableOf(HumanTrackerOptions* options) {
  OptionTable table("human_tracker",
                    "airdos-human-tracker: stereo keypoints and images -> people's joints in 3-D, "
                    "with identities. Distances are in metres in the left camera; heights are a "
                    "person's standing height in the image.");
  AddShared(options, &table);
  AddPairing(&options->matcher, &table);
  AddJoints(&options->triangulator, &table);
  AddFlow(&options->flow, &table);
  AddTracking(options, &table);
  table.SetRenamed({
      {"pairing.max_joint_cost", "pairing.max_joint_squared_sigmas"},
      {"pairing.gate", "pairing.max_mean_squared_sigmas"},
      {"joints.max_row_error", "joints.max_row_error_sigmas"},
      {"joints.max_extent_error", "joints.max_extent_error_sigmas"},
      {"tracking.gate", "tracking.max_squared_sigmas"},
      {"tracking.left_only_gate", "tracking.left_only_max_squared_sigmas"},
      {"tracking.motion_sigma", "tracking.motion_sigma_per_height"},
      {"tracking.motion_sigma_growth", "tracking.motion_sigma_growth_per_height"},
      {"tracking.max_motion", "tracking.max_motion_per_height"},
      {"tracking.max_motion_growth", "tracking.max_motion_growth_per_height"},
      {"tracking.min_swap_gain", "tracking.min_swap_gain_squared_sigmas"},
      {"tracking.min_swap_gain_doubtful", "tracking.min_doubtful_swap_gain_squared_sigmas"},
  });
  return table;
}

HumanTrackerOptions ReadHumanTrackerOptions(ConfigReader* config) {
  return ReadOptions<HumanTrackerOptions>(config);
}

}  // namespace airdos
