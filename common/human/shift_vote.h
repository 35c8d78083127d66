#ifndef AIRDOS_COMMON_HUMAN_SHIFT_VOTE_H_
#define AIRDOS_COMMON_HUMAN_SHIFT_VOTE_H_

#include <Eigen/Core>
#include <vector>

#include "common/human/human_track.h"

namespace airdos {

/// Shift of the image in px since the last frame, as caused by the camera's rotation, by a vote of
/// the people: for each track t and each detection i of similar depth and clothes, with
/// displacement d_ti,
///   score(s) = sum_t max_i exp(-LooksCost_ti / 2) exp(-|d_ti - v_t - s|^2 / (2 (spread h_t)^2)),
/// where v_t is the track's own velocity and h_t its height. The candidates are all s = d_ti - v_t
/// and `first_guess`; the highest score wins, but `first_guess` is kept unless another one is
/// clearly better. Call it before the tracks are predicted.
Eigen::Vector2d VoteShift(const std::vector<HumanTrack>& tracks,
                          const std::vector<PersonDetection>& detections,
                          const Eigen::Vector2d& first_guess);

}  // namespace airdos

#endif  // AIRDOS_COMMON_HUMAN_SHIFT_VOTE_H_
