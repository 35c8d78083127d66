#include "common/optimization/window/sliding_window.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "common/optimization/factors/camera_acceleration_factor.h"
#include "common/optimization/factors/reprojection_factor.h"
#include "common/util/check.h"

namespace airdos {
namespace {

int CountNewest(const BundleProblem& problem) {
  const int newest = static_cast<int>(problem.frames.size()) - 1;
  return static_cast<int>(
      std::count_if(problem.observations.begin(), problem.observations.end(),
                    [newest](const auto& o) { return o.frame == newest && !o.is_rejected; }));
}

HumanTracksOptions PeopleOptions(const SlidingWindowOptions& options) {
  HumanTracksOptions people = options.people;
  people.window_frames = std::min(people.window_frames, options.map.window_frames);
  return people;
}

Matrix6d UnobservedCovariance() {
  return kUnobservedSigma * kUnobservedSigma * Matrix6d::Identity();
}

std::optional<Se3> FindPose(const BundleProblem& problem, FrameId id) {
  for (const BundleProblem::Frame& frame : problem.frames) {
    if (frame.id == id) return frame.T_W_C;
  }
  return std::nullopt;
}

/// Counts and iterations of both adjustments; cost and convergence of the trusted one.
BundleSummary Combine(const BundleSummary& without_people, const BundleSummary& with_people,
                      bool trusts_people) {
  BundleSummary summary = with_people;
  summary.num_iterations += without_people.num_iterations;
  summary.num_reprojection_rejected += without_people.num_reprojection_rejected;
  if (trusts_people) return summary;
  summary.has_converged = without_people.has_converged;
  summary.initial_cost = without_people.initial_cost;
  summary.final_cost = without_people.final_cost;
  return summary;
}

}  // namespace

SlidingWindowOptimizer::SlidingWindowOptimizer(const SlidingWindowOptions& options,
                                               const StereoCamera& camera)
    : options_(options), camera_(camera), map_(options.map), people_(PeopleOptions(options)) {}

FrameResult SlidingWindowOptimizer::Process(const FrameInput& input) {
  const bool is_first = trajectory_.empty();
  LearnCarrier(input);
  Prediction prediction;
  if (!is_first) prediction = Predict(input);
  const Se3 T_W_C_start = is_first ? input.T_W_C.value_or(input.T_O_C.value_or(Se3()))
                                   : PoseOf(prediction.base) * prediction.T_Cbase_C;
  map_.AddFrame(camera_, input, T_W_C_start);
  if (options_.bundle.use_people) people_.AddFrame(camera_, input);
  if (input.T_O_C) {
    odometry_frame_ = input.id;
    odometry_start_ = input.odometry_start;
    T_O_C_ = input.T_O_C;
  }

  FrameEstimate estimate;
  estimate.id = input.id;
  std::vector<LandmarkId> removed;
  if (is_first) {
    estimate.status = FrameEstimate::Status::kFirstFrame;
    estimate.T_W_C_without_people = estimate.T_W_C_with_people = T_W_C_start;
  } else {
    removed = Adjust(prediction, &estimate);
  }
  UpdateTrajectory();
  estimate.T_W_C = PoseOf(input.id);
  estimate.num_window_frames = static_cast<int>(map_.window().size());
  return {estimate, CollectChanges(std::move(removed))};
}

std::vector<LandmarkId> SlidingWindowOptimizer::Adjust(const Prediction& prediction,
                                                       FrameEstimate* estimate) {
  BundleProblem without_people = map_.BuildProblem(camera_);
  AddAccelerations(&without_people);
  BundleOptions options = options_.bundle;
  options.use_people = false;
  BundleSummary& summary = estimate->summary;
  summary = SolveBundle(options, &without_people, &solver_memory_);
  estimate->covariance = summary.newest_covariance.value_or(UnobservedCovariance());
  estimate->num_static_landmarks = static_cast<int>(without_people.landmarks.size());
  estimate->num_static_observations = CountNewest(without_people);
  const Se3 T_W_C_adjusted = without_people.frames.back().T_W_C;  // the covariance is about it
  bool is_predicted = estimate->num_static_observations == 0;
  if (is_predicted) {
    // Only the camera's smoothness placed this frame; the frontend's prediction knows more.
    const Se3 T_W_Cbase =
        FindPose(without_people, prediction.base).value_or(PoseOf(prediction.base));
    without_people.frames.back().T_W_C = T_W_Cbase * prediction.T_Cbase_C;
  }
  estimate->T_W_C_without_people = without_people.frames.back().T_W_C;
  estimate->T_W_C_with_people = estimate->T_W_C_without_people;

  const bool is_static_strong =
      estimate->num_static_observations >= options_.trust.min_static_observations;
  problem_ = ProblemWithPeople(without_people, estimate->covariance, is_static_strong);
  if (!problem_.humans.empty()) {
    options = options_.bundle;
    options.compute_covariance = !is_static_strong;
    const BundleSummary with_people = SolveBundle(options, &problem_, &solver_memory_);
    people_.Absorb(problem_);
    estimate->T_W_C_with_people = problem_.frames.back().T_W_C;
    estimate->trusts_people =
        TrustsPeople(options_.trust, estimate->num_static_observations, summary, with_people,
                     Boxminus(estimate->T_W_C_with_people, T_W_C_adjusted));
    if (estimate->trusts_people) estimate->covariance = *with_people.newest_covariance;
    summary = Combine(summary, with_people, estimate->trusts_people);
    is_predicted = is_predicted && !estimate->trusts_people;
  }
  estimate->status = is_predicted            ? FrameEstimate::Status::kPredicted
                     : summary.has_converged ? FrameEstimate::Status::kConverged
                                             : FrameEstimate::Status::kNotConverged;
  return map_.Absorb(estimate->trusts_people ? problem_ : without_people);
}

BundleProblem SlidingWindowOptimizer::ProblemWithPeople(const BundleProblem& without_people,
                                                        const Matrix6d& camera_covariance,
                                                        bool is_static_strong) const {
  BundleProblem problem = without_people;
  problem.humans.clear();
  if (!options_.bundle.use_people) return problem;
  // Where the static scene is strong, people are not believed anyway and must not move its points.
  for (BundleProblem::Landmark& landmark : problem.landmarks) landmark.is_fixed = is_static_strong;
  for (BundleProblem::Frame& frame : problem.frames) {
    if (frame.id < people_.frames().front()) frame.is_fixed = true;
  }
  people_.AddTo(&problem);
  if (options_.learn_track_noise) LearnTrackNoise(camera_covariance, &problem);
  return problem;
}

void SlidingWindowOptimizer::LearnTrackNoise(const Matrix6d& camera_covariance,
                                             BundleProblem* problem) const {
  TrackNoiseOptions noise;
  // A camera that does not know where it is cannot measure anybody's steps: the prior stays.
  const double sigma_m = std::sqrt(camera_covariance.topLeftCorner<3, 3>().trace() / 3);
  noise.camera_sigma_m = std::clamp(sigma_m, noise.camera_sigma_m, kUnobservedSigma);
  noise.prior.motion_sigma_m = options_.bundle.motion_sigma_m;
  noise.prior.acceleration_m_s2 = options_.bundle.person_acceleration_m_s2;
  for (BundleProblem::Human& human : problem->humans) {
    human.track_breaks = FindTrackBreaks(TrackBreakOptions(), *problem, human);
    human.motion_noise = EstimateMotionNoise(noise, *problem, human);
  }
}

SlidingWindowOptimizer::Prediction SlidingWindowOptimizer::Predict(const FrameInput& input) const {
  const bool knows_base =
      std::any_of(trajectory_.begin(), trajectory_.end(),
                  [this](const TimedPose& entry) { return entry.id == odometry_frame_; });
  if (input.T_O_C && T_O_C_ && knows_base && input.odometry_start == odometry_start_) {
    return {odometry_frame_, T_O_C_->inverse() * *input.T_O_C};
  }
  const TimedPose& last = trajectory_.back();
  if (trajectory_.size() < 2) return {last.id, Se3()};
  const TimedPose& before = trajectory_[trajectory_.size() - 2];
  const double step_s = last.time_s - before.time_s;
  const double ratio = step_s > 0 ? (input.time_s - last.time_s) / step_s : 1.0;
  const Vector6d step = Boxminus(last.T_W_C, before.T_W_C);
  return {last.id, Boxplus(Se3(), std::clamp(ratio, 0.0, 2.0) * step)};
}

const Se3& SlidingWindowOptimizer::PoseOf(FrameId id) const {
  const auto entry = std::find_if(trajectory_.begin(), trajectory_.end(),
                                  [id](const TimedPose& timed) { return timed.id == id; });
  AIRDOS_CHECK(entry != trajectory_.end());
  return entry->T_W_C;
}

void SlidingWindowOptimizer::UpdateTrajectory() {
  for (const FrameId id : map_.window()) {
    const WindowMap::Frame& frame = map_.frames().at(id);
    const auto entry = std::find_if(trajectory_.begin(), trajectory_.end(),
                                    [id](const TimedPose& timed) { return timed.id == id; });
    if (entry == trajectory_.end()) {
      trajectory_.push_back({id, frame.time_s, frame.T_W_C});
    } else {
      entry->T_W_C = frame.T_W_C;
    }
  }
  const int kept = options_.map.window_frames + 1;
  while (static_cast<int>(trajectory_.size()) > kept) trajectory_.pop_front();
}

void SlidingWindowOptimizer::LearnCarrier(const FrameInput& input) {
  if (trajectory_.empty() || !input.motion_sigma_position_m || !input.motion_sigma_orientation_rad)
    return;
  const double step_s = input.time_s - trajectory_.back().time_s;
  if (!(step_s > 0)) return;
  if (trajectory_.size() >= 2) {
    // When the clock jumped, the frontend predicted an ordinary step: its sigma does not apply to
    // this one.
    const double last_step_s =
        trajectory_.back().time_s - trajectory_[trajectory_.size() - 2].time_s;
    if (last_step_s > 0 && step_s >= 10 * last_step_s) return;
  }
  const double factor = options_.camera_motion.sigma_factor / (step_s * step_s);
  carrier_ = AccelerationSigma{factor * *input.motion_sigma_position_m,
                               factor * *input.motion_sigma_orientation_rad};
}

void SlidingWindowOptimizer::AddAccelerations(BundleProblem* problem) const {
  if (!options_.camera_motion.use_acceleration || !carrier_) return;
  const int num_frames = static_cast<int>(problem->frames.size());
  const int first = num_frames - static_cast<int>(map_.window().size());
  for (int i = first + 2; i < num_frames; ++i) {
    problem->accelerations.push_back({{i - 2, i - 1, i}, *carrier_});
  }
}

MapChanges SlidingWindowOptimizer::CollectChanges(std::vector<LandmarkId> removed) {
  MapChanges changes;
  changes.removed = std::move(removed);
  std::set<LandmarkId> seen;
  for (const FrameId id : map_.window()) {
    const WindowMap::Frame& frame = map_.frames().at(id);
    changes.frames.push_back({id, frame.time_s, frame.T_W_C});
    for (const auto& [landmark, observation] : frame.observations) seen.insert(landmark);
  }
  if (!people_.frames().empty()) {
    const auto describe = [&](FrameId id) {
      const Se3& T_W_C = map_.frames().at(id).T_W_C;
      for (HumanState& state : people_.Describe(id, T_W_C, problem_)) {
        changes.humans.push_back(std::move(state));
      }
    };
    if (people_.is_full()) describe(people_.frames().front());
    describe(people_.frames().back());
  }
  for (const LandmarkId id : seen) {
    const WindowMap::Landmark& landmark = map_.landmarks().at(id);
    if (!landmark.p_W) continue;
    if (landmark.published_p_W &&
        (*landmark.p_W - *landmark.published_p_W).norm() <= options_.publish_moved_m) {
      continue;
    }
    changes.landmarks.push_back(DescribeLandmark(id));
    map_.MarkPublished(id);
  }
  return changes;
}

MapChanges::Landmark SlidingWindowOptimizer::DescribeLandmark(LandmarkId id) const {
  const WindowMap::Landmark& landmark = map_.landmarks().at(id);
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  for (const FrameId frame_id : landmark.frames) {
    const WindowMap::Frame& frame = map_.frames().at(frame_id);
    const WindowMap::Observation& observation = frame.observations.at(id);
    const Eigen::Vector3d p_C = frame.T_W_C.inverse() * *landmark.p_W;
    if (p_C.z() < ReprojectionFactor<3>::kMinDepth_m) continue;
    Eigen::Matrix3d J = camera_.ProjectStereoJacobian(p_C) *
                        frame.T_W_C.rotation.toRotationMatrix().transpose() / observation.sigma_px;
    if (!observation.has_right) J.row(2).setZero();
    information += J.transpose() * J;
  }
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.computeDirect(information, Eigen::EigenvaluesOnly);
  const double least = solver.eigenvalues().minCoeff();
  const double sigma_m = least > 1e-8 ? 1 / std::sqrt(least) : kUnobservedSigma;
  return {id, *landmark.p_W, std::min(sigma_m, kUnobservedSigma),
          static_cast<int>(landmark.frames.size())};
}

}  // namespace airdos
