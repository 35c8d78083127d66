#ifndef AIRDOS_TESTS_SUPPORT_RANDOM_BUNDLE_H_
#define AIRDOS_TESTS_SUPPORT_RANDOM_BUNDLE_H_

#include <cstdint>

#include "common/optimization/bundle/bundle_adjuster.h"
#include "common/optimization/bundle/bundle_problem.h"

namespace airdos {

/// The composition of a random bundle adjustment problem.
struct RandomBundleOptions {
  std::uint64_t seed = 1;
  int num_frames = 8;
  int num_landmarks = 30;
  int num_people = 2;   ///< who walk
  int num_objects = 1;  ///< rigid, with six points, moving
  MotionForm person_motion = MotionForm::kVelocity;
  MotionForm object_motion = MotionForm::kSe3Track;
  bool has_point_measurements = false;  ///< in camera coordinates instead of pixels
  int num_fixed_frames = 1;             ///< the first frame, then arbitrary ones
  double fixed_landmarks = 0;           ///< share of the landmarks
  double gaps = 0;                      ///< share of missing sightings
  double missing_joints = 0;            ///< share of missing joints
  bool has_track_breaks = false;
  double mono = 0;      ///< share of landmark observations without a right image
  double outliers = 0;  ///< share of all observations
  bool has_accelerations = false;
  bool has_known_lengths = false;
};

/// A camera moving through a street; start values are off by a few centimetres.
BundleProblem MakeRandomBundle(const RandomBundleOptions& options);

}  // namespace airdos

#endif  // AIRDOS_TESTS_SUPPORT_RANDOM_BUNDLE_H_
