#ifndef AIRDOS_COMMON_EVALUATION_PEOPLE_REPORT_H_
#define AIRDOS_COMMON_EVALUATION_PEOPLE_REPORT_H_

#include <Eigen/Core>
#include <cstdint>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "common/evaluation/statistics.h"
#include "common/evaluation/trajectory.h"

namespace airdos {

using Joints = std::map<int, Eigen::Vector3d>;  ///< by joint id (0..13), m

/// One estimated person at one frame.
struct PersonState {
  double time_s = 0;
  std::int64_t track = 0;
  Joints joints_W;    ///< optimized, in the estimate's world
  Joints measured_W;  ///< as triangulated
};
/// The true people of one frame, by identity, in the ground truth's world.
struct TruePeople {
  double time_s = 0;
  std::map<std::int64_t, Joints> people;
};

/// people.jsonl as map_recorder exports it. Throws InputError naming file and line.
std::vector<PersonState> ReadPeople(const std::string& path);
/// joints_gt.json, also compressed with gzip: [{"t", "humans": [{"id", "joints_w": {id: [x, y,
/// z]}}]}].
std::vector<TruePeople> ReadTruePeople(const std::string& path);

struct PeopleReport {
  std::size_t num_states = 0;   ///< estimated people, summed over the frames with both camera poses
  std::size_t num_matched = 0;  ///< of these, within max_distance_m of a true person
  std::size_t num_tracks = 0;
  std::size_t num_people = 0;  ///< true people that were matched at least once
  /// A true person's track is another one than the last time that it was matched.
  std::size_t num_identity_switches = 0;
  Statistics joint_error_m;     ///< of the optimized joints of the matched people
  Statistics measured_error_m;  ///< of the same joints as triangulated
};

/// Estimated joints are carried into the true world frame by frame through the camera, by the true
/// camera pose times the inverse of the estimated one: errors of the camera's path do not count.
/// In each frame pairs are made by mean distance of the joints that both have: first those of the
/// frame before, then the nearest first, each within `max_distance_m`.
PeopleReport EvaluatePeople(const std::vector<PersonState>& estimate,
                            const std::vector<TruePeople>& truth,
                            const MatchedTrajectories& cameras, double max_distance_m);

std::string ToTable(const PeopleReport& report);
nlohmann::json ToJson(const PeopleReport& report);

}  // namespace airdos

#endif  // AIRDOS_COMMON_EVALUATION_PEOPLE_REPORT_H_
