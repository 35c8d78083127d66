#include "common/optimization/bundle_graph.h"

#include <cmath>

#include "common/optimization/camera_acceleration_factor.h"
#include "common/optimization/reprojection_factor.h"
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

template <class Observation>
void BundleGraph::AddReprojection(const Observation& observation, bool has_right, double* p_W,
                                  Kind kind, bool* is_eliminated) {
  ceres::CostFunction* cost = nullptr;
  if (has_right) {
    cost = new ReprojectionFactor<3>(&problem_->camera, observation.uvu_px, observation.sigma_px);
  } else {
    cost = new ReprojectionFactor<2>(&problem_->camera, observation.uvu_px, observation.sigma_px);
  }
  ceres::LossFunction* loss = kind == Kind::kLandmark ? &static_loss_ : &dynamic_loss_;
  double* pose = pose_blocks_[static_cast<std::size_t>(observation.frame)];
  const ceres::ResidualBlockId id = ceres_problem_.AddResidualBlock(cost, loss, pose, p_W);
  factors_.push_back({id, kind, is_eliminated, nullptr});
}

void BundleGraph::AddLandmarks() {
  landmark_blocks_.reserve(problem_->landmarks.size());
  for (BundleProblem::Landmark& landmark : problem_->landmarks) {
    ceres_problem_.AddParameterBlock(landmark.p_W.data(), 3);
    landmark_blocks_.push_back(landmark.p_W.data());
  }
  for (BundleProblem::LandmarkObservation& observation : problem_->observations) {
    observation.is_eliminated = false;
    AddReprojection(observation, observation.has_right,
                    landmark_blocks_[static_cast<std::size_t>(observation.landmark)],
                    Kind::kLandmark, &observation.is_eliminated);
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

void BundleGraph::WriteBack() {
  for (std::size_t i = 0; i < poses_.size(); ++i) {
    BundleProblem::Frame& frame = problem_->frames[i];
    if (!frame.is_fixed) frame.T_W_C = FromPoseBlock(poses_[i].data());
  }
  for (const Motion& motion : part_motions_) {
    motion.human->motions.push_back(
        {motion.frame, motion.part, motion.centroid_W, FromPoseBlock(motion.block)});
  }
}

}  // namespace airdos
