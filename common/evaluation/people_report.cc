#include "common/evaluation/people_report.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "common/evaluation/people_matching.h"

namespace airdos {
namespace {

constexpr double kSameTimeS = 0.001;
constexpr double kGoodLengthPercent = 5;

/// Index of the matched poses at a given time, if any.
std::optional<std::size_t> FindCamera(const MatchedTrajectories& cameras, double time_s) {
  for (std::size_t i = 0; i < cameras.estimate.size(); ++i) {
    if (std::abs(cameras.estimate[i].time_s - time_s) <= kSameTimeS) return i;
  }
  return std::nullopt;
}

/// Lists of joint errors (m) before and after the optimization.
struct JointErrorLists {
  std::vector<double> measured_m;
  std::vector<double> optimized_m;
  JointErrors Summary() const {
    return {ComputeStatistics(measured_m), ComputeStatistics(optimized_m)};
  }
};

LengthErrors SummaryOf(const std::vector<double>& signed_percent) {
  LengthErrors errors;
  std::vector<double> relative_percent;
  std::size_t num_good = 0;
  for (const double error : signed_percent) {
    relative_percent.push_back(std::abs(error));
    if (std::abs(error) <= kGoodLengthPercent) ++num_good;
  }
  errors.relative_percent = ComputeStatistics(relative_percent);
  errors.median_signed_percent = ComputeStatistics(signed_percent).median;
  if (!signed_percent.empty()) {
    errors.within_5_percent =
        100 * static_cast<double>(num_good) / static_cast<double>(signed_percent.size());
  }
  return errors;
}

/// What a track saw of a person.
struct PersonOnTrack {
  int num_frames = 0;
  double least_depth_m = 1e9;
  std::map<int, double> length_m;  ///< estimate at the last frame
  std::array<std::vector<double>, kNumSegments> true_length_m;
};

/// Accumulates errors frame by frame.
class PeopleEvaluator {
 public:
  void AddFrame(const std::vector<const PersonState*>& states, const TruePeople& truth,
                const TrajectoryPose& T_W_C, const TrajectoryPose& T_true_C);
  PeopleReport Report() const;

 private:
  void AddJoints(const PersonState& state, const TrajectoryPose& T_W_C, const Joints& truth_C);
  void AddLengths(const PersonState& state, std::int64_t person, const Joints& truth_C);

  PeopleReport counts_;
  std::set<std::int64_t> tracks_;
  IdentityEvaluator identity_;
  JointErrorLists all_;
  std::array<JointErrorLists, kNumDepthBands> by_depth_;
  std::map<std::pair<std::int64_t, std::int64_t>, PersonOnTrack> lengths_;  // (person, track)
};

void PeopleEvaluator::AddFrame(const std::vector<const PersonState*>& states,
                               const TruePeople& truth, const TrajectoryPose& T_W_C,
                               const TrajectoryPose& T_true_C) {
  std::map<std::int64_t, Joints> truth_C;
  std::set<std::int64_t> to_be_seen;
  for (const auto& [identity, person] : truth.people) {
    truth_C[identity] = InCamera(person.joints, T_true_C);
    if (IsToBeSeen(person, truth_C[identity])) to_be_seen.insert(identity);
  }
  std::vector<Joints> measured_C;
  std::map<std::int64_t, std::optional<std::int64_t>> person_of_track;
  for (const PersonState* state : states) {
    measured_C.push_back(InCamera(state->measured_W, T_W_C));
    tracks_.insert(state->track);
    person_of_track[state->track] = std::nullopt;
  }
  const std::map<std::size_t, std::int64_t> matches = MatchPeople(measured_C, truth_C);
  for (const auto& [index, person] : matches) {
    const PersonState& state = *states[index];
    person_of_track[state.track] = person;
    counts_.num_seen += to_be_seen.count(person);
    AddJoints(state, T_W_C, truth_C.at(person));
    AddLengths(state, person, truth_C.at(person));
  }
  counts_.num_states += states.size();
  counts_.num_matched += matches.size();
  counts_.num_to_be_seen += to_be_seen.size();
  identity_.AddFrame(to_be_seen, person_of_track);
}

void PeopleEvaluator::AddJoints(const PersonState& state, const TrajectoryPose& T_W_C,
                                const Joints& truth_C) {
  const Joints measured_C = InCamera(state.measured_W, T_W_C);
  const std::size_t band = DepthBand(MiddleDepth(truth_C));
  for (const auto& [joint, p_C] : InCamera(state.joints_W, T_W_C)) {
    const auto measured = measured_C.find(joint);
    const auto truth = truth_C.find(joint);
    if (measured == measured_C.end() || truth == truth_C.end()) continue;
    for (JointErrorLists* errors : {&all_, &by_depth_[band]}) {
      errors->optimized_m.push_back((p_C - truth->second).norm());
      errors->measured_m.push_back((measured->second - truth->second).norm());
    }
  }
}

void PeopleEvaluator::AddLengths(const PersonState& state, std::int64_t person,
                                 const Joints& truth_C) {
  PersonOnTrack& seen = lengths_[{person, state.track}];
  ++seen.num_frames;
  seen.least_depth_m = std::min(seen.least_depth_m, MiddleDepth(truth_C));
  seen.length_m = state.segment_length_m;
  for (std::size_t segment = 0; segment < kNumSegments; ++segment) {
    const auto a = truth_C.find(kSegments[segment].joint_a);
    const auto b = truth_C.find(kSegments[segment].joint_b);
    if (a == truth_C.end() || b == truth_C.end()) continue;
    seen.true_length_m[segment].push_back((a->second - b->second).norm());
  }
}

PeopleReport PeopleEvaluator::Report() const {
  PeopleReport report = counts_;
  report.num_tracks = tracks_.size();
  report.identity = identity_.Score();
  report.joint_errors = all_.Summary();
  for (std::size_t i = 0; i < kNumDepthBands; ++i) {
    report.joint_errors_by_depth[i] = by_depth_[i].Summary();
  }
  std::set<std::int64_t> people;
  std::vector<double> errors;
  std::array<std::vector<double>, kNumSegments> of_segment;
  std::array<std::vector<double>, kNumDepthBands> of_depth;
  for (const auto& [ids, seen] : lengths_) {
    people.insert(ids.first);
    if (seen.num_frames < kMinFramesForLengths) continue;
    for (const auto& [segment, length_m] : seen.length_m) {
      const double truth_m =
          ComputeStatistics(seen.true_length_m.at(static_cast<std::size_t>(segment))).mean;
      if (!(truth_m > 0)) continue;
      const double error_percent = 100 * (length_m / truth_m - 1);
      errors.push_back(error_percent);
      of_segment[static_cast<std::size_t>(segment)].push_back(error_percent);
      of_depth[DepthBand(seen.least_depth_m)].push_back(error_percent);
    }
  }
  report.num_people = people.size();
  report.lengths = SummaryOf(errors);
  std::transform(of_segment.begin(), of_segment.end(), report.lengths_by_segment.begin(),
                 SummaryOf);
  std::transform(of_depth.begin(), of_depth.end(), report.lengths_by_depth.begin(), SummaryOf);
  return report;
}

double ImprovementPercent(double before, double after) {
  return before > 0 ? 100 * (1 - after / before) : 0;
}

}  // namespace

std::size_t DepthBand(double depth_m) { return depth_m < 6 ? 0 : depth_m < 12 ? 1 : 2; }

double JointErrors::mean_improvement_percent() const {
  return ImprovementPercent(measured.mean, optimized.mean);
}

double JointErrors::median_improvement_percent() const {
  return ImprovementPercent(measured.median, optimized.median);
}

PeopleReport EvaluatePeople(const std::vector<PersonState>& estimate,
                            const std::vector<TruePeople>& truth,
                            const MatchedTrajectories& cameras) {
  PeopleEvaluator evaluator;
  for (const TruePeople& frame : truth) {
    const std::optional<std::size_t> camera = FindCamera(cameras, frame.time_s);
    if (!camera) continue;
    std::vector<const PersonState*> states;
    for (const PersonState& state : estimate) {
      if (std::abs(state.time_s - frame.time_s) <= kSameTimeS && !state.joints_W.empty()) {
        states.push_back(&state);
      }
    }
    evaluator.AddFrame(states, frame, cameras.estimate[*camera], cameras.ground_truth[*camera]);
  }
  return evaluator.Report();
}

}  // namespace airdos
