// VisualOdometry: how landmarks are seen, kept and made.
#include <algorithm>
#include <cmath>
#include <map>

#include "common/features/cell_counter.h"
#include "common/features/patch.h"
#include "common/features/visual_odometry_view.h"

namespace airdos {
namespace {

constexpr int kMaxPerCell = 2;       // observed landmarks
constexpr int kMaxTriedPerCell = 4;  // landmarks or corners that are looked for to get there

bool IsMasked(const cv::Mat& mask, const Eigen::Vector2d& uv_px) {
  if (mask.empty()) return false;
  const int u = std::clamp(static_cast<int>(std::lround(uv_px.x())), 0, mask.cols - 1);
  const int v = std::clamp(static_cast<int>(std::lround(uv_px.y())), 0, mask.rows - 1);
  return mask.at<uchar>(v, u) != 0;
}

}  // namespace

std::vector<LandmarkSighting> VisualOdometry::Sight(const View& view, const Hypothesis& hypothesis,
                                                    std::vector<LandmarkId>* tried) const {
  struct Candidate {
    VisibleLandmark visible;
    const Feature* feature;
  };
  std::map<LandmarkId, const Feature*> feature_of;
  for (const LandmarkMatch& match : hypothesis.matches) {
    feature_of[match.landmark] = &view.left_features[static_cast<std::size_t>(match.feature)];
  }
  std::vector<Candidate> candidates;
  for (const VisibleLandmark& visible :
       FindVisible(map_, view.camera, hypothesis.T_W_C, view.left->num_levels())) {
    if (IsMasked(view.images.mask, visible.uv_px)) continue;
    const auto match = feature_of.find(visible.id);
    candidates.push_back({visible, match == feature_of.end() ? nullptr : match->second});
  }
  // Where many landmarks crowd, a few are enough: first those that were matched, then the longest
  // known.
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const Candidate& a, const Candidate& b) {
                     if ((a.feature != nullptr) != (b.feature != nullptr))
                       return a.feature != nullptr;
                     return a.visible.landmark->num_seen > b.visible.landmark->num_seen;
                   });
  CellCounter cells(options_.observation_cell_px);
  std::vector<LandmarkSighting> sightings;
  for (const Candidate& candidate : candidates) {
    if (!cells.Take(candidate.visible.uv_px, kMaxTriedPerCell)) continue;
    // Of a pose that nothing supports it cannot be said what should be in view.
    if (hypothesis.num_inliers >= options_.min_inliers_weak) tried->push_back(candidate.visible.id);
    if (const auto sighting = SightOne(view, candidate.visible, candidate.feature))
      sightings.push_back(*sighting);
  }
  std::sort(sightings.begin(), sightings.end(),
            [](const auto& a, const auto& b) { return a.id < b.id; });
  return sightings;
}

std::optional<LandmarkSighting> VisualOdometry::SightOne(const View& view,
                                                         const VisibleLandmark& visible,
                                                         const Feature* feature) const {
  constexpr double kMaxShift_px = 4;       // of the level
  constexpr double kMaxRightShift_px = 3;  // of the level
  const LocalLandmark& landmark = *visible.landmark;
  const int level = visible.level;
  LandmarkSighting sighting;
  sighting.id = visible.id;
  Eigen::Vector2d uv_px = feature != nullptr ? feature->uv_px : visible.uv_px;
  const ImagePyramid& reference = *landmark.reference_image;
  const Eigen::Vector2d reference_px(
      reference.ToLevel(landmark.reference_uv_px.x(), landmark.reference_level),
      reference.ToLevel(landmark.reference_uv_px.y(), landmark.reference_level));
  const std::optional<Patch> patch =
      Patch::Sample(reference.level(landmark.reference_level), reference_px, visible.patch_step_px);
  std::optional<Patch::Alignment> alignment;
  if (patch) {
    const Eigen::Vector2d start(view.left->ToLevel(uv_px.x(), level),
                                view.left->ToLevel(uv_px.y(), level));
    alignment = patch->Align(view.left->level(level), start, kMaxShift_px, false);
  }
  if (alignment && alignment->correlation >= options_.min_correlation) {
    uv_px = {view.left->FromLevel(alignment->centre_px.x(), level),
             view.left->FromLevel(alignment->centre_px.y(), level)};
    sighting.sigma_px = options_.aligned_sigma_px * view.left->scale(level);
  } else if (feature != nullptr) {
    sighting.sigma_px = options_.corner_sigma_px * view.left->scale(feature->level);
  } else {
    return std::nullopt;
  }
  if (IsMasked(view.images.mask, uv_px)) return std::nullopt;
  const double u_right_guess =
      uv_px.x() - view.camera.fx_px * view.camera.baseline_m / visible.p_C.z();
  const auto u_right_px = view.stereo->Refine(uv_px, level, u_right_guess, kMaxRightShift_px);
  sighting.has_right = u_right_px.has_value();
  sighting.uvu_px = {uv_px.x(), uv_px.y(), u_right_px.value_or(0)};
  return sighting;
}

std::vector<LandmarkSighting> VisualOdometry::KeepSpread(
    std::vector<LandmarkSighting> sightings) const {
  // The longest known first: they tie the new frames to the old ones.
  std::stable_sort(sightings.begin(), sightings.end(), [this](const auto& a, const auto& b) {
    return map_.landmarks().at(a.id).num_seen > map_.landmarks().at(b.id).num_seen;
  });
  CellCounter cells(options_.observation_cell_px);
  std::vector<LandmarkSighting> kept;
  for (const LandmarkSighting& sighting : sightings) {
    if (kept.size() >= static_cast<std::size_t>(options_.max_observations)) break;
    if (cells.Take(sighting.uvu_px.head<2>(), kMaxPerCell)) kept.push_back(sighting);
  }
  std::sort(kept.begin(), kept.end(), [](const auto& a, const auto& b) { return a.id < b.id; });
  return kept;
}

void VisualOdometry::UpdateLandmarks(const View& view, const Se3& T_W_C,
                                     const std::vector<LandmarkSighting>& sightings) {
  constexpr double kMinDepthRatio = 0.85;
  constexpr double kMaxDepthRatio = 1.18;
  const Se3 T_C_W = T_W_C.inverse();
  for (const LandmarkSighting& sighting : sightings) {
    LocalLandmark& landmark = map_.landmarks().at(sighting.id);
    landmark.last_seen = view.images.id;
    ++landmark.num_seen;
    const Eigen::Vector3d p_C = T_C_W * landmark.p_W;
    const double depth_ratio = p_C.z() / landmark.p_C_reference.z();
    if (depth_ratio > kMinDepthRatio && depth_ratio < kMaxDepthRatio) continue;
    // It looks too different by now: from here on it is known by how it looks in this frame.
    const double level_change = -std::log(depth_ratio) / std::log(ImagePyramid::kScaleFactor);
    landmark.reference_level =
        std::clamp(landmark.reference_level + static_cast<int>(std::lround(level_change)), 0,
                   view.left->num_levels() - 1);
    landmark.reference_frame = view.images.id;
    landmark.reference_image = view.left;
    landmark.reference_uv_px = sighting.uvu_px.head<2>();
    landmark.p_C_reference = p_C;
  }
}

void VisualOdometry::CreateLandmarks(const View& view, const Se3& T_W_C, const TrustField& field,
                                     std::vector<LandmarkSighting>* sightings) {
  CellCounter cells(options_.observation_cell_px);
  for (const LandmarkSighting& sighting : *sightings)
    cells.Take(sighting.uvu_px.head<2>(), kMaxPerCell);
  std::vector<const Feature*> by_response;
  for (const Feature& feature : view.left_features) by_response.push_back(&feature);
  std::stable_sort(by_response.begin(), by_response.end(),
                   [](const Feature* a, const Feature* b) { return a->response > b->response; });
  CellCounter tried(options_.observation_cell_px);
  for (const Feature* feature : by_response) {
    if (sightings->size() >= static_cast<std::size_t>(options_.max_observations)) return;
    if (cells.IsFull(feature->uv_px, kMaxPerCell) || !tried.Take(feature->uv_px, kMaxTriedPerCell))
      continue;
    const std::optional<double> u_right_px = view.stereo->Match(*feature);
    if (!u_right_px) continue;
    const auto p_C = view.camera.Triangulate(feature->uv_px.x(), feature->uv_px.y(), *u_right_px);
    if (!p_C) continue;
    cells.Take(feature->uv_px, kMaxPerCell);
    LocalLandmark landmark;
    landmark.p_W = T_W_C * *p_C;
    landmark.created_covariance_W = CreatedCovariance(
        view.camera, T_W_C, *p_C, options_.aligned_sigma_px * view.left->scale(feature->level));
    landmark.reference_frame = view.images.id;
    landmark.p_C_reference = *p_C;
    landmark.reference_image = view.left;
    landmark.reference_uv_px = feature->uv_px;
    landmark.reference_level = feature->level;
    landmark.descriptor = feature->descriptor;
    landmark.trust = LandmarkTrust(field.At(feature->uv_px, p_C->z()));
    landmark.last_seen = view.images.id;
    landmark.num_seen = 1;
    landmark.num_expected = 1;
    const LandmarkId id = map_.Add(std::move(landmark));
    sightings->push_back({id,
                          {feature->uv_px.x(), feature->uv_px.y(), *u_right_px},
                          true,
                          options_.aligned_sigma_px * view.left->scale(feature->level)});
  }
}

Eigen::Matrix3d VisualOdometry::CreatedCovariance(const StereoCamera& camera, const Se3& T_W_C,
                                                  const Eigen::Vector3d& p_C,
                                                  double sigma_px) const {
  Eigen::Matrix<double, 3, 6> J;  // of the point in C by the tangent of the pose
  J << Eigen::Matrix3d::Identity(), -Skew(p_C);
  const Eigen::Matrix3d R_W_C = T_W_C.rotation.toRotationMatrix();
  return R_W_C *
         (camera.TriangulationCovariance(p_C, sigma_px) +
          J * motion_.pose_covariance() * J.transpose()) *
         R_W_C.transpose();
}

}  // namespace airdos
