#ifndef AIRDOS_COMMON_MAP_MAP_EXPORT_H_
#define AIRDOS_COMMON_MAP_MAP_EXPORT_H_

#include <optional>
#include <string>
#include <vector>

#include "common/geometry/se3.h"
#include "common/map/four_d_map.h"
#include "common/util/output_folder.h"

namespace airdos {

/// The lists' group of what an export into the folder itself writes; those of folders below it, as
/// of a run's later sessions, belong to the run.
inline constexpr char kExportGroup[] = "export";

/// Names that an export may write, for OutputFolder::RequireReplaceable(): the fixed ones, and of
/// the folder people/, if there is one, those that a track would have. `prefix` is "" or
/// "session_2/".
std::vector<std::string> ExportNames(const std::string& folder, const std::string& prefix);

/// Writes everything below into a folder of results:
/// - trajectory.tum: T_W_C as `t x y z qx qy qz qw` (s, m), refined where there is a refined pose;
/// - trajectory_live.tum: T_W_C as estimated when each frame was the newest;
/// - trajectory.kitti: the same poses in rows of 3 x 4, all of them; frames without a pose have no
///   row;
/// - ground_truth.tum: if there is one; its axes are in the first line;
/// - map.ply: static landmarks in W (m), binary little endian, with sigma_m and num_observations;
/// - people.jsonl: one line per person and frame, in order of (frame, track);
/// - people/<track>.tum: pose of each person's torso, see TorsoPose().
///
/// In files of times these go forward: poses whose time is not later than that of an image before
/// are left out, and a comment in the first line says how many.
///
/// It is written into a folder of its own first and then put into its places, so that none is ever
/// half-written; files of an earlier export are the caller's to remove. Returns the paths. Throws
/// InputError naming the file that cannot be written, or was not written by us and is in the way.
std::vector<std::string> ExportMap(const FourDMap& map, const std::string& prefix,
                                   const std::string& group, OutputFolder* results);

/// The same into a folder that nobody holds; what an earlier export left there is removed.
/// `map_path` is the file of the map: into a folder with the results of a run only the run's own
/// map is exported. `num_replaced` may be null.
std::vector<std::string> ExportMap(const FourDMap& map, const std::string& map_path,
                                   const std::string& folder, bool force, int* num_replaced);

/// T_W_H of a person: position is the mean of the neck and the middle of the hips (of what is known
/// of the torso's five joints where one of these lacks); axes x to the person's right, y down along
/// the spine, z forward. The identity where the neck or a hip lacks or they lie on one line;
/// nothing where no joint of the torso is known.
std::optional<Se3> TorsoPose(const MapHuman& human);

/// One line of people.jsonl, without the line's end: {"seq", "utime", "track", "joints": {id:
/// [x, y, z]}, "measured": {…}, "segment_lengths_m": {number: length}}, joints in W (m), the map's
/// single precision exactly.
std::string HumanToJson(FrameId frame, HumanId human, const MapHuman& state);

/// Text of a TUM row, s with six decimals.
std::string TumRow(std::int64_t utime, const Se3& T_W_B);

}  // namespace airdos

#endif  // AIRDOS_COMMON_MAP_MAP_EXPORT_H_
