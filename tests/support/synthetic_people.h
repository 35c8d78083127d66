#ifndef AIRDOS_TESTS_SUPPORT_SYNTHETIC_PEOPLE_H_
#define AIRDOS_TESTS_SUPPORT_SYNTHETIC_PEOPLE_H_

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "common/geometry/stereo_camera.h"
#include "common/human/body_keypoints.h"

namespace airdos {

using Joints3d = std::array<Eigen::Vector3d, kNumJoints>;

inline const StereoCamera kTestCamera{640, 360, 770, 770, 320, 180, 0.25};

/// A walking person in C with the hips at `root`, seen from behind; `phase` in rad swings the
/// limbs, `scale` makes the person taller.
inline Joints3d WalkingPerson(const Eigen::Vector3d& root, double phase, double scale = 1) {
  const double swing = 0.18 * std::sin(phase);
  Joints3d joints = {{{0, -.72, 0},
                      {0, -.5, 0},
                      {.18, -.5, 0},
                      {.22, -.22, swing},
                      {.24, .02, 1.5 * swing},
                      {-.18, -.5, 0},
                      {-.22, -.22, -swing},
                      {-.24, .02, -1.5 * swing},
                      {.12, 0, 0},
                      {.12, .42, -swing},
                      {.12, .82, -1.5 * swing},
                      {-.12, 0, 0},
                      {-.12, .42, swing},
                      {-.12, .82, 1.5 * swing}}};
  for (Eigen::Vector3d& joint : joints) joint = root + scale * joint;
  return joints;
}

/// A detector's output, with the given noise, for a person in one image. Includes joints outside
/// the image.
inline BodyKeypoints Detect(const StereoCamera& camera, const Joints3d& joints, bool is_right,
                            double sigma_px, std::mt19937* random) {
  std::normal_distribution<double> noise(0, 1);
  BodyKeypoints person;
  for (std::size_t joint = 0; joint < person.size(); ++joint) {
    const Eigen::Vector3d uvu = camera.ProjectStereo(joints[joint]);
    person[joint].u_px = (is_right ? uvu[2] : uvu[0]) + sigma_px * noise(*random);
    person[joint].v_px = uvu[1] + sigma_px * noise(*random);
    person[joint].confidence = 0.9;
  }
  return person;
}

}  // namespace airdos

#endif  // AIRDOS_TESTS_SUPPORT_SYNTHETIC_PEOPLE_H_
