#ifndef AIRDOS_COMMON_MAP_FOUR_D_MAP_H_
#define AIRDOS_COMMON_MAP_FOUR_D_MAP_H_

#include <Eigen/Core>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "common/geometry/se3.h"
#include "common/geometry/stereo_camera.h"
#include "common/map/map_file.h"
#include "common/util/ids.h"

namespace airdos {

/// What is known about one frame. All poses are T_W_C, except the ground truth, which has its own
/// world (and axes).
struct MapFrame {
  std::int64_t utime = 0;               ///< us, capture time
  std::optional<Se3> live;              ///< as estimated while the frame was the newest
  std::optional<Se3> refined;           ///< from the last bundle adjustment that included the frame
  std::optional<Se3> ground_truth;      ///< in FourDMap::ground_truth_axes
  std::int8_t status = 0;               ///< state_estimate_t.STATUS_*
  bool is_trusted_with_people = false;  ///< whether `live` is the optimizer's pose with people

  /// The refined pose if there is one, otherwise the live one.
  std::optional<Se3> best() const { return refined ? refined : live; }
};

/// A static landmark.
struct MapLandmark {
  Eigen::Vector3f p_W = Eigen::Vector3f::Zero();  ///< m
  float sigma_m = 0;                              ///< standard deviation along the worst direction
  std::int32_t num_observations = 0;
};

/// A joint of a person in one frame.
struct MapJoint {
  Eigen::Vector3f p_W = Eigen::Vector3f::Zero();           ///< m, optimized
  Eigen::Vector3f p_W_measured = Eigen::Vector3f::Zero();  ///< m, as triangulated
};

/// Motion of a rigid part since the previous frame: p_k = R (p_km1 - c) + c + t, where c is the
/// part's centroid in the previous frame.
struct MapPartMotion {
  Eigen::Vector3f t_W = Eigen::Vector3f::Zero();  ///< m
  Eigen::Quaternionf R_W = Eigen::Quaternionf::Identity();
};

/// One person in one frame.
struct MapHuman {
  std::int64_t utime = 0;                     ///< us, capture time
  std::map<int, MapJoint> joints;             ///< by joint number (common/human/skeleton.h)
  std::map<int, float> segment_lengths_m;     ///< by segment number
  std::map<int, MapPartMotion> part_motions;  ///< by part number
};

/// The 4-D map: the camera's trajectory, the static landmarks, and people over time.
struct FourDMap {
  std::int64_t session = 0;
  std::string program;                 ///< name and version of the recorder
  std::optional<StereoCamera> camera;  ///< written at the end of a recording
  std::int8_t ground_truth_axes = 0;   ///< pose_t.AXES_*
  bool is_closed = false;              ///< false if the recording was interrupted

  std::map<FrameId, MapFrame> frames;
  std::map<LandmarkId, MapLandmark> landmarks;
  std::map<std::pair<FrameId, HumanId>, MapHuman> humans;
};

/// The changes since the previous chunk. Later values replace earlier ones.
class MapDelta {
 public:
  /// The members of `frame` that are set replace the previous values.
  void SetFrame(FrameId id, const MapFrame& frame);
  void SetLandmark(LandmarkId id, const MapLandmark& landmark);
  void RemoveLandmark(LandmarkId id);
  /// Part motions that `state` does not repeat are kept.
  void SetHuman(FrameId frame, HumanId human, const MapHuman& state);

  bool empty() const;
  /// Size of the chunk, for keeping it below kMaxChunkBytes.
  std::size_t ApproximateBytes() const;
  void Apply(FourDMap* map) const;
  MapChunk ToChunk() const;
  /// False if the content is invalid; some of the changes may then have been taken over.
  bool FromChunk(const MapChunk& chunk);

 private:
  std::map<FrameId, MapFrame> frames_;
  std::map<LandmarkId, MapLandmark> landmarks_;
  std::set<LandmarkId> removed_;
  std::map<std::pair<FrameId, HumanId>, MapHuman> humans_;
};

/// The chunk that starts a recording (session, program), and the one that closes it (camera, axes
/// of the ground truth).
MapChunk HeadChunk(std::int64_t session, const std::string& program);
MapChunk EndChunk(const std::optional<StereoCamera>& camera, std::int8_t ground_truth_axes);

/// Reads everything up to the last valid chunk, see map_file.h. A chunk with a correct checksum but
/// invalid content ends the reading as well. Chunks of unknown types are skipped.
FourDMap ReadFourDMap(const std::string& path, MapFileSummary* summary);

}  // namespace airdos

#endif  // AIRDOS_COMMON_MAP_FOUR_D_MAP_H_
