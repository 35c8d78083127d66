#ifndef AIRDOS_COMMON_FEATURES_PEOPLE_POSE_H_
#define AIRDOS_COMMON_FEATURES_PEOPLE_POSE_H_

#include <vector>

#include "common/features/pose_estimator.h"
#include "common/human/people_filter.h"

namespace airdos {

struct PeoplePose {
  PosePrior prior;                          ///< what the prior and the people say together
  Matrix6d information = Matrix6d::Zero();  ///< of the tangent, from the people alone
  int num_people = 0;                       ///< who were asked
};

/// The camera's pose from people: `prior` corrected by where the camera sees them and where they
/// must be. Each person counts with the joint covariance of all his points and a Huber weight as a
/// whole: somebody who does not do what was predicted says little. Without people the prior comes
/// back.
PeoplePose EstimatePoseFromPeople(const PosePrior& prior,
                                  const std::vector<HumanConstraint>& people);

}  // namespace airdos

#endif  // AIRDOS_COMMON_FEATURES_PEOPLE_POSE_H_
