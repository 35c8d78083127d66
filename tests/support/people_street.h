#ifndef AIRDOS_TESTS_SUPPORT_PEOPLE_STREET_H_
#define AIRDOS_TESTS_SUPPORT_PEOPLE_STREET_H_

#include <cstdint>

#include "common/optimization/bundle/bundle_adjuster.h"
#include "common/optimization/bundle/bundle_problem.h"

namespace airdos {

/// A street where everyone is seen by every frame, to measure how a solver scales.
struct PeopleStreetOptions {
  std::uint64_t seed = 1;
  int num_frames = 20;  ///< of the window
  int num_people = 30;
  int num_landmarks = 300;
  double step_s = 0.1;
  double sigma_px = 0.5;
  double joint_sigma_px = 1.0;
  double odometry_sigma_m = 0.01;  ///< per step and axis
  double odometry_sigma_rad = 0.002;
};

/// The window as a front end starts it: poses by odometry, points triangulated. Frame 0 is fixed.
BundleProblem MakePeopleStreet(const PeopleStreetOptions& options);

/// The window of one frame later: what is in both is as `solver` left it, frame 0 stays as a fixed
/// key frame for the landmarks; the new frame starts by odometry, its joints at the depth of the
/// frame before.
BundleProblem SlideWindow(const BundleOptions& solver, const PeopleStreetOptions& options);

}  // namespace airdos

#endif  // AIRDOS_TESTS_SUPPORT_PEOPLE_STREET_H_
