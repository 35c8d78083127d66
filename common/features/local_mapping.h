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

// What the frontend does with the landmarks of its local map once the pose T_W_C of a frame is
// known. Points are in W, m. Landmarks that are not found again are culled by LocalMap::Cull().

namespace airdos {

/// Counts the sightings of the frame. A landmark that is by now so much nearer or farther that it
/// looks different is known from here on by how it looks in this frame. Each sighting must be of a
/// landmark in the map.
void UpdateLandmarks(const StereoFrame& frame, const Se3& T_W_C,
                     const std::vector<LandmarkSighting>& sightings, LocalMap* map);

/// Makes landmarks of the strongest corners that have a partner in the right image, where the image
/// has room beside `sightings`, until there are max_observations; adds the new ones to `sightings`.
/// `pose_covariance` is that of the tangent of T_W_C, m and rad (see se3.h); `field` says how much
/// a new landmark can be trusted.
void CreateLandmarks(const VisualOdometryOptions& options, const StereoFrame& frame,
                     const Se3& T_W_C, const Matrix6d& pose_covariance, const TrustField& field,
                     std::vector<LandmarkSighting>* sightings, LocalMap* map);

/// Covariance in W, m^2, of a point at p_C that a frame at T_W_C triangulates, from that of the
/// stereo measurement S and that of the pose's tangent P:
///   R_W_C (S + J P J^T) R_C_W,   J = [I, -skew(p_C)].
Eigen::Matrix3d CreatedCovariance(const StereoCamera& camera, const Se3& T_W_C,
                                  const Matrix6d& pose_covariance, const Eigen::Vector3d& p_C,
                                  double sigma_px);

}  // namespace airdos

#endif  // AIRDOS_COMMON_FEATURES_LOCAL_MAPPING_H_
