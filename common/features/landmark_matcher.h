#ifndef AIRDOS_COMMON_FEATURES_LANDMARK_MATCHER_H_
#define AIRDOS_COMMON_FEATURES_LANDMARK_MATCHER_H_

#include <vector>

#include "common/features/feature.h"
#include "common/features/feature_grid.h"
#include "common/features/image_pyramid.h"
#include "common/features/local_map.h"
#include "common/geometry/stereo_camera.h"

namespace airdos {

/// A landmark and the feature of the left image that it is matched to.
struct LandmarkMatch {
  LandmarkId landmark;
  int feature = 0;
  int distance = 0;  ///< Hamming distance, bits

  friend bool operator==(const LandmarkMatch& a, const LandmarkMatch& b) {
    return a.landmark == b.landmark && a.feature == b.feature;
  }
};

/// Limits for matching landmarks near their projections.
struct ProjectionSearch {
  double radius_px = 8;  ///< at level 0, grows with the level
  int max_hamming_bits = 80;
  double max_ratio = 0.9;  ///< best distance against second best
};

/// A landmark that should be in view, and where.
struct VisibleLandmark {
  LandmarkId id;
  const LocalLandmark* landmark = nullptr;
  Eigen::Vector3d p_C = Eigen::Vector3d::Zero();
  Eigen::Vector2d uv_px = Eigen::Vector2d::Zero();
  int level = 0;             ///< at which it should look as it did when created
  double patch_step_px = 1;  ///< px of the reference level per px of `level`
};

/// Landmarks whose projection from T_W_C lies in the left image, at a scale at which they are
/// recognisable; ordered by id.
std::vector<VisibleLandmark> FindVisible(const LocalMap& map, const StereoCamera& camera,
                                         const Se3& T_W_C, int num_levels);

/// Matches landmarks to features near their projections. A feature goes to the landmark with the
/// most similar descriptor.
std::vector<LandmarkMatch> MatchByProjection(const std::vector<VisibleLandmark>& visible,
                                             const std::vector<Feature>& features,
                                             const FeatureGrid& grid,
                                             const ProjectionSearch& search);

/// Matches landmarks to features anywhere in the image (brute force, with ratio test and
/// cross-check).
std::vector<LandmarkMatch> MatchByDescriptor(
    const std::vector<std::pair<LandmarkId, const LocalLandmark*>>& landmarks,
    const std::vector<Feature>& features, int max_hamming_bits, double max_ratio);

}  // namespace airdos

#endif  // AIRDOS_COMMON_FEATURES_LANDMARK_MATCHER_H_
