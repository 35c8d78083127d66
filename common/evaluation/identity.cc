#include "common/evaluation/identity.h"

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>

#include "common/human/assignment.h"

namespace airdos {

void IdentityEvaluator::AddFrame(
    const std::set<std::int64_t>& visible_people,
    const std::map<std::int64_t, std::optional<std::int64_t>>& person_of_track) {
  for (const std::int64_t person : visible_people) ++frames_of_person_[person];
  for (const auto& [track, person] : person_of_track) {
    if (!person) {
      ++frames_of_track_[track];
      continue;
    }
    const auto last = last_track_.find(*person);
    if (last != last_track_.end() && last->second != track) ++num_switches_;
    last_track_[*person] = track;
    if (visible_people.count(*person) == 0) continue;
    ++frames_of_track_[track];
    ++frames_of_both_[*person][track];
  }
}

IdentityScore IdentityEvaluator::Score() const {
  IdentityScore score;
  score.num_switches = num_switches_;
  score.num_people = static_cast<int>(frames_of_person_.size());
  int people_frames = 0;
  int track_frames = 0;
  int most = 0;
  for (const auto& [person, frames] : frames_of_person_) people_frames += frames;
  for (const auto& [track, frames] : frames_of_track_) track_frames += frames;
  for (const auto& [person, tracks] : frames_of_both_) {
    for (const auto& [track, frames] : tracks) most = std::max(most, frames);
  }
  if (people_frames + track_frames == 0) return score;
  // Maximises the frames explained by minimising the cost: a pair reduces it by the frames it
  // explains.
  Eigen::MatrixXd cost =
      Eigen::MatrixXd::Constant(static_cast<Eigen::Index>(frames_of_person_.size()),
                                static_cast<Eigen::Index>(frames_of_track_.size()), most + 1.0);
  Eigen::Index row = 0;
  for (const auto& [person, frames] : frames_of_person_) {
    Eigen::Index column = 0;
    for (const auto& [track, track_total] : frames_of_track_) {
      const auto tracks = frames_of_both_.find(person);
      if (tracks != frames_of_both_.end() && tracks->second.count(track) != 0) {
        cost(row, column) = most - tracks->second.at(track);
      }
      ++column;
    }
    ++row;
  }
  const std::vector<std::optional<int>> track_of = Assign(cost, most + 1e-3);
  double explained = 0;
  for (std::size_t person = 0; person < track_of.size(); ++person) {
    if (track_of[person]) {
      explained += most - cost(static_cast<Eigen::Index>(person), *track_of[person]);
    }
  }
  score.idf1 = 2 * explained / (people_frames + track_frames);
  score.id_precision = track_frames > 0 ? explained / track_frames : 1;
  score.id_recall = people_frames > 0 ? explained / people_frames : 1;
  return score;
}

}  // namespace airdos
