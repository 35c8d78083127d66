#ifndef AIRDOS_COMMON_OPTIMIZATION_BUNDLE_GRAPH_H_
#define AIRDOS_COMMON_OPTIMIZATION_BUNDLE_GRAPH_H_

#include <ceres/loss_function.h>
#include <ceres/problem.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <deque>
#include <memory>
#include <optional>
#include <type_traits>
#include <vector>

#include "common/optimization/bundle_adjuster.h"
#include "common/optimization/bundle_problem.h"
#include "common/optimization/camera_point_factor.h"
#include "common/optimization/pose_manifold.h"
#include "common/optimization/reprojection_factor.h"

namespace airdos {

/// A BundleProblem as a graph of Ceres factors. Points and lengths are optimized in place, poses
/// and motions in blocks of the graph; WriteBack() copies these. Internal to SolveBundle().
class BundleGraph {
 public:
  /// Neither is owned; both must outlive the graph.
  BundleGraph(const BundleOptions& options, BundleProblem* problem);

  ceres::Problem& ceres_problem() { return ceres_problem_; }
  bool has_people() const { return summary_.num_people > 0; }
  /// Unknowns that are independent of each other given all others: the static landmarks.
  const std::vector<double*>& landmark_blocks() const { return landmark_blocks_; }
  const std::vector<double*>& pose_blocks() const { return pose_blocks_; }

  /// Drops the factors whose error at the current values is above its threshold and marks them in
  /// the problem. Returns how many.
  int Eliminate();
  /// See BundleSummary::newest_covariance.
  std::optional<Matrix6d> NewestPoseCovariance();
  /// Poses and motions into the problem.
  void WriteBack();
  /// The counts of factors and of eliminated factors; the rest is left as it is.
  const BundleSummary& summary() const { return summary_; }

 private:
  enum class Kind { kLandmark, kJoint, kRigidity, kMotion };
  struct Factor {
    ceres::ResidualBlockId id;
    Kind kind;
    bool* is_eliminated;  ///< or null
    int* num_eliminated;  ///< or null
  };
  using JointState = BundleProblem::JointState;
  /// What one person shows in one frame; null where a joint was not seen.
  struct Sighting {
    int frame = 0;
    std::vector<JointState*> joints;  ///< one per point of the model
  };
  /// A motion to be written back: of a rigid part (se3 not null) or of the torso at a velocity.
  struct Motion {
    BundleProblem::Human* human;
    int frame;
    int part;
    Eigen::Vector3d centroid_W;
    const double* se3;
    const double* velocity_m_s;
    double dt_s;
  };

  void AddPoses();
  void AddLandmarks();
  void AddAccelerations();
  void AddHuman(BundleProblem::Human* human);
  std::vector<Sighting> Sightings(BundleProblem::Human* human) const;
  void AddRigidity(const std::vector<Sighting>& sightings, BundleProblem::Human* human);
  void AddVelocities(const std::vector<Sighting>& sightings, BundleProblem::Human* human);
  /// The motion of each part from one frame to the next, null where there is none.
  using PartBlocks = std::vector<double*>;
  PartBlocks AddPartMotions(const Sighting& before, const Sighting& after,
                            BundleProblem::Human* human);
  void AddSe3Motions(bool is_smooth, const std::vector<Sighting>& sightings,
                     BundleProblem::Human* human);
  void AddTrackMotions(const std::vector<Sighting>& sightings, BundleProblem::Human* human);
  MotionNoise NoiseOf(const BundleProblem::Human& human) const;
  void AddRotationDamping(const std::vector<const JointState*>& points, double* motion);
  void AddMotionFactor(ceres::CostFunction* cost, JointState* before, JointState* after,
                       double* motion, BundleProblem::Human* human);
  double StepBetween(const Sighting& before, const Sighting& after,
                     const BundleProblem::Human& human) const;
  template <class Observation>
  void AddReprojection(Observation* observation, bool has_right, double* p_W, Kind kind);
  double Threshold(Kind kind) const;
  void CountEliminated(const Factor& factor);

  const BundleOptions& options_;
  BundleProblem* problem_;
  BundleSummary summary_;

  // The Ceres problem refers to what stands above it.
  PoseManifold manifold_;
  ceres::HuberLoss static_loss_;
  ceres::HuberLoss dynamic_loss_;
  std::unique_ptr<ceres::LossFunction> smoothness_loss_;  // or null
  std::vector<PoseBlock> poses_;
  std::deque<PoseBlock> motions_;  // addresses stay
  std::deque<Eigen::Vector3d> velocities_;
  ceres::Problem ceres_problem_;

  std::vector<double*> landmark_blocks_;
  std::vector<double*> people_blocks_;  // in the order in which they were added
  std::vector<double*> pose_blocks_;
  std::vector<Factor> factors_;
  std::vector<Motion> found_motions_;
};

template <class Observation>
void BundleGraph::AddReprojection(Observation* observation, bool has_right, double* p_W,
                                  Kind kind) {
  if (observation->is_eliminated) return;
  const StereoCamera* camera = &problem_->camera;
  ceres::CostFunction* cost = nullptr;
  if (observation->point) {
    cost = new CameraPointFactor(observation->point->p_C, observation->point->sigma_m);
  } else if constexpr (std::is_same_v<Observation, BundleProblem::JointState>) {
    const Eigen::Matrix3d information = observation->covariance_px2.inverse();
    cost = new ReprojectionFactor<3>(camera, observation->uvu_px,
                                     Eigen::Matrix3d(information.llt().matrixU()));
  } else if (has_right) {
    cost = new ReprojectionFactor<3>(camera, observation->uvu_px, observation->sigma_px);
  } else {
    cost = new ReprojectionFactor<2>(camera, observation->uvu_px, observation->sigma_px);
  }
  ceres::LossFunction* loss = kind == Kind::kLandmark ? &static_loss_ : &dynamic_loss_;
  double* pose = pose_blocks_[static_cast<std::size_t>(observation->frame)];
  const ceres::ResidualBlockId id = ceres_problem_.AddResidualBlock(cost, loss, pose, p_W);
  factors_.push_back({id, kind, &observation->is_eliminated, nullptr});
}

}  // namespace airdos

#endif  // AIRDOS_COMMON_OPTIMIZATION_BUNDLE_GRAPH_H_
