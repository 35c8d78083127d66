#ifndef AIRDOS_COMMON_EVALUATION_PEOPLE_MATCHING_H_
#define AIRDOS_COMMON_EVALUATION_PEOPLE_MATCHING_H_

#include <cstdint>
#include <map>
#include <vector>

#include "common/evaluation/people_files.h"
#include "common/evaluation/trajectory.h"

namespace airdos {

/// A true person counts as "to be seen" if each image shows at least kMinVisibleJoints joints (if
/// the file tells) and the median depth of the joints is between the two limits below. At 30 m a
/// person is 44 px tall in the camera of the crossings (f = 772.5 px).
constexpr int kMinVisibleJoints = 5;
constexpr double kMinPersonDepthM = 0.5;
constexpr double kMaxPersonDepthM = 30;

/// Median depth (m) of joints in camera coordinates, the lower of the two middle ones.
double MiddleDepth(const Joints& joints_C);
bool IsToBeSeen(const TruePersonState& person, const Joints& joints_C);

/// Transforms joints from A to the camera at `T_A_C`.
Joints InCamera(const Joints& joints_A, const TrajectoryPose& T_A_C);

/// Finds the true person for each estimated one: the one at the same place in the image, regardless
/// of depth, so that the matching does not select the errors that are measured afterwards. The
/// distance is the mean over the shared joints (as measured, for the estimate) of the distance
/// between their directions, in standing heights of the true person, each limited to 0.25; also
/// tried with the sides of the body exchanged. Pairs have a distance below 0.15 and minimise the
/// sum, one-to-one (Hungarian method). Joints of both are in camera coordinates. Returns index of
/// the estimated person -> identity.
std::map<std::size_t, std::int64_t> MatchPeople(const std::vector<Joints>& measured_C,
                                                const std::map<std::int64_t, Joints>& truth_C);

}  // namespace airdos

#endif  // AIRDOS_COMMON_EVALUATION_PEOPLE_MATCHING_H_
