#include "common/features/landmark_judge.h"

namespace airdos {
namespace {

/// The 90th percentile.
double BestTenth(std::vector<double> values) {
  const auto it = values.end() - 1 - static_cast<std::ptrdiff_t>(values.size() / 10);
  std::nth_element(values.begin(), it, values.end());
  return *it;
}

}  // namespace

TrustField LandmarkJudge::Judge(const StereoCamera& camera, const Se3& T_W_C,
                                const std::vector<LandmarkId>& tried,
                                const std::set<LandmarkId>& agreed, LocalMap* map) {
  constexpr double kBaseGain = 0.005;  // averages over about 200 new landmarks: 2 or 3 frames
  constexpr double kMinDepth_m = 0.1;
  TrustField field(base_probability_);
  std::vector<double> probabilities;
  const Se3 T_C_W = T_W_C.inverse();
  for (const LandmarkId id : tried) {
    LocalLandmark& landmark = map->landmarks().at(id);
    const bool is_static = agreed.count(id) > 0;
    const bool is_first_time = ++landmark.num_expected == 2 && landmark.num_seen == 1;
    if (is_first_time) base_probability_ += kBaseGain * ((is_static ? 1 : 0) - base_probability_);
    if (is_static) {
      landmark.trust.Agree();
    } else {
      landmark.trust.Disagree();
    }
    probabilities.push_back(landmark.trust.static_probability());
    const Eigen::Vector3d p_C = T_C_W * landmark.p_W;
    if (p_C.z() > kMinDepth_m) field.Add(camera.Project(p_C), p_C.z(), is_static);
  }
  if (!probabilities.empty()) best_probability_ = BestTenth(std::move(probabilities));
  return field;
}

}  // namespace airdos
