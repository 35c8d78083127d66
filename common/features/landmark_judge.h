#ifndef AIRDOS_COMMON_FEATURES_LANDMARK_JUDGE_H_
#define AIRDOS_COMMON_FEATURES_LANDMARK_JUDGE_H_

#include <algorithm>
#include <set>
#include <vector>

#include "common/features/landmark_trust.h"
#include "common/features/local_map.h"
#include "common/geometry/stereo_camera.h"

namespace airdos {

/// Learns from each frame which landmarks stay where they are. It needs no knowledge of what moves:
/// what was found again where the camera's pose says, frame after frame, is trusted; what was not,
/// and what appears beside it at the same depth, is not.
class LandmarkJudge {
 public:
  /// Notes for each landmark in `tried`, which were looked for in a frame at T_W_C, whether it was
  /// found where it should be (it is in `agreed`) in its trust and in num_expected. Returns how
  /// much new landmarks of this frame can be trusted.
  TrustField Judge(const StereoCamera& camera, const Se3& T_W_C,
                   const std::vector<LandmarkId>& tried, const std::set<LandmarkId>& agreed,
                   LocalMap* map);

  /// In proportion to the most trusted landmarks that could be seen last, 0..1: where everything is
  /// in doubt the least doubtful have to do.
  double RelativeTrust(const LandmarkTrust& trust) const {
    return std::min(1.0, trust.static_probability() / best_probability_);
  }

  /// Where nothing is known of the neighbourhood: the share of landmarks that were found again in
  /// the frame after the one that made them.
  TrustField Unknown() const { return TrustField(base_probability_); }

 private:
  static constexpr double kFirstProbability = 0.7;

  double base_probability_ = kFirstProbability;
  double best_probability_ = kFirstProbability;  // that a tenth of the landmarks reach
};

}  // namespace airdos

#endif  // AIRDOS_COMMON_FEATURES_LANDMARK_JUDGE_H_
