#include "common/human/shift_vote.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>

namespace airdos {
namespace {

constexpr double kSpread = 0.12;     // of the height: deviation of people from the common shift
constexpr double kMinWeight = 0.05;  // pairs that look less alike do not vote
constexpr double kMinGain = 0.3;     // in votes; by this much another shift must be better

struct Vote {
  std::size_t track;
  Eigen::Vector2d shift_px;
  double weight;
  double spread_px;
};

// `votes` must be sorted by track.
double Score(const std::vector<Vote>& votes, const Eigen::Vector2d& shift_px) {
  double score = 0;
  for (std::size_t first = 0; first < votes.size();) {
    double best = 0;
    std::size_t i = first;
    for (; i < votes.size() && votes[i].track == votes[first].track; ++i) {
      const double error = (votes[i].shift_px - shift_px).norm() / votes[i].spread_px;
      best = std::max(best, votes[i].weight * std::exp(-error * error / 2));
    }
    score += best;
    first = i;
  }
  return score;
}

}  // namespace

Eigen::Vector2d VoteShift(const std::vector<HumanTrack>& tracks,
                          const std::vector<PersonDetection>& detections,
                          const Eigen::Vector2d& first_guess) {
  std::vector<Vote> votes;
  for (std::size_t track = 0; track < tracks.size(); ++track) {
    if (tracks[track].num_missed() > 0) continue;
    for (const PersonDetection& detection : detections) {
      const double weight = std::exp(-tracks[track].LooksCost(detection) / 2);
      if (weight < kMinWeight) continue;
      const std::optional<Eigen::Vector2d> displacement = tracks[track].Displacement(detection);
      if (!displacement) continue;
      votes.push_back({track, *displacement - tracks[track].velocity_px(), weight,
                       kSpread * tracks[track].height_px()});
    }
  }
  Eigen::Vector2d best = first_guess;
  double best_score = Score(votes, first_guess) + kMinGain;
  for (const Vote& vote : votes) {
    const double score = Score(votes, vote.shift_px);
    if (score > best_score) {
      best_score = score;
      best = vote.shift_px;
    }
  }
  return best;
}

}  // namespace airdos
