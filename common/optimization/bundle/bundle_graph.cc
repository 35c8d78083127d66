#include "common/optimization/bundle/bundle_graph.h"

#include <cmath>
#include <memory>

#include "common/optimization/factors/camera_acceleration_factor.h"
#include "common/util/check.h"

namespace airdos {
BundleGraph::BundleGraph(const BundleOptions& options, BundleProblem* problem)
    : options_(options),
      problem_(problem),
      static_loss_(options.huber_static_sigmas),
      dynamic_loss_(options.huber_dynamic_sigmas),
      smoothness_loss_(options.huber_smoothness_sigmas > 0
                           ? std::make_unique<ceres::HuberLoss>(options.huber_smoothness_sigmas)
                           : nullptr) {
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
    FactorGraph::Block block;
    block.values = poses_.back().data();
    block.size = kPoseBlockSize;
    block.kind = FactorGraph::Kind::kPose;
    block.is_constant = frame.is_fixed;
    pose_blocks_.push_back(graph_.AddBlock(block));
  }
}

void BundleGraph::AddLandmarks() {
  landmark_blocks_.reserve(problem_->landmarks.size());
  for (BundleProblem::Landmark& landmark : problem_->landmarks) {
    FactorGraph::Block block;
    block.values = landmark.p_W.data();
    block.kind = FactorGraph::Kind::kLandmark;
    landmark_blocks_.push_back(graph_.AddBlock(block));
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
  // Fixed landmarks cannot influence a pose, so they are kept out of the linear system.
  for (std::size_t i = 0; i < landmark_blocks_.size(); ++i) {
    const bool is_constant = problem_->landmarks[i].is_fixed || !is_seen_by_free_frame[i];
    if (is_constant) graph_.SetConstant(landmark_blocks_[i]);
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
    if (!(step_1_s > 0 && step_2_s > 0)) continue;  // no information if the clock stood still
    const auto block = [this](int frame) { return pose_blocks_[static_cast<std::size_t>(frame)]; };
    graph_.AddFactor(
        std::make_unique<CameraAccelerationFactor>(step_1_s, step_2_s, acceleration.sigma), nullptr,
        block(a), block(b), block(c));
  }
}

double BundleGraph::Threshold(Kind kind) const {
  switch (kind) {
    case Kind::kLandmark:
      return options_.reject_static_sigmas;
    case Kind::kJoint:
      return options_.reject_joint_sigmas;
    case Kind::kRigidity:
      return options_.reject_rigidity_sigmas;
    case Kind::kMotion:
      return options_.reject_motion_sigmas;
  }
  AIRDOS_CHECK(false);
}

void BundleGraph::CountRejected(const Factor& factor) {
  if (factor.is_rejected != nullptr) *factor.is_rejected = true;
  if (factor.num_rejected != nullptr) ++*factor.num_rejected;
  if (factor.kind == Kind::kRigidity) {
    ++summary_.num_rigidity_rejected;
  } else if (factor.kind == Kind::kMotion) {
    ++summary_.num_motion_rejected;
  } else {
    ++summary_.num_reprojection_rejected;
  }
}

int BundleGraph::RejectOutliers() {
  int num_rejected = 0;
  std::vector<Factor> kept;
  kept.reserve(factors_.size());
  for (const Factor& factor : factors_) {
    if (std::sqrt(graph_.SquaredError(factor.index)) <= Threshold(factor.kind)) {
      kept.push_back(factor);
      continue;
    }
    CountRejected(factor);
    graph_.RemoveFactor(factor.index);
    ++num_rejected;
  }
  factors_ = std::move(kept);
  return num_rejected;
}

int BundleGraph::newest_pose() const {
  return pose_blocks_.empty() || problem_->frames.back().is_fixed ? -1 : pose_blocks_.back();
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
