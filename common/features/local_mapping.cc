#include "common/features/local_mapping.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "common/features/cell_counter.h"

namespace airdos {
namespace {

/// With this frame as its reference; covariance and trust are left to the caller.
LocalLandmark MakeLandmark(const StereoFrame& frame, const Feature& feature, const Se3& T_W_C,
                           const Eigen::Vector3d& p_C) {
  LocalLandmark landmark;
  landmark.p_W = T_W_C * p_C;
  landmark.reference_frame = frame.id();
  landmark.p_C_reference = p_C;
  landmark.reference_image = frame.left();
  landmark.reference_uv_px = feature.uv_px;
  landmark.reference_level = feature.level;
  landmark.descriptor = feature.descriptor;
  landmark.last_seen = frame.id();
  landmark.num_seen = 1;
  landmark.num_expected = 1;
  return landmark;
}

std::vector<const Feature*> StrongestFirst(const std::vector<Feature>& features) {
  std::vector<const Feature*> by_response;
  for (const Feature& feature : features) by_response.push_back(&feature);
  std::stable_sort(by_response.begin(), by_response.end(),
                   [](const Feature* a, const Feature* b) { return a->response > b->response; });
  return by_response;
}

}  // namespace

void UpdateLandmarks(const StereoFrame& frame, const Se3& T_W_C,
                     const std::vector<LandmarkSighting>& sightings, LocalMap* map) {
  constexpr double kMinDepthRatio = 0.85;
  constexpr double kMaxDepthRatio = 1.18;
  const Se3 T_C_W = T_W_C.inverse();
  for (const LandmarkSighting& sighting : sightings) {
    LocalLandmark& landmark = map->landmarks().at(sighting.id);
    landmark.last_seen = frame.id();
    ++landmark.num_seen;
    const Eigen::Vector3d p_C = T_C_W * landmark.p_W;
    const double depth_ratio = p_C.z() / landmark.p_C_reference.z();
    if (depth_ratio > kMinDepthRatio && depth_ratio < kMaxDepthRatio) continue;
    const double level_change = -std::log(depth_ratio) / std::log(ImagePyramid::kScaleFactor);
    landmark.reference_level =
        std::clamp(landmark.reference_level + static_cast<int>(std::lround(level_change)), 0,
                   frame.left()->num_levels() - 1);
    landmark.reference_frame = frame.id();
    landmark.reference_image = frame.left();
    landmark.reference_uv_px = sighting.uvu_px.head<2>();
    landmark.p_C_reference = p_C;
  }
}

void CreateLandmarks(const VisualOdometryOptions& options, const StereoFrame& frame,
                     const Se3& T_W_C, const Matrix6d& pose_covariance, const TrustField& field,
                     std::vector<LandmarkSighting>* sightings, LocalMap* map) {
  CellCounter cells(options.observation_cell_px);
  for (const LandmarkSighting& sighting : *sightings)
    cells.Take(sighting.uvu_px.head<2>(), kMaxObservationsPerCell);
  CellCounter tried(options.observation_cell_px);
  for (const Feature* feature : StrongestFirst(frame.left_features())) {
    const Eigen::Vector2d& uv_px = feature->uv_px;
    if (sightings->size() >= static_cast<std::size_t>(options.max_observations)) return;
    if (cells.IsFull(uv_px, kMaxObservationsPerCell) || !tried.Take(uv_px, kMaxTriedPerCell))
      continue;
    const std::optional<double> u_right_px = frame.stereo().Match(*feature);
    if (!u_right_px) continue;
    const auto p_C = frame.camera().Triangulate(uv_px.x(), uv_px.y(), *u_right_px);
    if (!p_C) continue;
    cells.Take(uv_px, kMaxObservationsPerCell);
    const double sigma_px = options.aligned_sigma_px * frame.left()->scale(feature->level);
    LocalLandmark landmark = MakeLandmark(frame, *feature, T_W_C, *p_C);
    landmark.created_covariance_W =
        CreatedCovariance(frame.camera(), T_W_C, pose_covariance, *p_C, sigma_px);
    landmark.trust = LandmarkTrust(field.At(uv_px, p_C->z()));
    const LandmarkId id = map->Add(std::move(landmark));
    sightings->push_back({id, {uv_px.x(), uv_px.y(), *u_right_px}, true, sigma_px});
  }
}

Eigen::Matrix3d CreatedCovariance(const StereoCamera& camera, const Se3& T_W_C,
                                  const Matrix6d& pose_covariance, const Eigen::Vector3d& p_C,
                                  double sigma_px) {
  Eigen::Matrix<double, 3, 6> J;  // of the point in C by the tangent of the pose
  J << Eigen::Matrix3d::Identity(), -Skew(p_C);
  const Eigen::Matrix3d R_W_C = T_W_C.rotation.toRotationMatrix();
  return R_W_C *
         (camera.TriangulationCovariance(p_C, sigma_px) + J * pose_covariance * J.transpose()) *
         R_W_C.transpose();
}

}  // namespace airdos
