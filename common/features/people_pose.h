#ifndef AIRDOS_COMMON_FEATURES_PEOPLE_POSE_H_
#define AIRDOS_COMMON_FEATURES_PEOPLE_POSE_H_

#include <vector>

#include "common/features/pose_estimator.h"
#include "common/human/people_filter.h"

namespace airdos {

/// A pose estimated from people.
struct PeoplePose {
  PosePrior prior;                          ///< the prior and the people combined
  Matrix6d information = Matrix6d::Zero();  ///< of the tangent, from people only
  int num_people = 0;                       ///< who contributed
};

/// The camera's pose from people: `prior` corrected by where the camera sees them and where they
/// should be. Each person enters as a whole, with the joint covariance of all joints and one Huber
/// weight: somebody who does not move as predicted has little influence. Without people the prior
/// is returned.
PeoplePose EstimatePoseFromPeople(const PosePrior& prior,
                                  const std::vector<HumanConstraint>& people);

}  // namespace airdos

#endif  // AIRDOS_COMMON_FEATURES_PEOPLE_POSE_H_
