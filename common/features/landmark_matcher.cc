#include "common/features/landmark_matcher.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <opencv2/features2d.hpp>

namespace airdos {
namespace {

cv::Mat DescriptorMatrix(std::size_t count) {
  return cv::Mat(static_cast<int>(count), 32, CV_8UC1);
}

void CopyDescriptor(const Descriptor& descriptor, cv::Mat* matrix, std::size_t row) {
  std::copy_n(reinterpret_cast<const uchar*>(descriptor.data()), sizeof(Descriptor),
              matrix->ptr<uchar>(static_cast<int>(row)));
}

}  // namespace

std::vector<VisibleLandmark> FindVisible(const LocalMap& map, const StereoCamera& camera,
                                         const Se3& T_W_C, int num_levels) {
  constexpr double kMinDepth_m = 0.3;
  constexpr double kMaxLevelChange =
      4.0;  // beyond it (a factor of two) the patch no longer looks the same
  const double log_factor = std::log(ImagePyramid::kScaleFactor);
  const Se3 T_C_W = T_W_C.inverse();
  std::vector<VisibleLandmark> visible;
  for (const auto& [id, landmark] : map.landmarks()) {
    VisibleLandmark candidate{id, &landmark, T_C_W * landmark.p_W};
    if (candidate.p_C.z() < kMinDepth_m) continue;
    candidate.uv_px = camera.Project(candidate.p_C);
    if (!camera.IsInImage(candidate.uv_px)) continue;
    const double depth_ratio = candidate.p_C.z() / landmark.p_C_reference.z();
    const double level_change = -std::log(depth_ratio) / log_factor;
    if (std::abs(level_change) > kMaxLevelChange) continue;
    candidate.level = std::clamp(
        landmark.reference_level + static_cast<int>(std::lround(level_change)), 0, num_levels - 1);
    const double scale_change =
        std::pow(ImagePyramid::kScaleFactor, candidate.level - landmark.reference_level);
    candidate.patch_step_px = scale_change * depth_ratio;
    visible.push_back(candidate);
  }
  return visible;
}

std::vector<LandmarkMatch> MatchByProjection(const std::vector<VisibleLandmark>& visible,
                                             const std::vector<Feature>& features,
                                             const FeatureGrid& grid,
                                             const ProjectionSearch& search) {
  std::map<int, LandmarkMatch> best_of_feature;
  for (const VisibleLandmark& candidate : visible) {
    const double radius_px =
        search.radius_px * std::pow(ImagePyramid::kScaleFactor, candidate.level);
    int best = 257;
    int second = 257;
    int best_feature = -1;
    grid.ForEachNear(candidate.uv_px, radius_px, [&](int index) {
      const Feature& feature = features[static_cast<std::size_t>(index)];
      if (std::abs(feature.level - candidate.level) > 1) return;
      const int distance = HammingDistance(candidate.landmark->descriptor, feature.descriptor);
      if (distance < best) {
        // The same corner at a neighbouring level is no rival.
        const bool is_same_corner =
            best_feature >= 0 &&
            (features[static_cast<std::size_t>(best_feature)].uv_px - feature.uv_px).norm() < 3;
        if (!is_same_corner) second = best;
        best = distance;
        best_feature = index;
      } else if (distance < second &&
                 (features[static_cast<std::size_t>(best_feature)].uv_px - feature.uv_px).norm() >=
                     3) {
        second = distance;
      }
    });
    if (best > search.max_hamming || best > search.max_ratio * second) continue;
    const auto [it, is_new] =
        best_of_feature.try_emplace(best_feature, LandmarkMatch{candidate.id, best_feature, best});
    if (!is_new && best < it->second.distance) it->second = {candidate.id, best_feature, best};
  }
  std::vector<LandmarkMatch> matches;
  for (const auto& [feature, match] : best_of_feature) matches.push_back(match);
  std::sort(matches.begin(), matches.end(),
            [](const LandmarkMatch& a, const LandmarkMatch& b) { return a.landmark < b.landmark; });
  return matches;
}

std::vector<LandmarkMatch> MatchByDescriptor(
    const std::vector<std::pair<LandmarkId, const LocalLandmark*>>& landmarks,
    const std::vector<Feature>& features, int max_hamming, double max_ratio) {
  if (landmarks.empty() || features.size() < 2) return {};
  cv::Mat query = DescriptorMatrix(landmarks.size());
  cv::Mat train = DescriptorMatrix(features.size());
  for (std::size_t i = 0; i < landmarks.size(); ++i)
    CopyDescriptor(landmarks[i].second->descriptor, &query, i);
  for (std::size_t i = 0; i < features.size(); ++i)
    CopyDescriptor(features[i].descriptor, &train, i);
  std::vector<std::vector<cv::DMatch>> nearest;
  cv::BFMatcher(cv::NORM_HAMMING).knnMatch(query, train, nearest, 2);
  std::map<int, LandmarkMatch> best_of_feature;
  for (std::size_t i = 0; i < nearest.size(); ++i) {
    const cv::DMatch& best = nearest[i][0];
    const cv::DMatch& second = nearest[i][1];
    const Eigen::Vector2d apart = features[static_cast<std::size_t>(best.trainIdx)].uv_px -
                                  features[static_cast<std::size_t>(second.trainIdx)].uv_px;
    const bool is_same_corner = apart.norm() < 3;  // at a neighbouring level: no rival
    if (best.distance > static_cast<float>(max_hamming)) continue;
    if (!is_same_corner && best.distance > max_ratio * second.distance) continue;
    const LandmarkMatch match{landmarks[i].first, best.trainIdx, static_cast<int>(best.distance)};
    const auto [it, is_new] = best_of_feature.try_emplace(best.trainIdx, match);
    if (!is_new && match.distance < it->second.distance) it->second = match;
  }
  std::vector<LandmarkMatch> matches;
  for (const auto& [feature, match] : best_of_feature) matches.push_back(match);
  return matches;
}

}  // namespace airdos
