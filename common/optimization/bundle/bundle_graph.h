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
/// place; poses and motions are optimized in copies, which WriteBack() returns to the problem.
/// Internal to SolveBundle().
class BundleGraph {
 public:
  /// Neither argument is owned; both must outlive the graph.
  BundleGraph(const BundleOptions& options, BundleProblem* problem);

  FactorGraph* factor_graph() { return &graph_; }

  /// Removes the factors whose error at the current values exceeds their threshold, and marks them
  /// in the problem. Returns the number of factors removed.
  int RejectOutliers();
  /// Block of the newest frame's pose; -1 if that is fixed or there is none.
  int newest_pose() const;
  /// Copies poses and motions back to the problem.
  void WriteBack();
  /// The counts of factors and of rejected factors; all else keeps its defaults.
  const BundleSummary& summary() const { return summary_; }

 private:
  /// What a factor measures; decides its threshold.
  enum class Kind { kLandmark, kJoint, kRigidity, kMotion };
  /// A factor that may be rejected, and where that is recorded.
  struct Factor {
    int index;  ///< in the graph
    Kind kind;
    bool* is_rejected;  ///< may be null
    int* num_rejected;  ///< may be null
  };
  using JointState = BundleProblem::JointState;
  /// A joint and its block of unknowns.
  struct Point {
    JointState* state = nullptr;  ///< null if it was not seen
    int block = -1;
  };
  /// What one frame shows of one person.
  struct Sighting {
    int frame = 0;
    std::vector<Point> joints;  ///< indexed by the model's points
  };
  /// The same joint in two frames.
  using Pair = std::pair<Point, Point>;
  /// A motion to write back: of a rigid part (se3 not null), or the torso's velocity.
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
  /// Adds an unknown to the current track; `slice` as in FactorGraph.
  int AddTrackBlock(double* values, int size, int slice);
  static std::vector<Pair> SharedJoints(const std::vector<int>& wanted, const Sighting& before,
                                        const Sighting& after);
  static Eigen::Vector3d Centroid(const std::vector<Pair>& pairs);
  static Eigen::Vector3d MeanStep(const std::vector<Pair>& pairs);
  static BundleProblem::PartMotion StartMotion(const BundleProblem::Human& human, int part,
                                               const std::vector<Pair>& pairs);
  /// Block of each part's motion from one frame to the next; -1 if there is none.
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

  // The graph refers to the members above it.
  ceres::HuberLoss static_loss_;
  ceres::HuberLoss dynamic_loss_;
  std::unique_ptr<ceres::LossFunction> smoothness_loss_;  // may be null
  std::vector<PoseBlock> poses_;
  std::deque<PoseBlock> motions_;  // a deque, so that addresses stay valid
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
