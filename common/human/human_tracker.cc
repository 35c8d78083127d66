#include "common/human/human_tracker.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <utility>

#include "common/human/assignment.h"
#include "common/human/shift_vote.h"

namespace airdos {

// A person in one frame: the left detection and, if there is one, the right detection with its
// sides made to agree.
struct HumanTracker::Observation {
  PersonDetection detection;
  std::optional<BodyKeypoints> right;
  SideSwap right_swap = SideSwap::kNone;  // applied to the right one to make it agree
};

HumanTracker::HumanTracker(const HumanTrackerOptions& options, HumanId first_id)
    : options_(options), flow_(options.flow), next_id_(first_id) {}

TrackedFrame HumanTracker::Process(const StereoCamera& camera, const PeopleFrame& frame) {
  const StereoImages images{frame.left_gray, frame.right_gray};
  const PersonPairing pairing = PairPeople(options_.matcher, camera, frame.left, frame.right);
  const std::vector<Observation> observations = Observe(camera, frame, pairing);
  flow_.SetImage(frame.left_gray);
  shift_px_ = flow_.shift_px();
  if (options_.use_shift_vote) {
    std::vector<PersonDetection> detections;
    for (const Observation& observation : observations) detections.push_back(observation.detection);
    shift_px_ = VoteShift(tracks_, detections, shift_px_);
  }
  PredictTracks();
  const std::vector<std::optional<int>> track_of = FindTracks(observations);

  TrackedFrame result;
  result.num_rejected = static_cast<int>(pairing.unpaired_right.size());
  std::vector<bool> is_seen(tracks_.size(), false);
  const auto report = [&result](std::optional<TrackedHuman> human) {
    if (human) result.humans.push_back(std::move(*human));
  };
  for (std::size_t i = 0; i < observations.size(); ++i) {
    if (track_of[i]) {
      const std::size_t track = static_cast<std::size_t>(*track_of[i]);
      is_seen[track] = true;
      report(Update(camera, images, observations[i], &tracks_[track]));
    } else if (observations[i].right) {
      report(Start(camera, images, observations[i]));
    } else {
      ++result.num_rejected;
    }
  }
  for (std::size_t track = 0; track < is_seen.size(); ++track) {
    if (is_seen[track]) continue;
    tracks_[track].Miss();
    report(Carry(camera, images, tracks_[track]));
  }
  tracks_.erase(std::remove_if(tracks_.begin(), tracks_.end(),
                               [this](const HumanTrack& track) {
                                 return track.num_missed() > options_.max_missed_frames;
                               }),
                tracks_.end());
  std::sort(result.humans.begin(), result.humans.end(),
            [](const TrackedHuman& a, const TrackedHuman& b) { return a.id < b.id; });
  return result;
}

void HumanTracker::PredictTracks() {
  std::vector<Eigen::Vector2d> from, guess;
  std::vector<std::pair<std::size_t, std::size_t>> owner;  // (track, joint)
  for (std::size_t track = 0; track < tracks_.size(); ++track) {
    const BodyKeypoints& left = tracks_[track].left();
    for (std::size_t joint = 0; joint < left.size(); ++joint) {
      if (left[joint].confidence < options_.track.min_confidence) continue;
      from.push_back(left[joint].uv_px());
      guess.push_back(tracks_[track].Guess(joint, shift_px_));
      owner.emplace_back(track, joint);
    }
  }
  const std::vector<std::optional<Eigen::Vector2d>> to = flow_.Follow(from, guess);
  std::vector<std::array<std::optional<Eigen::Vector2d>, kNumJoints>> moved(tracks_.size());
  for (std::size_t i = 0; i < to.size(); ++i) moved[owner[i].first][owner[i].second] = to[i];
  for (std::size_t track = 0; track < tracks_.size(); ++track) {
    tracks_[track].Predict(moved[track], shift_px_);
  }
}

std::vector<HumanTracker::Observation> HumanTracker::Observe(const StereoCamera& camera,
                                                             const PeopleFrame& frame,
                                                             const PersonPairing& pairing) const {
  const auto at = [](const std::vector<BodyKeypoints>& people, int i) -> const BodyKeypoints& {
    return people[static_cast<std::size_t>(i)];
  };
  const auto appearance = [&](const BodyKeypoints& left) {
    const cv::Mat& image = frame.left_color.empty() ? frame.left_gray : frame.left_color;
    return MeasureAppearance(image, left, options_.track.min_confidence);
  };
  std::vector<Observation> observations;
  for (const PersonPair& pair : pairing.pairs) {
    const BodyKeypoints& left = at(frame.left, pair.left);
    const double height_px = kPersonHeightM * pair.disparity_px / camera.baseline_m;
    observations.push_back({{left, pair.disparity_px, height_px, appearance(left)},
                            SwapSides(at(frame.right, pair.right), pair.right_swap),
                            pair.right_swap});
  }
  for (const int i : pairing.unpaired_left) {
    const BodyKeypoints& left = at(frame.left, i);
    observations.push_back(
        {{left, std::nullopt, 0, appearance(left)}, std::nullopt, SideSwap::kNone});
  }
  return observations;
}

std::vector<std::optional<int>> HumanTracker::FindTracks(
    const std::vector<Observation>& observations) const {
  std::vector<std::optional<int>> track_of(observations.size());
  std::vector<bool> is_taken(tracks_.size(), false);
  // People seen in both images come first: depth makes the association more certain.
  Associate(observations, true, options_.max_squared_sigmas, &is_taken, &track_of);
  if (options_.use_left_only) {
    Associate(observations, false, options_.left_only_max_squared_sigmas, &is_taken, &track_of);
  }
  return track_of;
}

void HumanTracker::Associate(const std::vector<Observation>& observations, bool is_stereo,
                             double max_squared_sigmas, std::vector<bool>* is_track_taken,
                             std::vector<std::optional<int>>* track_of) const {
  std::vector<std::size_t> rows, columns;
  for (std::size_t i = 0; i < observations.size(); ++i) {
    if (observations[i].right.has_value() == is_stereo) rows.push_back(i);
  }
  for (std::size_t track = 0; track < tracks_.size(); ++track) {
    if (!(*is_track_taken)[track]) columns.push_back(track);
  }
  Eigen::MatrixXd cost(rows.size(), columns.size());
  for (std::size_t r = 0; r < rows.size(); ++r) {
    for (std::size_t c = 0; c < columns.size(); ++c) {
      cost(static_cast<Eigen::Index>(r), static_cast<Eigen::Index>(c)) =
          tracks_[columns[c]]
              .Cost(observations[rows[r]].detection)
              .value_or(std::numeric_limits<double>::infinity());
    }
  }
  const std::vector<std::optional<int>> partner = Assign(cost, max_squared_sigmas);
  for (std::size_t r = 0; r < rows.size(); ++r) {
    if (!partner[r]) continue;
    const std::size_t track = columns[static_cast<std::size_t>(*partner[r])];
    (*track_of)[rows[r]] = static_cast<int>(track);
    (*is_track_taken)[track] = true;
  }
}

JointObservations HumanTracker::Triangulate(const StereoCamera& camera, const StereoImages& images,
                                            const Observation& observation,
                                            double disparity_px) const {
  if (observation.right) {
    return TriangulatePerson(options_.triangulator, camera, images, observation.detection.left,
                             *observation.right, disparity_px);
  }
  return TriangulateLeftOnly(options_.triangulator, camera, images, observation.detection.left,
                             disparity_px, 1);
}

bool HumanTracker::IsReported(const JointObservations& joints, int num_seen) const {
  return num_seen >= options_.min_seen_to_report && NumObserved(joints) >= options_.min_joints;
}

// About one image in sixty has a person's sides exchanged. If the two detections disagree, one of
// them is wrong and the track only has to tell which; if they agree, it is very rare that both are
// wrong.
SideSwap HumanTracker::FindSwap(const Observation& observation, const HumanTrack& track) const {
  const BodyKeypoints& left = observation.detection.left;
  if (observation.right_swap != SideSwap::kNone) {
    const bool is_left_wrong =
        track.HasSwap(left, observation.right_swap, options_.min_doubtful_swap_gain_squared_sigmas);
    return is_left_wrong ? observation.right_swap : SideSwap::kNone;
  }
  if (observation.right) return SideSwap::kNone;
  for (const SideSwap swap : kSideSwaps) {
    if (track.HasSwap(left, swap, options_.min_swap_gain_squared_sigmas)) return swap;
  }
  return SideSwap::kNone;
}

std::optional<TrackedHuman> HumanTracker::Update(const StereoCamera& camera,
                                                 const StereoImages& images,
                                                 Observation observation, HumanTrack* track) const {
  const SideSwap swap = FindSwap(observation, *track);
  observation.detection.left = SwapSides(observation.detection.left, swap);
  if (observation.right) observation.right = SwapSides(*observation.right, swap);
  track->Observe(observation.detection, shift_px_);
  const JointObservations joints = Triangulate(camera, images, observation, track->disparity_px());
  if (!IsReported(joints, track->num_seen())) return std::nullopt;
  return TrackedHuman{track->id(), joints};
}

std::optional<TrackedHuman> HumanTracker::Start(const StereoCamera& camera,
                                                const StereoImages& images,
                                                const Observation& observation) {
  tracks_.emplace_back(options_.track, next_id_, observation.detection);
  ++next_id_.value;
  const JointObservations joints =
      Triangulate(camera, images, observation, tracks_.back().disparity_px());
  if (!IsReported(joints, 1)) return std::nullopt;
  return TrackedHuman{tracks_.back().id(), joints};
}

std::optional<TrackedHuman> HumanTracker::Carry(const StereoCamera& camera,
                                                const StereoImages& images,
                                                const HumanTrack& track) const {
  if (track.num_missed() > options_.max_carried_frames) return std::nullopt;
  BodyKeypoints carried = track.left();
  for (std::size_t joint = 0; joint < carried.size(); ++joint) {
    if (!track.is_carried(joint)) carried[joint].confidence = 0;
  }
  const JointObservations joints =
      TriangulateLeftOnly(options_.triangulator, camera, images, carried, track.disparity_px(),
                          options_.carried_sigma_factor);
  if (!IsReported(joints, track.num_seen())) return std::nullopt;
  return TrackedHuman{track.id(), joints};
}

}  // namespace airdos
