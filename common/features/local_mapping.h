#ifndef AIRDOS_COMMON_FEATURES_LOCAL_MAPPING_H_
#define AIRDOS_COMMON_FEATURES_LOCAL_MAPPING_H_

#include <Eigen/Core>
#include <vector>

#include "common/features/landmark_sighting.h"
#include "common/features/landmark_trust.h"
#include "common/features/local_map.h"
#include "common/features/stereo_frame.h"
#include "common/features/visual_odometry_options.h"
#include "common/geometry/se3.h"
#include "common/geometry/stereo_camera.h"

// Local mapping: what happens to the landmarks once the pose T_W_C of a frame is known. Points are
// in W, in m. Culling is LocalMap::Cull().

namespace airdos {

/// Counts the sightings of the frame. A landmark whose depth has changed so much that it looks
/// different gets this frame as its new reference. Each sighting must be of a landmark in the map.
void UpdateLandmarks(const StereoFrame& frame, const Se3& T_W_C,
                     const std::vector<LandmarkSighting>& sightings, LocalMap* map);

/// Creates landmarks from the strongest corners with a stereo match, in cells that `sightings`
/// leave free, until there are max_observations, and adds them to `sightings`. `pose_covariance` is
/// that of the tangent of T_W_C, in m and rad (see se3.h); `field` gives the trust in a new
/// landmark.
void CreateLandmarks(const VisualOdometryOptions& options, const StereoFrame& frame,
                     const Se3& T_W_C, const Matrix6d& pose_covariance, const TrustField& field,
                     std::vector<LandmarkSighting>* sightings, LocalMap* map);

/// Covariance in W, m^2, of a point triangulated at p_C by a frame at T_W_C, from the covariance S
/// of the stereo measurement and P of the pose's tangent:
///   R_W_C (S + J P J^T) R_C_W,   J = [I, -skew(p_C)].
Eigen::Matrix3d CreatedCovariance(const StereoCamera& camera, const Se3& T_W_C,
                                  const Matrix6d& pose_covariance, const Eigen::Vector3d& p_C,
                                  double sigma_px);

}  // namespace airdos

#endif  // AIRDOS_COMMON_FEATURES_LOCAL_MAPPING_H_
