#ifndef AIRDOS_TESTS_SUPPORT_CROSSING_TRUTH_H_
#define AIRDOS_TESTS_SUPPORT_CROSSING_TRUTH_H_

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "common/geometry/se3.h"
#include "common/human/skeleton.h"

namespace airdos {

/// The ground truth of one person in one frame of a crossing sequence.
struct TruePerson {
  std::array<Eigen::Vector3d, kNumJoints> p_C;  ///< joints in the left camera
  int num_visible_left = 0;                     ///< of all 18 joints, those not hidden by others
  int num_visible_right = 0;
  std::array<bool, kNumJoints> is_plain{};  ///< whether the joint is not hidden in the left image
};

/// The ground truth of one frame.
struct TrueFrame {
  std::map<std::int64_t, TruePerson> people;  ///< keyed by identity
  std::vector<std::int64_t> identity_left;    ///< for each line of alphapose_0; -1 for nobody
};

/// Reads gt_tum_optical.txt, joints_gt.json.gz and track_id_alpha of a crossing sequence. For
/// evaluation only. Throws InputError.
std::vector<TrueFrame> ReadCrossingTruth(const std::string& folder);

}  // namespace airdos

#endif  // AIRDOS_TESTS_SUPPORT_CROSSING_TRUTH_H_
