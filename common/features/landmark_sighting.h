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

/// What a frame shows of the local map.
struct SightedLandmarks {
  std::vector<LandmarkSighting> sightings;  ///< ordered by id
  std::vector<LandmarkId> looked_for;       ///< found or not, in the order they were looked for
};

/// At most so many observed landmarks in each cell of observation_cell_px.
inline constexpr int kMaxObservationsPerCell = 2;
/// So many landmarks or corners of a cell are looked at to get there.
inline constexpr int kMaxTriedPerCell = 4;

/// Finds the landmarks that should be in view from T_W_C to a fraction of a pixel: the patch of
/// each, from the image in which it was seen first, is aligned with the left image from the feature
/// in `matches` or, without one, from its projection, and then along the row with the right image.
/// A match whose patch does not fit stays where its corner is, with the larger sigma of a corner; a
/// landmark with neither is not seen. None is seen on people. Where landmarks crowd, those that
/// were matched come first, then those seen most often, until kMaxTriedPerCell of a cell were
/// tried.
SightedLandmarks SightLandmarks(const VisualOdometryOptions& options, const StereoFrame& frame,
                                const LocalMap& map, const Se3& T_W_C,
                                const std::vector<LandmarkMatch>& matches);

/// At most max_observations of them, spread over the image; those seen most often first, because
/// they tie the new frames to the old ones. Each must be in the map. Ordered by id.
std::vector<LandmarkSighting> KeepSpread(const VisualOdometryOptions& options, const LocalMap& map,
                                         std::vector<LandmarkSighting> sightings);

}  // namespace airdos

#endif  // AIRDOS_COMMON_FEATURES_LANDMARK_SIGHTING_H_
