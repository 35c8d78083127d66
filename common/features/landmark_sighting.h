#ifndef AIRDOS_COMMON_FEATURES_LANDMARK_SIGHTING_H_
#define AIRDOS_COMMON_FEATURES_LANDMARK_SIGHTING_H_

#include <Eigen/Core>
#include <vector>

#include "common/features/landmark_matcher.h"
#include "common/features/local_map.h"
#include "common/features/stereo_frame.h"
#include "common/features/visual_odometry_options.h"
#include "common/geometry/se3.h"
#include "common/util/ids.h"

namespace airdos {

/// Where one frame sees a landmark of the local map.
struct LandmarkSighting {
  LandmarkId id;
  Eigen::Vector3d uvu_px = Eigen::Vector3d::Zero();  ///< u_left, v, u_right of the rectified pair
  bool has_right = false;                            ///< else u_right is 0 and says nothing
  double sigma_px = 1;                               ///< of each of the three
};

/// What one frame shows of the local map.
struct SightedLandmarks {
  std::vector<LandmarkSighting> sightings;  ///< ordered by id
  std::vector<LandmarkId> looked_for;       ///< found or not, in the order of the search
};

/// Limit on the observed landmarks in each cell of observation_cell_px.
inline constexpr int kMaxObservationsPerCell = 2;
/// Limit on the landmarks or corners that are tried in a cell to reach it.
inline constexpr int kMaxTriedPerCell = 4;

/// Finds the landmarks that should be visible from T_W_C, to a fraction of a pixel. The patch of
/// each, taken from its reference image, is aligned with the left image, starting from its feature
/// in `matches` or else from its projection, and then with the right image along the row. If the
/// patch does not fit, a matched landmark is seen at its corner, with the larger sigma of a corner,
/// and an unmatched one is not seen. Nothing is seen on people. In crowded cells matched landmarks
/// are tried first, then those seen most often, at most kMaxTriedPerCell of them.
SightedLandmarks SightLandmarks(const VisualOdometryOptions& options, const StereoFrame& frame,
                                const LocalMap& map, const Se3& T_W_C,
                                const std::vector<LandmarkMatch>& matches);

/// At most max_observations of the sightings, spread over the image and ordered by id. Landmarks
/// seen most often take precedence, because they tie new frames to old ones. Each must be in the
/// map.
std::vector<LandmarkSighting> KeepSpread(const VisualOdometryOptions& options, const LocalMap& map,
                                         std::vector<LandmarkSighting> sightings);

}  // namespace airdos

#endif  // AIRDOS_COMMON_FEATURES_LANDMARK_SIGHTING_H_
