#ifndef AIRDOS_COMMON_EVALUATION_PEOPLE_MATCHING_H_
#define AIRDOS_COMMON_EVALUATION_PEOPLE_MATCHING_H_

#include <cstdint>
#include <map>
#include <vector>

#include "common/evaluation/people_files.h"
#include "common/evaluation/trajectory.h"

namespace airdos {

/// A true person counts as "to be seen" where each image shows at least kMinVisibleJoints joints
/// (where the file says which) and the middle of the depths of the joints is between the two below.
/// 30 m are 44 px of height with the crossings' camera (f 772.5 px).
constexpr int kMinVisibleJoints = 5;
constexpr double kMinPersonDepthM = 0.5;
constexpr double kMaxPersonDepthM = 30;

/// The middle of the depths (m) of joints in the camera's axes, the lower one of two.
double MiddleDepth(const Joints& joints_C);
bool IsToBeSeen(const TruePersonState& person, const Joints& joints_C);

/// Joints in the axes of the camera at `T_A_C`, given in A.
Joints InCamera(const Joints& joints_A, const TrajectoryPose& T_A_C);

/// Says which true person each estimated one is: that which was seen at the same place of the
/// image, whatever the depth says, so that the match does not choose the errors that are then
/// measured. Distances are between the directions of the joints that both have (measured ones of
/// the estimate), in standing heights of the true person, each at most 0.25; also with the sides of
/// the body exchanged. Pairs have a mean below 0.15 and the least sum, one to one (Hungarian
/// method). Joints in the camera's axes on both sides. Returns index of the estimated person ->
/// identity.
std::map<std::size_t, std::int64_t> MatchPeople(const std::vector<Joints>& measured_C,
                                                const std::map<std::int64_t, Joints>& truth_C);

}  // namespace airdos

#endif  // AIRDOS_COMMON_EVALUATION_PEOPLE_MATCHING_H_
