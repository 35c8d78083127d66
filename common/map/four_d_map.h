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

/// What is known of one frame. All poses are T_W_C, but for the ground truth, which has a world
/// (and axes) of its own.
struct MapFrame {
  std::int64_t utime = 0;               ///< us, capture time
  std::optional<Se3> live;              ///< as estimated when the frame was the newest
  std::optional<Se3> refined;           ///< as of the last bundle adjustment it took part in
  std::optional<Se3> ground_truth;      ///< in FourDMap::ground_truth_axes
  std::int8_t status = 0;               ///< state_estimate_t.STATUS_*
  bool is_trusted_with_people = false;  ///< which of the optimizer's two poses the live one is

  /// Refined if there is one, else live.
  std::optional<Se3> best() const { return refined ? refined : live; }
};

struct MapLandmark {
  Eigen::Vector3f p_W = Eigen::Vector3f::Zero();  ///< m
  float sigma_m = 0;                              ///< along the worst direction
  std::int32_t num_observations = 0;
};

struct MapJoint {
  Eigen::Vector3f p_W = Eigen::Vector3f::Zero();           ///< m, optimized
  Eigen::Vector3f p_W_measured = Eigen::Vector3f::Zero();  ///< m, as triangulated
};

/// Motion of a rigid part from the frame before: p_k = R (p_km1 - c) + c + t, c its centroid
/// before.
struct MapPartMotion {
  Eigen::Vector3f t_W = Eigen::Vector3f::Zero();  ///< m
  Eigen::Quaternionf R_W = Eigen::Quaternionf::Identity();
};

/// One person at one frame.
struct MapHuman {
  std::int64_t utime = 0;                     ///< us, capture time
  std::map<int, MapJoint> joints;             ///< by joint id (common/human/skeleton.h)
  std::map<int, float> segment_lengths_m;     ///< by number of the segment
  std::map<int, MapPartMotion> part_motions;  ///< by number of the part
};

/// The 4-D map: the camera's path, the static landmarks, and people over time.
struct FourDMap {
  std::int64_t session = 0;
  std::string program;                 ///< name and version that recorded it
  std::optional<StereoCamera> camera;  ///< known at the end of a recording
  std::int8_t ground_truth_axes = 0;   ///< pose_t.AXES_*
  bool is_closed = false;              ///< false: the recording was cut short

  std::map<FrameId, MapFrame> frames;
  std::map<LandmarkId, MapLandmark> landmarks;
  std::map<std::pair<FrameId, HumanId>, MapHuman> humans;
};

/// What changed since the chunk before. What comes later replaces what came before.
class MapDelta {
 public:
  /// Parts of the frame that are set replace what was known of them.
  void SetFrame(FrameId id, const MapFrame& frame);
  void SetLandmark(LandmarkId id, const MapLandmark& landmark);
  void RemoveLandmark(LandmarkId id);
  /// Part motions that are not said again stay.
  void SetHuman(FrameId frame, HumanId human, const MapHuman& state);

  bool empty() const;
  /// Of the chunk, to keep it below kMaxChunkBytes.
  std::size_t ApproximateBytes() const;
  void Apply(FourDMap* map) const;
  MapChunk ToChunk() const;
  /// False where the content makes no sense; the changes are then in part those of the chunk.
  bool FromChunk(const MapChunk& chunk);

 private:
  std::map<FrameId, MapFrame> frames_;
  std::map<LandmarkId, MapLandmark> landmarks_;
  std::set<LandmarkId> removed_;
  std::map<std::pair<FrameId, HumanId>, MapHuman> humans_;
};

/// The chunk that a recording starts with: session, program. And the one that it is closed with:
/// camera and axes of the ground truth.
MapChunk HeadChunk(std::int64_t session, const std::string& program);
MapChunk EndChunk(const std::optional<StereoCamera>& camera, std::int8_t ground_truth_axes);

/// Reads everything up to the last good chunk, see map_file.h. A chunk with a good checksum whose
/// content makes no sense ends the reading, too. Chunks of unknown types are passed over.
FourDMap ReadFourDMap(const std::string& path, MapFileSummary* summary);

}  // namespace airdos

#endif  // AIRDOS_COMMON_MAP_FOUR_D_MAP_H_
