#include "common/evaluation/trajectory_doubts.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "common/evaluation/alignment.h"
#include "common/evaluation/statistics.h"
#include "common/evaluation/trajectory_error.h"
#include "common/evaluation/trajectory_times.h"
#include "common/util/error.h"

namespace airdos {
namespace {

/// The pose whose quaternion has the same four numbers in the other order.
TrajectoryPose InOtherOrder(const TrajectoryPose& pose, QuaternionOrder read) {
  const Eigen::Quaterniond q(pose.rotation);
  TrajectoryPose other = pose;
  const Eigen::Quaterniond reordered =
      read == QuaternionOrder::kXyzw
          ? Eigen::Quaterniond(q.x(), q.y(), q.z(), q.w())   // the first number is w
          : Eigen::Quaterniond(q.z(), q.w(), q.x(), q.y());  // the last number is w
  other.rotation = reordered.normalized().toRotationMatrix();
  return other;
}

int CountChanges(const PoseReading& reading) {
  return reading.has_other_order_in_estimate + reading.has_other_order_in_truth +
         reading.is_estimate_inverted + reading.is_truth_inverted;
}

/// Sorted by preference among those that fit equally well.
std::vector<PoseReading> OtherReadings(bool has_estimate_order, bool has_truth_order) {
  constexpr bool kInversions[][2] = {{false, false}, {true, false}, {false, true}};
  std::vector<PoseReading> readings;
  for (const bool(&inverted)[2] : kInversions) {
    for (const bool estimate_order : {false, true}) {
      for (const bool truth_order : {false, true}) {
        if ((estimate_order && !has_estimate_order) || (truth_order && !has_truth_order)) continue;
        const PoseReading reading = {estimate_order, truth_order, inverted[0], inverted[1]};
        if (CountChanges(reading) > 0) readings.push_back(reading);
      }
    }
  }
  return readings;
}

/// The agreement of a reading; 0 if its axes make a chance fit likely.
double AgreementOf(const PoseReading& reading, const MatchedTrajectories& reread) {
  constexpr double kMirrored = 0.97;
  const AxesDecision decision = DetectAxes(reread);
  if (CountChanges(reading) > 1 && !decision.axes.is_optical_or_ned()) return 0;
  if (!decision.axes.is_right_handed() && decision.agreement < kMirrored) return 0;
  return decision.best_agreement;
}

std::size_t CountRepeatedPartners(const std::vector<TrajectoryPose>& poses) {
  std::size_t num_repeated = 0;
  for (std::size_t i = 1; i < poses.size(); ++i) {
    if (poses[i].time_s == poses[i - 1].time_s) ++num_repeated;
  }
  return num_repeated;
}

}  // namespace

MatchedTrajectories MatchPoses(const Trajectory& estimate, const Trajectory& ground_truth,
                               double max_time_difference_s, Remarks* remarks) {
  MatchedTrajectories matched = Associate(estimate, ground_truth, max_time_difference_s);
  const std::size_t num_matched = matched.estimate.size();
  const std::size_t num_shorter = std::min(estimate.poses.size(), ground_truth.poses.size());
  const bool has_times = estimate.has_times && num_shorter > 0;
  const std::string counts = std::to_string(num_matched) + " of " +
                             std::to_string(estimate.poses.size()) +
                             " estimated poses match one of the " +
                             std::to_string(ground_truth.poses.size()) + " of the ground truth";
  const std::string times =
      has_times ? "; " + CompareTimes(estimate, ground_truth, max_time_difference_s) : "";
  if (num_matched < 2) {
    throw InputError("only " + counts + ", at least 2 are needed (see --max-diff)" + times);
  }
  if (2 * num_matched < num_shorter) remarks->push_back({true, "only " + counts + times});
  const std::size_t num_repeated = std::max(CountRepeatedPartners(matched.estimate),
                                            CountRepeatedPartners(matched.ground_truth));
  if (num_repeated > 0) {
    remarks->push_back({true, std::to_string(num_repeated) +
                                  " poses are matched with one that is already matched: "
                                  "--max-diff is larger than the interval, or times repeat"});
  }
  return matched;
}

MatchedTrajectories ReadAs(const PoseReading& reading, QuaternionOrder estimate_order,
                           QuaternionOrder truth_order, MatchedTrajectories matched) {
  for (TrajectoryPose& pose : matched.estimate) {
    if (reading.has_other_order_in_estimate) pose = InOtherOrder(pose, estimate_order);
    if (reading.is_estimate_inverted) pose = Inverse(pose);
  }
  for (TrajectoryPose& pose : matched.ground_truth) {
    if (reading.has_other_order_in_truth) pose = InOtherOrder(pose, truth_order);
    if (reading.is_truth_inverted) pose = Inverse(pose);
  }
  return matched;
}

std::optional<ReadingDoubt> FindBetterReading(const MatchedTrajectories& matched,
                                              QuaternionOrder estimate_order,
                                              QuaternionOrder truth_order) {
  constexpr double kMinAgreement = 0.9;
  constexpr double kClearlyBetter = 0.35;
  const double as_read = DetectAxes(matched).best_agreement;
  const std::vector<PoseReading> readings = OtherReadings(estimate_order != QuaternionOrder::kNone,
                                                          truth_order != QuaternionOrder::kNone);
  std::vector<double> agreements;
  for (const PoseReading& reading : readings) {
    agreements.push_back(
        AgreementOf(reading, ReadAs(reading, estimate_order, truth_order, matched)));
  }
  const double best = *std::max_element(agreements.begin(), agreements.end());
  std::optional<ReadingDoubt> doubt;
  for (std::size_t i = 0; i < readings.size(); ++i) {
    const bool is_better =
        agreements[i] >= kMinAgreement && 1 - agreements[i] < kClearlyBetter * (1 - as_read);
    const bool fits_as_best = 1 - agreements[i] <= 2 * (1 - best) + 0.005;
    if (!is_better || !fits_as_best) continue;
    if (!doubt) {
      doubt = ReadingDoubt{readings[i], agreements[i], as_read, false};
    } else if (doubt->reading.is_estimate_inverted && readings[i].is_truth_inverted) {
      doubt->do_both_inversions_fit = true;
    }
  }
  return doubt;
}

bool HasPositionsOnly(const std::vector<TrajectoryPose>& poses,
                      const std::vector<TrajectoryPose>& others) {
  constexpr double kMovesM = 0.05;
  constexpr double kTurnsDeg = 2;
  constexpr double kSame = 1e-9;
  const auto turns_by = [](const std::vector<TrajectoryPose>& all, std::size_t i) {
    return Eigen::Matrix3d(all[0].rotation.transpose() * all[i].rotation);
  };
  bool moves = false;
  bool others_turn = false;
  for (std::size_t i = 1; i < poses.size(); ++i) {
    if (!turns_by(poses, i).isIdentity(kSame)) return false;
    moves = moves || (poses[i].position_m - poses[0].position_m).norm() > kMovesM;
    others_turn = others_turn || RotationAngleDeg(turns_by(others, i)) > kTurnsDeg;
  }
  return moves && others_turn;
}

bool DoPositionsFit(const MatchedTrajectories& matched) {
  constexpr std::size_t kLeastPoses = 10;
  constexpr double kFits = 0.05;
  if (matched.estimate.size() < kLeastPoses) return false;
  const std::vector<TrajectoryPose>& truth = matched.ground_truth;
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const TrajectoryPose& pose : truth) mean += pose.position_m;
  mean /= static_cast<double>(truth.size());
  std::vector<double> distances_m;
  for (const TrajectoryPose& pose : truth) distances_m.push_back((pose.position_m - mean).norm());
  const Similarity sim3 = ComputeAlignment(matched, Alignment::kSim3);
  const Statistics errors =
      ComputeStatistics(PositionErrors(Apply(sim3, matched.estimate), matched.ground_truth));
  return errors.rmse < kFits * ComputeStatistics(distances_m).rmse;
}

std::size_t CountFrozenPoses(const MatchedTrajectories& matched) {
  constexpr double kMovesM = 0.001;
  constexpr double kTurnsDeg = 0.05;
  std::size_t num_frozen = 0;
  for (std::size_t i = 1; i < matched.estimate.size(); ++i) {
    const TrajectoryPose& before = matched.estimate[i - 1];
    const TrajectoryPose& pose = matched.estimate[i];
    const TrajectoryPose motion =
        RelativePose(matched.ground_truth[i - 1], matched.ground_truth[i]);
    const bool is_same = pose.position_m == before.position_m && pose.rotation == before.rotation;
    const bool truth_moves =
        motion.position_m.norm() > kMovesM || RotationAngleDeg(motion.rotation) > kTurnsDeg;
    if (is_same && truth_moves) ++num_frozen;
  }
  return num_frozen;
}

}  // namespace airdos
