#include "processes/tools/ablation.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>

#include "common/evaluation/alignment.h"
#include "common/evaluation/statistics.h"
#include "common/evaluation/trajectory_error.h"

namespace airdos {
namespace {

std::shared_ptr<const ArticulatedModel> ModelOf(const MovingObject& object) {
  auto model = std::make_shared<ArticulatedModel>();
  model->num_points = static_cast<int>(object.points_W.front().size());
  for (const auto& [a, b] : object.segments) model->segments.push_back({a, b});
  model->body_points = object.body_points;
  model->parts = {object.body_points};
  return model;
}

/// The length of each segment as the points have it, in the mean over the frames.
void StartLengths(BundleProblem::Human* human) {
  std::map<std::pair<int, int>, const Eigen::Vector3d*> points;
  for (const BundleProblem::JointState& joint : human->joints) {
    points[{joint.frame, joint.joint}] = &joint.p_W;
  }
  const auto& segments = human->model->segments;
  human->known_length_m.assign(segments.size(), std::nullopt);
  human->segment_length_m.assign(segments.size(), std::nullopt);
  for (std::size_t segment = 0; segment < segments.size(); ++segment) {
    double sum_m = 0;
    int num = 0;
    for (const auto& [key, p_W] : points) {
      if (key.second != segments[segment].point_a) continue;
      const auto other = points.find({key.first, segments[segment].point_b});
      if (other == points.end()) continue;
      sum_m += (*p_W - *other->second).norm();
      ++num;
    }
    if (num > 0) human->segment_length_m[segment] = sum_m / num;
  }
}

TrajectoryPose ToTrajectoryPose(double time_s, const Se3& T_W_C) {
  return {time_s, T_W_C.rotation.toRotationMatrix(), T_W_C.translation};
}

}  // namespace

const char* NameOf(AblationRow row) {
  switch (row) {
    case AblationRow::kBefore:
      return "before";
    case AblationRow::kStatic:
      return "static";
    case AblationRow::kWithoutMotion:
      return "without motion";
    case AblationRow::kWithoutRigidity:
      return "without rigidity";
    case AblationRow::kFull:
      return "full";
  }
  return "";
}

const std::vector<AblationRow>& AblationRows() {
  static const std::vector<AblationRow> rows = {AblationRow::kBefore, AblationRow::kStatic,
                                                AblationRow::kWithoutMotion,
                                                AblationRow::kWithoutRigidity, AblationRow::kFull};
  return rows;
}

Ablation::Ablation(const AblationOptions& options, const SimulatedSequence& sequence)
    : options_(options), sequence_(sequence) {}

BundleProblem Ablation::MakeProblem(bool with_objects) const {
  const SimulationOptions& simulation = sequence_.options;
  BundleProblem problem;
  problem.camera = simulation.camera;
  std::map<int, int> num_seen;
  for (const SimulatedFrame& frame : sequence_.frames) {
    for (const SimulatedMeasurement& seen : frame.static_points) ++num_seen[seen.index];
  }
  const auto point_of = [&](const SimulatedMeasurement& seen) {
    std::optional<BundleProblem::PointMeasurement> point;
    if (simulation.has_point_noise) {
      point = BundleProblem::PointMeasurement{seen.p_C, std::max(simulation.point_sigma_m, 1e-3)};
    }
    return point;
  };
  const double sigma_px = std::max(simulation.pixel_sigma_px, 0.01);
  std::map<int, int> landmark_index;
  problem.humans.resize(with_objects ? sequence_.objects.size() : 0);
  for (std::size_t k = 0; k < sequence_.frames.size(); ++k) {
    const SimulatedFrame& frame = sequence_.frames[k];
    const int number = static_cast<int>(k);
    problem.frames.push_back({FrameId{number}, frame.time_s, frame.T_W_C_odometry, k == 0});
    for (const SimulatedMeasurement& seen : frame.static_points) {
      if (num_seen[seen.index] < 2) continue;  // says nothing
      const auto [it, is_new] =
          landmark_index.emplace(seen.index, static_cast<int>(problem.landmarks.size()));
      if (is_new) {
        problem.landmarks.push_back(
            {LandmarkId{seen.index}, frame.T_W_C_odometry * seen.p_C, false});
      }
      problem.observations.push_back(
          {number, it->second, seen.uvu_px, true, sigma_px, false, point_of(seen)});
    }
    if (!with_objects) continue;
    for (const SimulatedMeasurement& seen : frame.object_points) {
      problem.humans[static_cast<std::size_t>(seen.object)].joints.push_back(
          {number, seen.index, frame.T_W_C_odometry * seen.p_C, seen.uvu_px,
           sigma_px * sigma_px * Eigen::Matrix3d::Identity(), false, point_of(seen)});
    }
  }
  for (std::size_t i = 0; i < problem.humans.size(); ++i) {
    BundleProblem::Human& human = problem.humans[i];
    human.id.value = static_cast<std::int64_t>(i) + 1;
    human.model = ModelOf(sequence_.objects[i]);
    human.segment_length_m.assign(human.model->segments.size(), std::nullopt);
    human.known_length_m.assign(human.model->segments.size(), std::nullopt);
    if (!sequence_.objects[i].is_person) human.motion_form = MotionForm::kSe3Smooth;
  }
  return problem;
}

BundleOptions Ablation::MakeBundleOptions(AblationRow row) const {
  BundleOptions bundle;
  bundle.use_people = row >= AblationRow::kWithoutMotion;
  bundle.use_rigidity = row == AblationRow::kWithoutMotion || row == AblationRow::kFull;
  bundle.use_motion = row == AblationRow::kWithoutRigidity || row == AblationRow::kFull;
  bundle.compute_covariance = false;
  bundle.max_iterations = options_.max_iterations;
  bundle.max_iterations_after_elimination = 0;
  bundle.function_tolerance = options_.function_tolerance;
  bundle.rigidity_sigma_m = options_.rigidity_sigma_m;
  bundle.huber_smoothness = options_.huber_smoothness;
  return bundle;
}

void Ablation::LearnNoise(BundleProblem* problem) const {
  TrackBreakOptions breaks;
  breaks.camera_sigma_m = 0.03;  // adjusted poses are better than those it started from
  for (BundleProblem::Human& human : problem->humans) {
    human.track_breaks.merge(FindTrackBreaks(breaks, *problem, human));
    human.motion_noise = EstimateMotionNoise(options_.noise, *problem, human);
  }
}

BundleProblem Ablation::SolveWithPriorNoise(const BundleOptions& bundle) const {
  BundleOptions without_people = bundle;
  without_people.use_people = false;
  BundleProblem from_odometry = MakeProblem(true);
  for (BundleProblem::Human& human : from_odometry.humans) {
    human.track_breaks = FindTrackBreaks({}, from_odometry, human);
    human.motion_noise = options_.noise.prior;
  }
  BundleProblem from_static = from_odometry;
  SolveBundle(without_people, &from_static);
  for (std::size_t i = 0; i < from_static.humans.size(); ++i) {
    for (BundleProblem::JointState& joint : from_static.humans[i].joints) {
      const auto k = static_cast<std::size_t>(joint.frame);
      joint.p_W =
          from_static.frames[k].T_W_C * (from_odometry.frames[k].T_W_C.inverse() * joint.p_W);
    }
  }
  const double cost_from_odometry = SolveBundle(bundle, &from_odometry).final_cost;
  const double cost_from_static = SolveBundle(bundle, &from_static).final_cost;
  return cost_from_static < cost_from_odometry ? from_static : from_odometry;
}

BundleProblem Ablation::Solve(AblationRow row, bool* has_converged) const {
  const BundleOptions bundle = MakeBundleOptions(row);
  *has_converged = true;
  if (row == AblationRow::kBefore) return MakeProblem(true);
  BundleOptions loose = bundle;
  loose.use_rigidity = false;
  BundleProblem problem;
  BundleSummary summary;
  if (bundle.use_motion) {
    loose.function_tolerance = 1e-6;
    problem = SolveWithPriorNoise(loose);
    for (int pass = 0; pass < options_.num_noise_passes; ++pass) {
      if (pass > 0) SolveBundle(loose, &problem);
      LearnNoise(&problem);
    }
    loose.function_tolerance = bundle.function_tolerance;
  } else {
    problem = MakeProblem(true);
  }
  summary = SolveBundle(loose, &problem);
  if (bundle.use_rigidity) {
    // Tight factors start from a solution without them, and are drawn tight step by step.
    for (BundleProblem::Human& human : problem.humans) StartLengths(&human);
    loose.use_rigidity = true;
    loose.function_tolerance = 1e-4;
    for (const double factor : {30.0, 10.0, 3.0}) {
      loose.rigidity_sigma_m = factor * bundle.rigidity_sigma_m;
      SolveBundle(loose, &problem);
    }
    summary = SolveBundle(bundle, &problem);
  }
  *has_converged = summary.has_converged;
  return problem;
}

AblationErrors Ablation::Run(AblationRow row) const {
  bool has_converged = true;
  const BundleProblem problem = Solve(row, &has_converged);
  AblationErrors errors = Evaluate(problem);
  errors.has_converged = has_converged;
  return errors;
}

AblationErrors Ablation::Evaluate(const BundleProblem& problem) const {
  MatchedTrajectories matched;
  for (std::size_t k = 0; k < problem.frames.size(); ++k) {
    const double time_s = problem.frames[k].time_s;
    matched.estimate.push_back(ToTrajectoryPose(time_s, problem.frames[k].T_W_C));
    matched.ground_truth.push_back(ToTrajectoryPose(time_s, sequence_.frames[k].T_W_C));
  }
  AblationErrors errors;
  errors.ate_unaligned_m =
      ComputeStatistics(PositionErrors(matched.estimate, matched.ground_truth)).rmse;
  const Similarity alignment = ComputeAlignment(matched, Alignment::kSe3);
  errors.ate_aligned_m =
      ComputeStatistics(PositionErrors(Apply(alignment, matched.estimate), matched.ground_truth))
          .rmse;
  std::vector<double> steps_m, steps_deg, points_m;
  for (const RelativeError& error : ErrorsPerFrame(matched)) {
    steps_m.push_back(error.translation_m);
    steps_deg.push_back(error.rotation_deg);
  }
  errors.rpe_m = ComputeStatistics(steps_m).rmse;
  errors.rpe_deg = ComputeStatistics(steps_deg).rmse;
  for (std::size_t i = 0; i < problem.humans.size(); ++i) {
    for (const BundleProblem::JointState& joint : problem.humans[i].joints) {
      const auto k = static_cast<std::size_t>(joint.frame);
      const MovingObject& object =
          sequence_.objects[sequence_.TrueObject(static_cast<int>(i), joint.frame)];
      const Eigen::Vector3d& truth_W = object.points_W[k][static_cast<std::size_t>(joint.joint)];
      points_m.push_back((problem.frames[k].T_W_C.inverse() * joint.p_W -
                          sequence_.frames[k].T_W_C.inverse() * truth_W)
                             .norm());
    }
  }
  errors.dynamic_m = ComputeStatistics(points_m).rmse;
  return errors;
}

}  // namespace airdos
