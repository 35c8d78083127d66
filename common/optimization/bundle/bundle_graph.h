#ifndef AIRDOS_COMMON_OPTIMIZATION_BUNDLE_BUNDLE_GRAPH_H_
#define AIRDOS_COMMON_OPTIMIZATION_BUNDLE_BUNDLE_GRAPH_H_

#include <ceres/loss_function.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <deque>
#include <memory>
#include <type_traits>
#include <utility>
#include <vector>

#include "common/optimization/bundle/bundle_options.h"
#include "common/optimization/bundle/bundle_problem.h"
#include "common/optimization/factors/camera_point_factor.h"
#include "common/optimization/factors/reprojection_factor.h"
#include "common/optimization/solver/factor_graph.h"
#include "common/optimization/solver/pose_manifold.h"

namespace airdos {

/// A BundleProblem as a graph of factors for a minimizer. Points and lengths are optimized in
/// place, poses and motions in blocks of this; WriteBack() copies these. Internal to SolveBundle().
class BundleGraph {
 public:
  /// Neither is owned; both must outlive the graph.
  BundleGraph(const BundleOptions& options, BundleProblem* problem);

  FactorGraph* factor_graph() { return &graph_; }

  /// Drops the factors whose error at the current values is above its threshold and marks them in
  /// the problem. Returns how many.
  int RejectOutliers();
  /// The block of the newest frame's pose; -1 where it is fixed or there is none.
  int newest_pose() const;
  /// Poses and motions into the problem.
  void WriteBack();
  /// The counts of factors and of rejected factors; the rest is left as it is.
  const BundleSummary& summary() const { return summary_; }

 private:
  enum class Kind { kLandmark, kJoint, kRigidity, kMotion };
  struct Factor {
    int index;  ///< in the graph
    Kind kind;
    bool* is_rejected;  ///< or null
    int* num_rejected;  ///< or null
  };
  using JointState = BundleProblem::JointState;
  /// A joint and its block of unknowns.
  struct Point {
    JointState* state = nullptr;  ///< null where it was not seen
    int block = -1;
  };
  /// What one person shows in one frame.
  struct Sighting {
    int frame = 0;
    std::vector<Point> joints;  ///< one per point of the model
  };
  /// A joint in two frames.
  using Pair = std::pair<Point, Point>;
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
  std::vector<Sighting> AddJoints(BundleProblem::Human* human);
  void AddRigidity(const std::vector<Sighting>& sightings, BundleProblem::Human* human);
  void AddVelocities(const std::vector<Sighting>& sightings, BundleProblem::Human* human);
  /// An unknown of the track that is being added; `slice` as in FactorGraph.
  int AddTrackBlock(double* values, int size, int slice);
  static std::vector<Pair> SharedJoints(const std::vector<int>& wanted, const Sighting& before,
                                        const Sighting& after);
  static Eigen::Vector3d Centroid(const std::vector<Pair>& pairs);
  static Eigen::Vector3d MeanStep(const std::vector<Pair>& pairs);
  static BundleProblem::PartMotion StartMotion(const BundleProblem::Human& human, int part,
                                               const std::vector<Pair>& pairs);
  /// The block of each part's motion from one frame to the next, -1 where there is none.
  using PartBlocks = std::vector<int>;
  PartBlocks AddPartMotions(const Sighting& before, const Sighting& after,
                            BundleProblem::Human* human);
  void AddSe3Motions(bool is_smooth, const std::vector<Sighting>& sightings,
                     BundleProblem::Human* human);
  void AddTrackMotions(const std::vector<Sighting>& sightings, BundleProblem::Human* human);
  MotionNoise NoiseOf(const BundleProblem::Human& human) const;
  void AddRotationDamping(const std::vector<const JointState*>& points, int motion);
  void AddMotionFactor(std::unique_ptr<ceres::CostFunction> cost, const Pair& pair, int motion,
                       BundleProblem::Human* human);
  double StepBetween(const Sighting& before, const Sighting& after,
                     const BundleProblem::Human& human) const;
  template <class Observation>
  void AddReprojection(Observation* observation, bool has_right, int point, Kind kind);
  double Threshold(Kind kind) const;
  void CountRejected(const Factor& factor);

  const BundleOptions& options_;
  BundleProblem* problem_;
  BundleSummary summary_;

  // The graph refers to what stands above it.
  ceres::HuberLoss static_loss_;
  ceres::HuberLoss dynamic_loss_;
  std::unique_ptr<ceres::LossFunction> smoothness_loss_;  // or null
  std::vector<PoseBlock> poses_;
  std::deque<PoseBlock> motions_;  // addresses stay
  std::deque<Eigen::Vector3d> velocities_;
  FactorGraph graph_;

  std::vector<int> landmark_blocks_;
  std::vector<int> pose_blocks_;
  int num_tracks_ = 0;
  std::vector<Factor> factors_;
  std::vector<Motion> found_motions_;
};

template <class Observation>
void BundleGraph::AddReprojection(Observation* observation, bool has_right, int point, Kind kind) {
  if (observation->is_rejected) return;
  const StereoCamera* camera = &problem_->camera;
  std::unique_ptr<ceres::CostFunction> cost;
  if (observation->point) {
    cost =
        std::make_unique<CameraPointFactor>(observation->point->p_C, observation->point->sigma_m);
  } else if constexpr (std::is_same_v<Observation, BundleProblem::JointState>) {
    const Eigen::Matrix3d information = observation->covariance_px2.inverse();
    cost = std::make_unique<ReprojectionFactor<3>>(camera, observation->uvu_px,
                                                   Eigen::Matrix3d(information.llt().matrixU()));
  } else if (has_right) {
    cost =
        std::make_unique<ReprojectionFactor<3>>(camera, observation->uvu_px, observation->sigma_px);
  } else {
    cost =
        std::make_unique<ReprojectionFactor<2>>(camera, observation->uvu_px, observation->sigma_px);
  }
  const ceres::LossFunction* loss = kind == Kind::kLandmark ? &static_loss_ : &dynamic_loss_;
  const int pose = pose_blocks_[static_cast<std::size_t>(observation->frame)];
  const int index = graph_.AddFactor(std::move(cost), loss, pose, point);
  factors_.push_back({index, kind, &observation->is_rejected, nullptr});
}

}  // namespace airdos

#endif  // AIRDOS_COMMON_OPTIMIZATION_BUNDLE_BUNDLE_GRAPH_H_
