#include "common/optimization/sliding_window.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "common/optimization/camera_acceleration_factor.h"
#include "common/optimization/pose_information.h"
#include "common/optimization/reprojection_factor.h"
#include "common/util/check.h"

namespace airdos {
namespace {

/// Standard deviation of normal numbers around zero, from the median of their sizes.
double RobustSigma(std::vector<double> sizes) {
  const auto middle = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2);
  std::nth_element(sizes.begin(), middle, sizes.end());
  return 1.4826 * *middle;
}

int CountNewest(const BundleProblem& problem) {
  const int newest = static_cast<int>(problem.frames.size()) - 1;
  return static_cast<int>(
      std::count_if(problem.observations.begin(), problem.observations.end(),
                    [newest](const auto& o) { return o.frame == newest && !o.is_eliminated; }));
}

}  // namespace

SlidingWindowOptimizer::SlidingWindowOptimizer(const SlidingWindowOptions& options,
                                               const StereoCamera& camera)
    : options_(options), camera_(camera), map_(options.map) {}

FrameResult SlidingWindowOptimizer::Process(const FrameInput& input) {
  const bool is_first = trajectory_.empty();
  Prediction prediction;
  if (!is_first) prediction = Predict(input);
  const Se3 T_W_C_start = is_first ? input.T_W_C_odometry.value_or(Se3())
                                   : PoseOf(prediction.base) * prediction.T_Cbase_C;
  map_.AddFrame(camera_, input, T_W_C_start);
  if (input.T_W_C_odometry) {
    odometry_frame_ = input.id;
    T_W_C_odometry_ = input.T_W_C_odometry;
  }

  BundleProblem problem = map_.BuildProblem(camera_);
  AddAccelerations(&problem);
  FrameEstimate estimate;
  estimate.id = input.id;
  estimate.status = FrameEstimate::Status::kFirstFrame;
  std::vector<LandmarkId> removed;
  if (!is_first) {
    removed = SolveStatic(&problem, &estimate);
    UpdateTrajectory();
    if (estimate.status == FrameEstimate::Status::kPredicted) {
      // Only the smoothness of the camera placed this frame; the front end's guess knows more.
      map_.SetPose(input.id, PoseOf(prediction.base) * prediction.T_Cbase_C);
    }
  }
  UpdateTrajectory();

  estimate.T_W_C = PoseOf(input.id);
  estimate.T_W_C_without_people = estimate.T_W_C;
  estimate.T_W_C_with_people = estimate.T_W_C;
  estimate.num_window_frames = static_cast<int>(map_.window().size());
  estimate.num_static_landmarks = static_cast<int>(problem.landmarks.size());
  return {estimate, CollectChanges(std::move(removed))};
}

std::vector<LandmarkId> SlidingWindowOptimizer::SolveStatic(BundleProblem* problem,
                                                            FrameEstimate* estimate) {
  BundleOptions options = options_.bundle;
  options.use_people = false;
  estimate->summary = SolveBundle(options, problem);
  estimate->num_static_observations = CountNewest(*problem);
  estimate->covariance = NewestPoseInformation(*problem, options.huber_static).covariance;
  if (estimate->num_static_observations == 0) {
    estimate->status = FrameEstimate::Status::kPredicted;
  } else {
    estimate->status = estimate->summary.has_converged ? FrameEstimate::Status::kConverged
                                                       : FrameEstimate::Status::kNotConverged;
  }
  return map_.Absorb(*problem);
}

SlidingWindowOptimizer::Prediction SlidingWindowOptimizer::Predict(const FrameInput& input) const {
  const bool knows_base =
      std::any_of(trajectory_.begin(), trajectory_.end(),
                  [this](const TimedPose& entry) { return entry.id == odometry_frame_; });
  if (input.T_W_C_odometry && T_W_C_odometry_ && knows_base) {
    return {odometry_frame_, T_W_C_odometry_->inverse() * *input.T_W_C_odometry};
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
  const int kept = std::max(options_.camera_motion.history_frames, options_.map.window_frames + 1);
  while (static_cast<int>(trajectory_.size()) > kept) trajectory_.pop_front();
}

std::optional<AccelerationSigma> SlidingWindowOptimizer::EstimateAccelerationSigma() const {
  const CameraMotionOptions& options = options_.camera_motion;
  if (static_cast<int>(trajectory_.size()) < std::max(options.min_frames, 3)) return std::nullopt;
  std::vector<double> linear, angular;
  for (std::size_t i = 2; i < trajectory_.size(); ++i) {
    const TimedPose &a = trajectory_[i - 2], &b = trajectory_[i - 1], &c = trajectory_[i];
    const double step_1_s = b.time_s - a.time_s, step_2_s = c.time_s - b.time_s;
    if (!(step_1_s > 0 && step_2_s > 0)) continue;
    // With sigmas of one, the residuals of the factor are the accelerations themselves.
    const CameraAccelerationFactor factor(step_1_s, step_2_s, {1.0, 1.0});
    const PoseBlock poses[] = {ToPoseBlock(a.T_W_C), ToPoseBlock(b.T_W_C), ToPoseBlock(c.T_W_C)};
    const double* parameters[] = {poses[0].data(), poses[1].data(), poses[2].data()};
    Vector6d acceleration;
    factor.Evaluate(parameters, acceleration.data(), nullptr);
    for (int axis = 0; axis < 3; ++axis) {
      linear.push_back(std::abs(acceleration[axis]));
      angular.push_back(std::abs(acceleration[3 + axis]));
    }
  }
  if (linear.empty()) return std::nullopt;
  const auto limit = [&options](double spread, double floor, double ceiling) {
    return std::min(std::max(options.sigma_factor * spread, floor), std::max(floor, ceiling));
  };
  return AccelerationSigma{
      limit(RobustSigma(linear), options.floor.linear_m_s2, options.ceiling.linear_m_s2),
      limit(RobustSigma(angular), options.floor.angular_rad_s2, options.ceiling.angular_rad_s2)};
}

void SlidingWindowOptimizer::AddAccelerations(BundleProblem* problem) const {
  if (!options_.camera_motion.use_acceleration) return;
  const std::optional<AccelerationSigma> sigma = EstimateAccelerationSigma();
  if (!sigma) return;
  const int num_frames = static_cast<int>(problem->frames.size());
  const int first = num_frames - static_cast<int>(map_.window().size());
  for (int i = first + 2; i < num_frames; ++i) {
    problem->accelerations.push_back({{i - 2, i - 1, i}, *sigma});
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
