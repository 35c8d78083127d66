#ifndef AIRDOS_COMMON_HUMAN_SHIFT_VOTE_H_
#define AIRDOS_COMMON_HUMAN_SHIFT_VOTE_H_

#include <Eigen/Core>
#include <vector>

#include "common/human/human_track.h"

namespace airdos {

/// Shift in px of the image since the last frame, as a turning camera makes it, voted by the people
/// themselves: for each track t and detection i of like depth and clothes with displacement d_ti,
///   score(s) = sum_t max_i exp(-LooksCost_ti / 2) exp(-|d_ti - v_t - s|^2 / (2 (spread h_t)^2)),
/// v_t the track's own velocity and h_t its height. Of all s = d_ti - v_t and `first_guess` the one
/// with the highest score; `first_guess` unless another is clearly better. Tracks must not have
/// been predicted yet.
Eigen::Vector2d VoteShift(const std::vector<HumanTrack>& tracks,
                          const std::vector<PersonDetection>& detections,
                          const Eigen::Vector2d& first_guess);

}  // namespace airdos

#endif  // AIRDOS_COMMON_HUMAN_SHIFT_VOTE_H_
