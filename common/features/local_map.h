#ifndef AIRDOS_COMMON_FEATURES_LOCAL_MAP_H_
#define AIRDOS_COMMON_FEATURES_LOCAL_MAP_H_

#include <Eigen/Core>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "common/features/feature.h"
#include "common/features/image_pyramid.h"
#include "common/features/landmark_trust.h"
#include "common/geometry/se3.h"
#include "common/util/ids.h"

namespace airdos {

/// A static point of the world, and what it looked like when it was created.
struct LocalLandmark {
  Eigen::Vector3d p_W = Eigen::Vector3d::Zero();
  bool is_refined =
      false;  ///< p_W is from the optimizer; otherwise it moves with its reference frame

  /// m^2, of p_W at its creation: from the stereo measurement and the camera's pose.
  Eigen::Matrix3d created_covariance_W = Eigen::Matrix3d::Zero();

  FrameId reference_frame;
  Eigen::Vector3d p_C_reference = Eigen::Vector3d::Zero();
  std::shared_ptr<const ImagePyramid> reference_image;
  Eigen::Vector2d reference_uv_px = Eigen::Vector2d::Zero();
  int reference_level = 0;

  LandmarkTrust trust;      ///< that it is static
  Descriptor descriptor{};  ///< when it was created
  FrameId last_seen;
  int num_seen = 0;
  int num_expected = 0;  ///< frames in which it was searched for: in view and off people
};

/// Limits of the LocalMap.
struct LocalMapOptions {
  int max_landmarks = 6000;
  int max_frames_unconfirmed = 8;  ///< a landmark seen once is dropped after this many
  double min_found_ratio = 0.15;   ///< of the frames in which it was expected
};

/// The optimizer's result for the frames and landmarks around frame `newest` (MAP_UPDATE).
struct MapCorrection {
  FrameId newest;
  std::vector<std::pair<FrameId, Se3>> frames;                        ///< T_W_C
  std::vector<std::pair<LandmarkId, Eigen::Vector3d>> landmarks_W_m;  ///< p_W
  std::vector<LandmarkId> removed;
};

/// The landmarks that frames are tracked against, and the poses of the recent frames.
class LocalMap {
 public:
  explicit LocalMap(const LocalMapOptions& options, LandmarkId first_id = {1})
      : options_(options), next_id_(first_id) {}

  std::map<LandmarkId, LocalLandmark>& landmarks() { return landmarks_; }
  const std::map<LandmarkId, LocalLandmark>& landmarks() const { return landmarks_; }
  const std::map<FrameId, Se3>& poses_W_C() const { return poses_; }

  LandmarkId Add(LocalLandmark landmark);
  void SetPose(FrameId frame, const Se3& T_W_C);

  /// Takes over the optimizer's poses and points. Frames newer than the correction keep their
  /// motion relative to it, and landmarks that the optimizer has not refined move with the frame in
  /// which they were created.
  void Apply(const MapCorrection& correction);

  /// Drops the landmarks that were not found again and, beyond the limit, those unseen for longest.
  /// Also keeps at most kMaxReferenceFrames reference frames, dropping all landmarks of those that
  /// have not been seen for longest.
  void Cull(FrameId now);

  /// Landmarks keep the images of at most this many frames: the largest part of the memory used.
  static constexpr std::size_t kMaxReferenceFrames = 250;

 private:
  void CullReferenceFrames();

  static constexpr int kMaxPoses = 64;

  LocalMapOptions options_;
  LandmarkId next_id_;
  std::map<LandmarkId, LocalLandmark> landmarks_;
  std::map<FrameId, Se3> poses_;
};

}  // namespace airdos

#endif  // AIRDOS_COMMON_FEATURES_LOCAL_MAP_H_
