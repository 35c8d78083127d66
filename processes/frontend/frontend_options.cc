#include "processes/frontend/frontend_options.h"

namespace airdos {
namespace {

void AddInputs(FrontendOptions* options, OptionTable* table) {
  table->AddSection("masks");
  table->Add("masks.use", &options->use_masks,
             "leave out features on people (PERSON_MASK); false: the channel is not read");
  table->Add("masks.dilation_px", &options->mask_dilation_px, {0, 100}, "px",
             "border around people that is left out as well, because masks are ragged");
  table->AddSection("feedback");
  table->Add("feedback.lag_frames", &options->feedback_lag_frames, {0, 20}, "frames",
             "a frame starts once the optimizer has finished the frame this far back; 0: no "
             "feedback");
}

void AddFeatures(VisualOdometryOptions* odometry, OptionTable* table) {
  FeatureExtractorOptions* extractor = &odometry->extractor;
  table->AddSection("features");
  table->Add("features.num_levels", &extractor->num_levels, {1, 12}, "",
             "levels of the image pyramid, a factor of 1.2 apart");
  table->Add("features.fast_threshold", &extractor->fast_threshold, {1, 100}, "grey levels",
             "contrast of a corner; low, because crowded scenes leave only faint texture");
  table->Add("features.cell_size_px", &extractor->cell_size_px, {8, 256}, "px",
             "features are spread over cells of this size at each level");
  table->Add("features.max_per_cell", &extractor->max_features_per_cell, {1, 100}, "features",
             "at most this many in each cell");
}

void AddStereo(VisualOdometryOptions* odometry, OptionTable* table) {
  FeatureStereoMatcherOptions* stereo = &odometry->stereo;
  table->AddSection("stereo");
  table->Add("stereo.min_depth_m", &stereo->min_depth_m, {0.05, 100}, "m",
             "nothing nearer is matched");
  table->Add("stereo.min_disparity_px", &stereo->min_disparity_px, {0.01, 50}, "px",
             "with less disparity, the depth says nothing");
  table->Add("stereo.max_row_error_px", &stereo->max_row_error_px, {0.5, 10}, "px",
             "between the rows of a rectified pair, at the feature's level");
  table->Add("stereo.max_hamming_bits", &stereo->max_hamming_bits, {1, 256}, "bits",
             "descriptor distance allowed within a pair, of 256");
  table->Add("stereo.min_correlation", &stereo->min_correlation, {0, 1}, "0..1",
             "of the patch around the feature, left against right");
  table->Add("stereo.rich_observations", &odometry->rich_observations, {1, 100000}, "landmarks",
             "this many static ones are plenty: no second pose is tried, and the next frame takes "
             "only pairs of rich_min_correlation");
  table->Add("stereo.rich_min_correlation", &odometry->rich_min_correlation, {0, 1}, "0..1",
             "where there is plenty; doubtful pairs make distances too long");
}

void AddMap(LocalMapOptions* map, OptionTable* table) {
  table->AddSection("map");
  table->Add("map.max_landmarks", &map->max_landmarks, {100, 100000}, "landmarks",
             "at most this many are kept");
  table->Add("map.max_frames_unconfirmed", &map->max_frames_unconfirmed, {1, 1000}, "frames",
             "a landmark that was seen only once is dropped after this many");
  table->Add(
      "map.min_found_ratio", &map->min_found_ratio, {0, 1}, "0..1",
      "a landmark found in a smaller share of the frames in which it was expected is dropped");
}

void AddTracking(VisualOdometryOptions* odometry, OptionTable* table) {
  table->AddSection("tracking");
  table->Add("tracking.wide_radius_px", &odometry->wide_radius_px, {1, 500}, "px",
             "of the first search around the constant-velocity prediction; grows with the level");
  table->Add("tracking.wide_max_hamming_bits", &odometry->wide_max_hamming_bits, {1, 256}, "bits",
             "descriptor distance allowed in that search, of 256");
  table->Add("tracking.narrow_max_hamming_bits", &odometry->narrow_max_hamming_bits, {1, 256},
             "bits", "descriptor distance allowed in the searches close to the prediction");
  table->Add("tracking.min_inliers_tracking", &odometry->min_inliers_tracking, {3, 1000},
             "landmarks", "with fewer inliers the state is STATE_WEAK");
  table->Add("tracking.min_inliers_weak", &odometry->min_inliers_weak, {1, 1000}, "landmarks",
             "with fewer inliers the state is STATE_COASTING");
  table->Add("tracking.min_correlation", &odometry->min_correlation, {0, 1}, "0..1",
             "of a landmark's patch with the image");
  table->Add("tracking.aligned_sigma_px", &odometry->aligned_sigma_px, {0.01, 10}, "px",
             "standard deviation of a patch that was aligned, at level 0; grows with the level");
  table->Add("tracking.corner_sigma_px", &odometry->corner_sigma_px, {0.01, 10}, "px",
             "standard deviation of a corner whose patch could not be aligned");
  table->Add("tracking.max_observations", &odometry->max_observations, {3, 5000}, "landmarks",
             "at most this many are observed in a frame");
  table->Add("tracking.observation_cell_px", &odometry->observation_cell_px, {4, 256}, "px",
             "at most two observed landmarks in each cell of this size");
}

void AddMotion(CameraMotionFilterOptions* motion, OptionTable* table) {
  const Range range{1e-3, 1000};
  table->AddSection("motion",
                    "of the camera: constant velocity, with changes as large as the carrier "
                    "shows, within bounds");
  table->Add("motion.linear_start_m_s2", &motion->linear_start_m_s2, range, "m/s^2",
             "standard deviation per axis of the acceleration, until the carrier shows another");
  table->Add("motion.linear_floor_m_s2", &motion->linear_floor_m_s2, range, "m/s^2",
             "and then at least");
  table->Add("motion.linear_ceiling_m_s2", &motion->linear_ceiling_m_s2, range, "m/s^2",
             "and at most");
  table->Add("motion.angular_start_rad_s2", &motion->angular_start_rad_s2, range, "rad/s^2",
             "the same of the angular acceleration");
  table->Add("motion.angular_floor_rad_s2", &motion->angular_floor_rad_s2, range, "rad/s^2",
             "at least");
  table->Add("motion.angular_ceiling_rad_s2", &motion->angular_ceiling_rad_s2, range, "rad/s^2",
             "at most");
  table->RequireNotBelow("motion.linear_ceiling_m_s2", "motion.linear_floor_m_s2");
  table->RequireNotBelow("motion.angular_ceiling_rad_s2", "motion.angular_floor_rad_s2");
  table->Add("motion.initial_speed_m_s", &motion->initial_speed_m_s, range, "m/s",
             "standard deviation of the velocity before the first step");
  table->Add("motion.initial_turn_rad_s", &motion->initial_turn_rad_s, range, "rad/s",
             "standard deviation of the turning rate before the first step");
  table->Add("motion.memory_s", &motion->memory_s, {0.01, 1e6}, "s",
             "a velocity that nothing measures falls to a third in this time");
}

void AddPeople(FrontendOptions* options, OptionTable* table) {
  PeopleFilterOptions* people = &options->odometry.people;
  table->AddSection("people",
                    "in the pose of a frame (HUMAN_OBSERVATIONS); each person keeps a velocity "
                    "that changes at random");
  table->Add("people.use", &options->use_people,
             "false: neither that channel nor PERSON_KEYPOINTS_LEFT is read");
  table->Add("people.min_keypoint_confidence", &options->min_keypoint_confidence, {0, 1}, "0..1",
             "of joints that mark where people are in an image without a mask");
  table->Add("people.max_static", &options->odometry.max_static_for_people, {0, 10000}, "landmarks",
             "with this many static ones in a frame people have no say");
  table->Add("people.acceleration_m_s2", &people->acceleration_m_s2, {1e-3, 100}, "m/s^2",
             "standard deviation per axis of a person's acceleration, until the person shows "
             "another");
  table->Add("people.initial_speed_m_s", &people->initial_speed_m_s, {1e-3, 100}, "m/s",
             "standard deviation of a person's velocity when first seen");
  table->Add("people.wobble_m", &people->wobble_m, {1e-4, 10}, "m",
             "how far a joint moves against the rest of the body in 0.1 s");
  table->Add("people.max_joint_sigmas", &people->max_joint_sigmas, {0.1, 100}, "sigmas",
             "a joint further from its prediction is left out");
  table->Add("people.max_missed_frames", &people->max_missed_frames, {0, 1000}, "frames",
             "a person missed for longer is forgotten");
  table->Add("people.min_seen_frames", &people->min_seen_frames, {1, 1000}, "frames",
             "a person must have been seen in this many to have a say");
}

}  // namespace

OptionTable TableOf(FrontendOptions* options) {
  OptionTable table("frontend",
                    "airdos-frontend: static landmarks and camera pose from stereo images.");
  AddInputs(options, &table);
  AddFeatures(&options->odometry, &table);
  AddStereo(&options->odometry, &table);
  AddMap(&options->odometry.map, &table);
  AddTracking(&options->odometry, &table);
  AddMotion(&options->odometry.motion, &table);
  AddPeople(options, &table);
  return table;
}

FrontendOptions ReadFrontendOptions(ConfigReader* config) {
  return ReadOptions<FrontendOptions>(config);
}

}  // namespace airdos
