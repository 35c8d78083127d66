#ifndef AIRDOS_COMMON_OPTIMIZATION_SOLVER_FACTOR_GRAPH_H_
#define AIRDOS_COMMON_OPTIMIZATION_SOLVER_FACTOR_GRAPH_H_

#include <ceres/cost_function.h>
#include <ceres/loss_function.h>

#include <array>
#include <memory>
#include <vector>

#include "common/optimization/solver/pose_manifold.h"

namespace airdos {

/// A least-squares problem as blocks of unknowns and factors between them, for any of our
/// minimizers: cost = 1/2 sum loss(|r|^2). The factors are Ceres cost functions, so residuals and
/// Jacobians are written only once. Values are not owned and are changed in place.
class FactorGraph {
 public:
  static constexpr int kMaxBlocks = 3;     ///< of a factor
  static constexpr int kMaxResiduals = 6;  ///< of a factor

  /// The role of an unknown in the elimination; says nothing about its meaning.
  enum class Kind {
    kLandmark,  ///< coupled with poses only
    kTrack,     ///< part of one moving object: coupled within its track and with poses
    kPose,
  };
  /// One unknown.
  struct Block {
    static constexpr int kWholeTrack = -1;

    double* values = nullptr;
    /// Of `values`: 1, 3, or kPoseBlockSize for a rigid motion, with PoseManifold. dense_kernels.h
    /// has products for blocks of these sizes only; another size must be added there first.
    int size = 3;
    Kind kind = Kind::kPose;
    bool is_constant = false;
    int track = 0;            ///< kTrack: its track
    int slice = kWholeTrack;  ///< kTrack: any number that increases with time

    bool is_on_manifold() const { return size == kPoseBlockSize; }
    int tangent_size() const { return is_on_manifold() ? 6 : size; }
  };
  /// One term of the cost, with the blocks that it depends on.
  struct Factor {
    std::unique_ptr<ceres::CostFunction> cost;
    const ceres::LossFunction* loss = nullptr;  ///< not owned; may be null
    int num_blocks = 0;
    std::array<int, kMaxBlocks> blocks = {};
    bool is_removed = false;
  };

  /// Both return the index of the new element. Fails a check, in every build type, on a programming
  /// error: a block without values or with another size than above; a factor without residuals or
  /// with more than kMaxResiduals, or with blocks that do not exist or differ in size from what its
  /// cost function says.
  int AddBlock(const Block& block);
  template <class... Blocks>
  int AddFactor(std::unique_ptr<ceres::CostFunction> cost, const ceres::LossFunction* loss,
                Blocks... blocks) {
    static_assert(sizeof...(blocks) <= kMaxBlocks);
    return AddFactor({std::move(cost), loss, sizeof...(blocks), {blocks...}, false});
  }
  void SetConstant(int block) { blocks_[static_cast<std::size_t>(block)].is_constant = true; }
  /// A removed factor keeps its index but no longer counts.
  void RemoveFactor(int factor) { factors_[static_cast<std::size_t>(factor)].is_removed = true; }

  const std::vector<Block>& blocks() const { return blocks_; }
  const std::vector<Factor>& factors() const { return factors_; }
  const Block& block(int index) const { return blocks_[static_cast<std::size_t>(index)]; }

  /// Whether all blocks of the factor are constant, so that it adds only a constant to the cost.
  bool IsFixed(const Factor& factor) const;
  /// |r|^2 before the loss; not finite if the factor cannot be evaluated.
  double SquaredError(int factor) const;

 private:
  int AddFactor(Factor factor);

  std::vector<Block> blocks_;
  std::vector<Factor> factors_;
};

/// Settings of a minimization.
struct MinimizerOptions {
  int max_iterations = 50;
  double function_tolerance = 1e-6;  ///< relative change of cost
  double gradient_tolerance = 1e-12;
  double parameter_tolerance = 1e-10;
  /// StructuredMinimizer only. A track that a step makes worse is put back and damped more from
  /// then on, while the rest proceeds; and a track that follows its linearization well is not
  /// linearized and eliminated again (see StructuredMinimizer). If false, each step is accepted or
  /// rejected as a whole and everything is linearized again, as in Ceres.
  bool steps_by_track = false;
};
/// Outcome of a minimization.
struct MinimizerSummary {
  bool has_converged = false;
  int num_iterations = 0;  ///< steps tried, counted as Ceres does
  double initial_cost = 0;
  double final_cost = 0;
};

}  // namespace airdos

#endif  // AIRDOS_COMMON_OPTIMIZATION_SOLVER_FACTOR_GRAPH_H_
