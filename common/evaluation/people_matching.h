#ifndef AIRDOS_COMMON_EVALUATION_PEOPLE_MATCHING_H_
#define AIRDOS_COMMON_EVALUATION_PEOPLE_MATCHING_H_

#include <cstdint>
#include <map>
#include <vector>

#include "common/evaluation/people_files.h"
#include "common/evaluation/trajectory.h"
#include "common/human/body_keypoints.h"

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

/// How far apart two bodies are in the image, whatever their depths: the mean over the joints that
/// both have of the distance between their directions, in standing heights of the true person, each
/// limited to 0.25. With `swap`, as if the sides of the measured body were exchanged. Infinite if
/// they share no joint. Joints are in camera coordinates.
double ImageDistance(const Joints& measured_C, const Joints& truth_C, SideSwap swap);
/// From here on two bodies are not the same person.
constexpr double kMaxImageDistance = 0.15;

/// Finds the true person for each estimated one: the one at the same place in the image, regardless
/// of depth, so that the matching does not select the errors that are measured afterwards. The
/// distance is ImageDistance(), for the estimate with the joints as measured, also tried with the
/// sides of the body exchanged. Pairs have a distance below kMaxImageDistance and minimise the sum,
/// one-to-one (Hungarian method). Joints of both are in camera coordinates. Returns index of the
/// estimated person -> identity.
std::map<std::size_t, std::int64_t> MatchPeople(const std::vector<Joints>& measured_C,
                                                const std::map<std::int64_t, Joints>& truth_C);

}  // namespace airdos

#endif  // AIRDOS_COMMON_EVALUATION_PEOPLE_MATCHING_H_
