#include "common/features/landmark_matcher.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace airdos {
namespace {

/// The features with the most and the second most similar descriptor; of equals, the first.
struct NearestTwo {
  int best = -1;
  int second = -1;
  int best_distance = 257;  // bits
  int second_distance = 257;
};

// The loops over descriptors are compiled twice: for every processor, and for those with an
// instruction that counts bits. The results are the same.

[[gnu::always_inline]] inline int CountDifferentBits(const Descriptor& a, const Descriptor& b) {
  int distance = 0;
  for (std::size_t word = 0; word < a.size(); ++word)
    distance += __builtin_popcountll(a[word] ^ b[word]);
  return distance;
}

[[gnu::always_inline]] inline NearestTwo FindNearestTwoInline(
    const Descriptor& query, const std::vector<Descriptor>& descriptors) {
  NearestTwo nearest;
  for (std::size_t i = 0; i < descriptors.size(); ++i) {
    const int distance = CountDifferentBits(query, descriptors[i]);
    if (distance >= nearest.second_distance) continue;
    nearest.second = static_cast<int>(i);
    nearest.second_distance = distance;
    if (distance >= nearest.best_distance) continue;
    std::swap(nearest.second, nearest.best);
    std::swap(nearest.second_distance, nearest.best_distance);
  }
  return nearest;
}

/// Distances from the query to the features with the given indices.
[[gnu::always_inline]] inline void FindDistancesInline(const Descriptor& query,
                                                       const std::vector<Feature>& features,
                                                       const std::vector<int>& indices,
                                                       std::vector<int>* distances) {
  distances->resize(indices.size());
  for (std::size_t i = 0; i < indices.size(); ++i) {
    const Feature& feature = features[static_cast<std::size_t>(indices[i])];
    (*distances)[i] = CountDifferentBits(query, feature.descriptor);
  }
}

#if defined(__x86_64__)
[[gnu::target("popcnt")]] NearestTwo FindNearestTwoPopcnt(
    const Descriptor& query, const std::vector<Descriptor>& descriptors) {
  return FindNearestTwoInline(query, descriptors);
}
[[gnu::target("popcnt")]] void FindDistancesPopcnt(const Descriptor& query,
                                                   const std::vector<Feature>& features,
                                                   const std::vector<int>& indices,
                                                   std::vector<int>* distances) {
  FindDistancesInline(query, features, indices, distances);
}
bool HasPopcnt() { return __builtin_cpu_supports("popcnt") != 0; }
#endif

NearestTwo FindNearestTwo(const Descriptor& query, const std::vector<Descriptor>& descriptors) {
#if defined(__x86_64__)
  if (HasPopcnt()) return FindNearestTwoPopcnt(query, descriptors);
#endif
  return FindNearestTwoInline(query, descriptors);
}

void FindDistances(const Descriptor& query, const std::vector<Feature>& features,
                   const std::vector<int>& indices, std::vector<int>* distances) {
#if defined(__x86_64__)
  if (HasPopcnt()) return FindDistancesPopcnt(query, features, indices, distances);
#endif
  FindDistancesInline(query, features, indices, distances);
}

}  // namespace

std::vector<VisibleLandmark> FindVisible(const LocalMap& map, const StereoCamera& camera,
                                         const Se3& T_W_C, int num_levels) {
  constexpr double kMinDepth_m = 0.3;
  constexpr double kMaxLevelChange =
      4.0;  // beyond a factor of two the patch no longer looks the same
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
  std::vector<int> near;
  std::vector<int> distances;
  std::map<int, LandmarkMatch> best_of_feature;
  for (const VisibleLandmark& candidate : visible) {
    const double radius_px =
        search.radius_px * std::pow(ImagePyramid::kScaleFactor, candidate.level);
    int best = 257;
    int second = 257;
    int best_feature = -1;
    near.clear();
    grid.ForEachNear(candidate.uv_px, radius_px, {candidate.level - 1, candidate.level + 1},
                     [&near](int index) { near.push_back(index); });
    FindDistances(candidate.landmark->descriptor, features, near, &distances);
    for (std::size_t i = 0; i < near.size(); ++i) {
      const int index = near[i];
      const int distance = distances[i];
      const Feature& feature = features[static_cast<std::size_t>(index)];
      if (distance < best) {
        // The same corner on a neighbouring level is not a rival.
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
    }
    if (best > search.max_hamming_bits || best > search.max_ratio * second) continue;
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
    const std::vector<Feature>& features, int max_hamming_bits, double max_ratio) {
  if (landmarks.empty() || features.size() < 2) return {};
  std::vector<Descriptor> descriptors;  // contiguous: every landmark reads them all
  descriptors.reserve(features.size());
  for (const Feature& feature : features) descriptors.push_back(feature.descriptor);
  std::map<int, LandmarkMatch> best_of_feature;
  for (const auto& [id, landmark] : landmarks) {
    const NearestTwo nearest = FindNearestTwo(landmark->descriptor, descriptors);
    if (nearest.best_distance > max_hamming_bits) continue;
    const Eigen::Vector2d apart = features[static_cast<std::size_t>(nearest.best)].uv_px -
                                  features[static_cast<std::size_t>(nearest.second)].uv_px;
    const bool is_same_corner = apart.norm() < 3;  // on a neighbouring level: not a rival
    if (!is_same_corner && nearest.best_distance > max_ratio * nearest.second_distance) continue;
    const LandmarkMatch match{id, nearest.best, nearest.best_distance};
    const auto [it, is_new] = best_of_feature.try_emplace(nearest.best, match);
    if (!is_new && match.distance < it->second.distance) it->second = match;
  }
  std::vector<LandmarkMatch> matches;
  for (const auto& [feature, match] : best_of_feature) matches.push_back(match);
  return matches;
}

}  // namespace airdos
