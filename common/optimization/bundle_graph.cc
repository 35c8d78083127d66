#include "common/optimization/bundle_graph.h"

#include <ceres/crs_matrix.h>

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <cmath>
#include <memory>

#include "common/optimization/camera_acceleration_factor.h"
#include "common/util/check.h"

namespace airdos {
namespace {

ceres::Problem::Options ProblemOptions() {
  ceres::Problem::Options options;
  options.manifold_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  options.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  options.disable_all_safety_checks = true;  // they cost a third of the set-up
  return options;
}

}  // namespace

BundleGraph::BundleGraph(const BundleOptions& options, BundleProblem* problem)
    : options_(options),
      problem_(problem),
      static_loss_(options.huber_static),
      dynamic_loss_(options.huber_dynamic),
      smoothness_loss_(options.huber_smoothness > 0
                           ? std::make_unique<ceres::HuberLoss>(options.huber_smoothness)
                           : nullptr),
      ceres_problem_(ProblemOptions()) {
  AddPoses();
  AddLandmarks();
  AddAccelerations();
  if (!options_.use_people) return;
  for (BundleProblem::Human& human : problem_->humans) AddHuman(&human);
}

void BundleGraph::AddPoses() {
  poses_.reserve(problem_->frames.size());
  for (const BundleProblem::Frame& frame : problem_->frames) {
    poses_.push_back(ToPoseBlock(frame.T_W_C));
    double* block = poses_.back().data();
    ceres_problem_.AddParameterBlock(block, kPoseBlockSize, &manifold_);
    if (frame.is_fixed) ceres_problem_.SetParameterBlockConstant(block);
    pose_blocks_.push_back(block);
  }
}

void BundleGraph::AddLandmarks() {
  landmark_blocks_.reserve(problem_->landmarks.size());
  for (BundleProblem::Landmark& landmark : problem_->landmarks) {
    ceres_problem_.AddParameterBlock(landmark.p_W.data(), 3);
    landmark_blocks_.push_back(landmark.p_W.data());
  }
  std::vector<bool> is_seen_by_free_frame(problem_->landmarks.size(), false);
  for (BundleProblem::LandmarkObservation& observation : problem_->observations) {
    const auto landmark = static_cast<std::size_t>(observation.landmark);
    AddReprojection(&observation, observation.has_right, landmark_blocks_[landmark],
                    Kind::kLandmark);
    if (!problem_->frames[static_cast<std::size_t>(observation.frame)].is_fixed) {
      is_seen_by_free_frame[landmark] = true;
    }
  }
  // The others cannot influence a pose: out of the linear system with them.
  for (std::size_t i = 0; i < landmark_blocks_.size(); ++i) {
    const bool is_constant = problem_->landmarks[i].is_fixed || !is_seen_by_free_frame[i];
    if (is_constant) ceres_problem_.SetParameterBlockConstant(landmark_blocks_[i]);
  }
}

void BundleGraph::AddAccelerations() {
  for (const BundleProblem::CameraAcceleration& acceleration : problem_->accelerations) {
    const auto [a, b, c] = acceleration.frames;
    const auto time_s = [this](int frame) {
      return problem_->frames[static_cast<std::size_t>(frame)].time_s;
    };
    const double step_1_s = time_s(b) - time_s(a);
    const double step_2_s = time_s(c) - time_s(b);
    if (!(step_1_s > 0 && step_2_s > 0)) continue;  // a clock that stood still says nothing
    const auto block = [this](int frame) { return pose_blocks_[static_cast<std::size_t>(frame)]; };
    ceres_problem_.AddResidualBlock(
        new CameraAccelerationFactor(step_1_s, step_2_s, acceleration.sigma), nullptr, block(a),
        block(b), block(c));
  }
}

double BundleGraph::Threshold(Kind kind) const {
  switch (kind) {
    case Kind::kLandmark:
      return options_.eliminate_static;
    case Kind::kJoint:
      return options_.eliminate_joint;
    case Kind::kRigidity:
      return options_.eliminate_rigidity;
    case Kind::kMotion:
      return options_.eliminate_motion;
  }
  AIRDOS_CHECK(false);
}

void BundleGraph::CountEliminated(const Factor& factor) {
  if (factor.is_eliminated != nullptr) *factor.is_eliminated = true;
  if (factor.num_eliminated != nullptr) ++*factor.num_eliminated;
  if (factor.kind == Kind::kRigidity) {
    ++summary_.num_rigidity_eliminated;
  } else if (factor.kind == Kind::kMotion) {
    ++summary_.num_motion_eliminated;
  } else {
    ++summary_.num_reprojection_eliminated;
  }
}

int BundleGraph::Eliminate() {
  int num_eliminated = 0;
  std::vector<Factor> kept;
  kept.reserve(factors_.size());
  for (const Factor& factor : factors_) {
    double half_squared_error = 0;
    ceres_problem_.EvaluateResidualBlock(factor.id, /*apply_loss_function=*/false,
                                         &half_squared_error, nullptr, nullptr);
    if (std::sqrt(2 * half_squared_error) <= Threshold(factor.kind)) {
      kept.push_back(factor);
      continue;
    }
    CountEliminated(factor);
    ceres_problem_.RemoveResidualBlock(factor.id);
    ++num_eliminated;
  }
  factors_ = std::move(kept);
  return num_eliminated;
}

std::optional<Matrix6d> BundleGraph::NewestPoseCovariance() {
  using Sparse = Eigen::SparseMatrix<double>;
  if (pose_blocks_.empty() || problem_->frames.back().is_fixed) return std::nullopt;
  double* newest = pose_blocks_.back();
  ceres::Problem::EvaluateOptions evaluate;
  evaluate.num_threads = 1;
  evaluate.parameter_blocks.push_back(newest);  // the first six columns
  // Not ceres_problem_.GetParameterBlocks(): that is in order of addresses, and the last bits of
  // the result would depend on where the memory happens to lie.
  for (const std::vector<double*>* blocks : {&pose_blocks_, &landmark_blocks_, &people_blocks_}) {
    for (double* block : *blocks) {
      if (block != newest && ceres_problem_.HasParameterBlock(block) &&
          !ceres_problem_.IsParameterBlockConstant(block)) {
        evaluate.parameter_blocks.push_back(block);
      }
    }
  }
  ceres::CRSMatrix rows;
  if (!ceres_problem_.Evaluate(evaluate, nullptr, nullptr, nullptr, &rows)) return std::nullopt;
  const Eigen::Map<const Eigen::SparseMatrix<double, Eigen::RowMajor>> J(
      rows.num_rows, rows.num_cols, static_cast<Eigen::Index>(rows.values.size()), rows.rows.data(),
      rows.cols.data(), rows.values.data());
  const Sparse J_columns = J;
  Sparse H = J_columns.transpose() * J_columns;
  Sparse prior(H.rows(), H.cols());
  prior.setIdentity();
  H += prior / (kUnobservedSigma * kUnobservedSigma);
  const Eigen::SimplicialLDLT<Sparse> factorisation(H);
  if (factorisation.info() != Eigen::Success) return std::nullopt;
  Eigen::MatrixXd unit = Eigen::MatrixXd::Zero(H.rows(), 6);
  unit.topRows<6>().setIdentity();
  const Matrix6d covariance = factorisation.solve(unit).topRows<6>();
  if (!covariance.allFinite()) return std::nullopt;
  return 0.5 * (covariance + covariance.transpose());
}

void BundleGraph::WriteBack() {
  for (std::size_t i = 0; i < poses_.size(); ++i) {
    BundleProblem::Frame& frame = problem_->frames[i];
    if (!frame.is_fixed) frame.T_W_C = FromPoseBlock(poses_[i].data());
  }
  for (const Motion& motion : found_motions_) {
    Se3 motion_W;
    if (motion.se3 != nullptr) {
      motion_W = FromPoseBlock(motion.se3);
    } else {
      motion_W.translation = motion.dt_s * Eigen::Map<const Eigen::Vector3d>(motion.velocity_m_s);
    }
    motion.human->motions.push_back({motion.frame, motion.part, motion.centroid_W, motion_W});
  }
}

}  // namespace airdos
