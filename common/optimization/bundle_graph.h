#ifndef AIRDOS_COMMON_OPTIMIZATION_BUNDLE_GRAPH_H_
#define AIRDOS_COMMON_OPTIMIZATION_BUNDLE_GRAPH_H_

#include <ceres/loss_function.h>
#include <ceres/problem.h>

#include <deque>
#include <vector>

#include "common/optimization/bundle_adjuster.h"
#include "common/optimization/bundle_problem.h"
#include "common/optimization/pose_manifold.h"

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
  struct Motion {
    int frame_km1;
    int frame;
    BundleProblem::Human* human;
    int part;
    Eigen::Vector3d centroid_W;
    double* block;
  };

  void AddPoses();
  void AddLandmarks();
  void AddAccelerations();
  void AddHuman(BundleProblem::Human* human);
  void AddJoints(BundleProblem::Human* human);
  void AddRigidity(BundleProblem::Human* human);
  void AddVelocities(BundleProblem::Human* human);
  void AddPartMotions(BundleProblem::Human* human);
  template <class Observation>
  void AddReprojection(const Observation& observation, bool has_right, double* p_W, Kind kind,
                       bool* is_eliminated);
  double Threshold(Kind kind) const;
  void CountEliminated(const Factor& factor);

  const BundleOptions& options_;
  BundleProblem* problem_;
  BundleSummary summary_;

  // The Ceres problem refers to what stands above it.
  PoseManifold manifold_;
  ceres::HuberLoss static_loss_;
  ceres::HuberLoss dynamic_loss_;
  std::vector<PoseBlock> poses_;
  std::deque<PoseBlock> motions_;  // addresses stay
  std::deque<Eigen::Vector3d> velocities_;
  ceres::Problem ceres_problem_;

  std::vector<double*> landmark_blocks_;
  std::vector<double*> pose_blocks_;
  std::vector<Factor> factors_;
  std::vector<Motion> part_motions_;
};

}  // namespace airdos

#endif  // AIRDOS_COMMON_OPTIMIZATION_BUNDLE_GRAPH_H_
