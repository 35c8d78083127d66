#ifndef AIRDOS_TESTS_SUPPORT_PEOPLE_STREET_H_
#define AIRDOS_TESTS_SUPPORT_PEOPLE_STREET_H_

#include <cstdint>

#include "common/optimization/bundle/bundle_adjuster.h"
#include "common/optimization/bundle/bundle_problem.h"

namespace airdos {

/// A street in which everyone is visible in every frame, to measure how a solver scales.
struct PeopleStreetOptions {
  std::uint64_t seed = 1;
  int num_frames = 20;  ///< in the window
  int num_people = 30;
  int num_landmarks = 300;
  double step_s = 0.1;
  double sigma_px = 0.5;
  double joint_sigma_px = 1.0;
  double odometry_sigma_m = 0.01;  ///< per step and axis
  double odometry_sigma_rad = 0.002;
};

/// The window as started by a frontend: poses from odometry, points triangulated. Frame 0 is fixed.
BundleProblem MakePeopleStreet(const PeopleStreetOptions& options);

/// The window one frame later: what both windows contain is as left by `solver`, and frame 0
/// remains as a fixed key frame for the landmarks. The new frame starts from odometry, its joints
/// at their depth in the previous frame.
BundleProblem SlideWindow(const BundleOptions& solver, const PeopleStreetOptions& options);

}  // namespace airdos

#endif  // AIRDOS_TESTS_SUPPORT_PEOPLE_STREET_H_
