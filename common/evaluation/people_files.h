#ifndef AIRDOS_COMMON_EVALUATION_PEOPLE_FILES_H_
#define AIRDOS_COMMON_EVALUATION_PEOPLE_FILES_H_

#include <Eigen/Core>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace airdos {

using Joints = std::map<int, Eigen::Vector3d>;  ///< by joint number (0..13), m

/// One estimated person in one frame.
struct PersonState {
  double time_s = 0;
  std::int64_t track = 0;
  Joints joints_W;                         ///< optimized, in the estimate's world
  Joints measured_W;                       ///< as triangulated
  std::map<int, double> segment_length_m;  ///< by index into kSegments, as estimated at this frame
};

/// One true person in one frame.
struct TruePersonState {
  Joints joints;  ///< in the ground truth's world
  /// Number of joints (of all 18) visible in the left and the right image; nothing if the file does
  /// not tell.
  std::optional<int> num_visible_left;
  std::optional<int> num_visible_right;
  std::set<int> visible_left{};  ///< which of `joints` these are; empty if the file does not tell
  std::set<int> visible_right{};
};

/// The true people in one frame, by identity.
struct TruePeople {
  double time_s = 0;
  std::map<std::int64_t, TruePersonState> people;
};

/// Reads people.jsonl as exported by map_recorder. Throws InputError naming file and line.
std::vector<PersonState> ReadPeople(const std::string& path);
/// Reads joints_gt.json, possibly gzipped: [{"t", "humans": [{"id", "joints_w": {id: [x, y, z]},
/// "vis0": [18 numbers], "vis1"}]}]. A joint is visible if its number is above 0. Throws InputError
/// naming the file.
std::vector<TruePeople> ReadTruePeople(const std::string& path);

}  // namespace airdos

#endif  // AIRDOS_COMMON_EVALUATION_PEOPLE_FILES_H_
