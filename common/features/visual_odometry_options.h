#ifndef AIRDOS_COMMON_FEATURES_VISUAL_ODOMETRY_OPTIONS_H_
#define AIRDOS_COMMON_FEATURES_VISUAL_ODOMETRY_OPTIONS_H_

#include "common/features/camera_motion_filter.h"
#include "common/features/feature_extractor.h"
#include "common/features/feature_stereo_matcher.h"
#include "common/features/local_map.h"
#include "common/human/people_filter.h"

namespace airdos {

/// Of VisualOdometry and its parts.
struct VisualOdometryOptions {
  FeatureExtractorOptions extractor;
  FeatureStereoMatcherOptions stereo;
  /// This many static landmarks are plenty (about half of max_observations). Where the last frame
  /// held them there is a choice, and only better stereo matches are taken: with doubtful ones
  /// paths came out half a percent too long (KITTI). Where they agree with one pose no other is
  /// tried.
  int rich_observations = 150;
  double rich_min_correlation = 0.95;
  LocalMapOptions map;
  double wide_radius_px = 30;        ///< first search around the constant-velocity prediction
  int wide_max_hamming_bits = 64;    ///< bits
  int narrow_max_hamming_bits = 90;  ///< bits
  int min_inliers_tracking = 20;     ///< fewer: STATE_WEAK
  int min_inliers_weak = 1;          ///< fewer: STATE_COASTING
  double min_correlation = 0.8;      ///< of a landmark's patch with the image
  double aligned_sigma_px = 0.2;     ///< of an aligned patch at level 0; grows with the level
  double corner_sigma_px = 0.7;      ///< of a corner whose patch did not align
  int max_observations = 300;        ///< of landmarks a frame
  int observation_cell_px = 16;      ///< at most two observed landmarks in each cell of this size
  CameraMotionFilterOptions motion;
  PeopleFilterOptions people;
  int max_static_for_people = 15;  ///< with this many static landmarks people have no say
};

}  // namespace airdos

#endif  // AIRDOS_COMMON_FEATURES_VISUAL_ODOMETRY_OPTIONS_H_
