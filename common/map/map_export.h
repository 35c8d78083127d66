#ifndef AIRDOS_COMMON_MAP_MAP_EXPORT_H_
#define AIRDOS_COMMON_MAP_MAP_EXPORT_H_

#include <optional>
#include <string>
#include <vector>

#include "common/geometry/se3.h"
#include "common/map/four_d_map.h"
#include "common/util/output_folder.h"

namespace airdos {

/// Group name of the files that an export writes into the folder itself. Exports into subfolders,
/// such as those of a run's later sessions, belong to the run.
inline constexpr char kExportGroup[] = "export";

/// Names that an export may write, for OutputFolder::RequireReplaceable(): the fixed ones and, if
/// there is a folder people/, those in it that look like a track's. `prefix` is "" or "session_2/".
std::vector<std::string> ExportNames(const std::string& folder, const std::string& prefix);

/// Writes the following into a folder of results:
/// - trajectory.tum: T_W_C as `t x y z qx qy qz qw` (s, m), refined where there is a refined pose;
/// - trajectory_live.tum: T_W_C as estimated while each frame was the newest;
/// - trajectory.kitti: the poses of trajectory.tum as rows of 3 x 4, without any left out for its
///   time; frames without a pose have no row;
/// - ground_truth.tum: if there is ground truth; its axes are given in the first line;
/// - map.ply: static landmarks in W (m), binary little-endian, with sigma_m and num_observations;
/// - people.jsonl: one line per person and frame, ordered by (frame, track);
/// - people/<track>.tum: pose of each person's torso, see TorsoPose().
///
/// In files with times, these increase strictly: poses whose time is not later than that of an
/// earlier image are left out, and a comment in the first line states how many.
///
/// Everything is written to a temporary folder first and then moved into place, so no file is ever
/// half-written. The caller removes the files of an earlier export. Returns the paths. Throws
/// InputError naming the file that cannot be written, or that is in the way and was not written by
/// us.
std::vector<std::string> ExportMap(const FourDMap& map, const std::string& prefix,
                                   const std::string& group, OutputFolder* results);

/// The same for a folder that is not locked by the caller; removes what an earlier export left
/// there. `map_path` is the map file: if the folder holds the results of a run, only that run's own
/// map is exported into it. `num_replaced` may be null.
std::vector<std::string> ExportMap(const FourDMap& map, const std::string& map_path,
                                   const std::string& folder, bool force, int* num_replaced);

/// T_W_H of a person. Its position is the mean of the neck and the middle of the hips (or, if one
/// of these is missing, of the torso's known joints); its axes are x to the person's right, y down
/// along the spine, z forward. The rotation is the identity if the neck or a hip is missing or they
/// are collinear. Nothing if no joint of the torso is known.
std::optional<Se3> TorsoPose(const MapHuman& human);

/// One line of people.jsonl without the newline: {"seq", "utime", "track", "joints": {id: [x, y,
/// z]}, "measured": {…}, "segment_lengths_m": {number: length}}, with joints in W (m) and the map's
/// single-precision numbers exactly.
std::string HumanToJson(FrameId frame, HumanId human, const MapHuman& state);

/// A TUM row; the time in s has six decimals.
std::string TumRow(std::int64_t utime, const Se3& T_W_B);

}  // namespace airdos

#endif  // AIRDOS_COMMON_MAP_MAP_EXPORT_H_
