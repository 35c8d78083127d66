#include "processes/tools/evaluate/ablation.h"

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

/// The length of each segment according to the points, averaged over the frames.
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

std::optional<BundleProblem::PointMeasurement> PointOf(const SimulationOptions& options,
                                                       const SimulatedMeasurement& seen) {
  if (!options.has_point_noise) return std::nullopt;
  return BundleProblem::PointMeasurement{seen.p_C, std::max(options.point_sigma_m, 1e-3)};
}

double SigmaPx(const SimulationOptions& options) { return std::max(options.pixel_sigma_px, 0.01); }

void AddLandmarks(const SimulatedSequence& sequence, BundleProblem* problem) {
  std::map<int, int> num_seen;
  for (const SimulatedFrame& frame : sequence.frames) {
    for (const SimulatedMeasurement& seen : frame.static_points) ++num_seen[seen.index];
  }
  std::map<int, int> index;
  for (std::size_t k = 0; k < sequence.frames.size(); ++k) {
    const Se3& T_W_C = sequence.frames[k].T_W_C_odometry;
    for (const SimulatedMeasurement& seen : sequence.frames[k].static_points) {
      if (num_seen[seen.index] < 2) continue;  // not informative
      const auto [landmark, is_new] =
          index.emplace(seen.index, static_cast<int>(problem->landmarks.size()));
      if (is_new) {
        problem->landmarks.push_back({LandmarkId{seen.index}, T_W_C * seen.p_C, false});
      }
      problem->observations.push_back({static_cast<int>(k), landmark->second, seen.uvu_px, true,
                                       SigmaPx(sequence.options), false,
                                       PointOf(sequence.options, seen)});
    }
  }
}

void AddObjects(const SimulatedSequence& sequence, BundleProblem* problem) {
  for (std::size_t i = 0; i < sequence.objects.size(); ++i) {
    BundleProblem::Human human;
    human.id.value = static_cast<std::int64_t>(i) + 1;
    human.model = ModelOf(sequence.objects[i]);
    human.segment_length_m.assign(human.model->segments.size(), std::nullopt);
    human.known_length_m.assign(human.model->segments.size(), std::nullopt);
    if (!sequence.objects[i].is_person) human.motion_form = MotionForm::kSe3Smooth;
    problem->humans.push_back(std::move(human));
  }
  const double variance_px2 = SigmaPx(sequence.options) * SigmaPx(sequence.options);
  for (std::size_t k = 0; k < sequence.frames.size(); ++k) {
    const SimulatedFrame& frame = sequence.frames[k];
    for (const SimulatedMeasurement& seen : frame.object_points) {
      problem->humans[static_cast<std::size_t>(seen.object)].joints.push_back(
          {static_cast<int>(k), seen.index, frame.T_W_C_odometry * seen.p_C, seen.uvu_px,
           variance_px2 * Eigen::Matrix3d::Identity(), false, PointOf(sequence.options, seen)});
    }
  }
}

/// Moves the points of objects along with the camera, away from its poses in `from`.
void CarryObjects(const BundleProblem& from, BundleProblem* problem) {
  for (BundleProblem::Human& human : problem->humans) {
    for (BundleProblem::JointState& joint : human.joints) {
      const auto k = static_cast<std::size_t>(joint.frame);
      const Se3 T_C_W_before = from.frames[k].T_W_C.inverse();
      joint.p_W = problem->frames[k].T_W_C * (T_C_W_before * joint.p_W);
    }
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

BundleProblem Ablation::MakeProblem() const {
  BundleProblem problem;
  problem.camera = sequence_.options.camera;
  for (std::size_t k = 0; k < sequence_.frames.size(); ++k) {
    const SimulatedFrame& frame = sequence_.frames[k];
    problem.frames.push_back({FrameId{static_cast<std::int64_t>(k)}, frame.time_s,
                              frame.T_W_C_odometry, /*is_fixed=*/k == 0});
  }
  AddLandmarks(sequence_, &problem);
  AddObjects(sequence_, &problem);
  return problem;
}

BundleOptions Ablation::MakeBundleOptions(AblationRow row) const {
  BundleOptions bundle;
  bundle.use_people = row >= AblationRow::kWithoutMotion;
  bundle.use_rigidity = row == AblationRow::kWithoutMotion || row == AblationRow::kFull;
  bundle.use_motion = row == AblationRow::kWithoutRigidity || row == AblationRow::kFull;
  bundle.compute_covariance = options_.compute_covariance;
  bundle.max_iterations = options_.max_iterations;
  bundle.max_iterations_after_rejection = 0;
  bundle.function_tolerance = options_.function_tolerance;
  bundle.rigidity_sigma_m = sequence_.options.has_point_noise ? options_.rigidity_sigma_m
                                                              : options_.stereo_rigidity_sigma_m;
  bundle.person_speed_m_s = 0;  // the paper's simulation knows nothing of how fast people are
  return bundle;
}

void Ablation::LearnNoise(BundleProblem* problem) const {
  TrackBreakOptions breaks;
  breaks.camera_sigma_m = 0.03;  // adjusted poses are better than the start values
  for (BundleProblem::Human& human : problem->humans) {
    human.track_breaks.merge(FindTrackBreaks(breaks, *problem, human));
    human.motion_noise = EstimateMotionNoise(options_.noise, *problem, human);
  }
}

BundleProblem Ablation::SolveWithPriorNoise(const BundleOptions& bundle) const {
  BundleProblem from_odometry = MakeProblem();
  for (BundleProblem::Human& human : from_odometry.humans) {
    human.track_breaks = FindTrackBreaks({}, from_odometry, human);
    human.motion_noise = options_.noise.prior;
  }
  BundleProblem from_static = from_odometry;
  BundleOptions without_people = bundle;
  without_people.use_people = false;
  SolveBundle(without_people, &from_static);
  CarryObjects(from_odometry, &from_static);
  const double cost_from_odometry = SolveBundle(bundle, &from_odometry).final_cost;
  const double cost_from_static = SolveBundle(bundle, &from_static).final_cost;
  return cost_from_static < cost_from_odometry ? from_static : from_odometry;
}

BundleSummary Ablation::SolveMotion(BundleOptions bundle, BundleProblem* problem) const {
  const double function_tolerance = bundle.function_tolerance;
  bundle.use_rigidity = false;
  bundle.compute_covariance = false;
  bundle.function_tolerance = std::max(function_tolerance, 1e-6);
  *problem = SolveWithPriorNoise(bundle);
  for (int pass = 0; pass < options_.num_noise_passes; ++pass) {
    if (pass > 0) SolveBundle(bundle, problem);
    LearnNoise(problem);
  }
  bundle.function_tolerance = function_tolerance;
  bundle.compute_covariance = options_.compute_covariance;
  return SolveBundle(bundle, problem);
}

/// Tight factors start from a solution without them and are tightened step by step.
BundleSummary Ablation::SolveRigidity(const BundleOptions& bundle, BundleProblem* problem) const {
  for (BundleProblem::Human& human : problem->humans) StartLengths(&human);
  BundleOptions loose = bundle;
  loose.compute_covariance = false;
  loose.function_tolerance = 1e-4;
  for (const double factor : {30.0, 10.0, 3.0}) {
    loose.rigidity_sigma_m = factor * bundle.rigidity_sigma_m;
    SolveBundle(loose, problem);
  }
  return SolveBundle(bundle, problem);
}

Ablation::Solution Ablation::Solve(AblationRow row) const {
  const BundleOptions bundle = MakeBundleOptions(row);
  Solution solution;
  solution.problem = MakeProblem();
  solution.summary.has_converged = true;
  if (row == AblationRow::kBefore) return solution;
  if (bundle.use_motion) {
    solution.summary = SolveMotion(bundle, &solution.problem);
  } else {
    BundleOptions without_rigidity = bundle;
    without_rigidity.use_rigidity = false;
    const BundleProblem start = solution.problem;
    solution.summary = SolveBundle(without_rigidity, &solution.problem);
    if (!bundle.use_people) CarryObjects(start, &solution.problem);
  }
  if (bundle.use_rigidity) solution.summary = SolveRigidity(bundle, &solution.problem);
  return solution;
}

AblationErrors Ablation::Run(AblationRow row) const {
  const Solution solution = Solve(row);
  AblationErrors errors = Evaluate(solution.problem);
  errors.has_converged = solution.summary.has_converged;
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
