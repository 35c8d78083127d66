#ifndef AIRDOS_COMMON_OPTIMIZATION_SOLVER_FACTOR_GRAPH_H_
#define AIRDOS_COMMON_OPTIMIZATION_SOLVER_FACTOR_GRAPH_H_

#include <ceres/cost_function.h>
#include <ceres/loss_function.h>

#include <array>
#include <memory>
#include <vector>

#include "common/optimization/solver/pose_manifold.h"

namespace airdos {

/// A least squares problem as blocks of unknowns and factors between them, which any of our
/// minimizers can take: cost = 1/2 sum loss(|r|^2). The factors are Ceres' cost functions, so that
/// there is one source of residuals and Jacobians. Values are not owned and change in place.
class FactorGraph {
 public:
  static constexpr int kMaxBlocks = 3;     ///< of a factor
  static constexpr int kMaxResiduals = 6;  ///< of a factor

  /// Where an unknown stands in the elimination; says nothing about what it means.
  enum class Kind {
    kLandmark,  ///< coupled with poses only
    kTrack,     ///< of one moving object: coupled within its track, and with poses
    kPose,
  };
  struct Block {
    static constexpr int kWholeTrack = -1;

    double* values = nullptr;
    /// Of `values`: 1, 3, or kPoseBlockSize for a rigid motion, with PoseManifold. dense_kernels.h
    /// has products for blocks of these sizes only; another one is to be added there first.
    int size = 3;
    Kind kind = Kind::kPose;
    bool is_constant = false;
    int track = 0;            ///< kTrack: which
    int slice = kWholeTrack;  ///< kTrack: its place in time, any number that grows with it

    bool is_on_manifold() const { return size == kPoseBlockSize; }
    int tangent_size() const { return is_on_manifold() ? 6 : size; }
  };
  struct Factor {
    std::unique_ptr<ceres::CostFunction> cost;
    const ceres::LossFunction* loss = nullptr;  ///< not owned; null: none
    int num_blocks = 0;
    std::array<int, kMaxBlocks> blocks = {};
    bool is_removed = false;
  };

  /// Both return the index of what they add. A programmer's error, in every build type: a block
  /// without values or of another size than above; a factor without residuals or with more than
  /// kMaxResiduals, of blocks that are not there or of another size than its cost function says.
  int AddBlock(const Block& block);
  template <class... Blocks>
  int AddFactor(std::unique_ptr<ceres::CostFunction> cost, const ceres::LossFunction* loss,
                Blocks... blocks) {
    static_assert(sizeof...(blocks) <= kMaxBlocks);
    return AddFactor({std::move(cost), loss, sizeof...(blocks), {blocks...}, false});
  }
  void SetConstant(int block) { blocks_[static_cast<std::size_t>(block)].is_constant = true; }
  /// Removed factors stay in place and count no more.
  void RemoveFactor(int factor) { factors_[static_cast<std::size_t>(factor)].is_removed = true; }

  const std::vector<Block>& blocks() const { return blocks_; }
  const std::vector<Factor>& factors() const { return factors_; }
  const Block& block(int index) const { return blocks_[static_cast<std::size_t>(index)]; }

  /// All blocks of the factor are constant: it only adds to the cost.
  bool IsFixed(const Factor& factor) const;
  /// |r|^2 before the loss; not finite where the factor cannot be evaluated.
  double SquaredError(int factor) const;

 private:
  int AddFactor(Factor factor);

  std::vector<Block> blocks_;
  std::vector<Factor> factors_;
};

/// What a minimizer is asked for and what it says.
struct MinimizerOptions {
  int max_iterations = 50;
  double function_tolerance = 1e-6;  ///< relative change of cost
  double gradient_tolerance = 1e-12;
  double parameter_tolerance = 1e-10;
  /// StructuredMinimizer only. A track that a step makes worse stays where it was and is damped
  /// more from then on, while the rest goes on; and what follows its linearization well is not
  /// linearized and eliminated again (see StructuredMinimizer). Else the whole step is taken or
  /// not, and everything is linearized anew, as Ceres does.
  bool steps_by_track = false;
};
struct MinimizerSummary {
  bool has_converged = false;
  int num_iterations = 0;  ///< steps that were tried, as Ceres counts them
  double initial_cost = 0;
  double final_cost = 0;
};

}  // namespace airdos

#endif  // AIRDOS_COMMON_OPTIMIZATION_SOLVER_FACTOR_GRAPH_H_
