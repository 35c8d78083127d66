#ifndef AIRDOS_COMMON_FEATURES_LANDMARK_JUDGE_H_
#define AIRDOS_COMMON_FEATURES_LANDMARK_JUDGE_H_

#include <algorithm>
#include <set>
#include <vector>

#include "common/features/landmark_trust.h"
#include "common/features/local_map.h"
#include "common/geometry/stereo_camera.h"

namespace airdos {

/// Learns from each frame which landmarks are static, without knowing what moves: a landmark that
/// is found again, frame after frame, where the camera's pose predicts it is trusted. One that is
/// not loses trust, and so do new landmarks next to it at the same depth.
class LandmarkJudge {
 public:
  /// `tried` are the landmarks searched for in a frame at T_W_C, `agreed` those among them that
  /// were found where they should be. Updates their trust and num_expected. Returns how far new
  /// landmarks of this frame can be trusted.
  TrustField Judge(const StereoCamera& camera, const Se3& T_W_C,
                   const std::vector<LandmarkId>& tried, const std::set<LandmarkId>& agreed,
                   LocalMap* map);

  /// Trust relative to that of the most trusted landmarks in view last time, 0..1. Where everything
  /// is in doubt, the least doubtful landmarks have to do.
  double RelativeTrust(const LandmarkTrust& trust) const {
    return std::min(1.0, trust.static_probability() / best_probability_);
  }

  /// For a neighbourhood about which nothing is known: the share of landmarks that were found again
  /// in the frame after the one that created them.
  TrustField Unknown() const { return TrustField(base_probability_); }

 private:
  static constexpr double kFirstProbability = 0.7;

  double base_probability_ = kFirstProbability;
  double best_probability_ = kFirstProbability;  // reached by a tenth of the landmarks
};

}  // namespace airdos

#endif  // AIRDOS_COMMON_FEATURES_LANDMARK_JUDGE_H_
