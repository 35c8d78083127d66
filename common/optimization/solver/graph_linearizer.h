#ifndef AIRDOS_COMMON_OPTIMIZATION_SOLVER_GRAPH_LINEARIZER_H_
#define AIRDOS_COMMON_OPTIMIZATION_SOLVER_GRAPH_LINEARIZER_H_

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "common/optimization/solver/block_matrix.h"
#include "common/optimization/solver/dense_kernels.h"
#include "common/optimization/solver/factor_graph.h"

namespace airdos {

/// Cost, gradient and Gauss-Newton Hessian of those factors of a graph that depend on a free
/// unknown.
/// A loss enters by weighting residual and Jacobian with sqrt(loss'), as in Ceres for losses that
/// are concave in the squared error. Huber's is; others are rejected.
class GraphLinearizer {
 public:
  /// `order`: the graph's block for each block of H. A factor belongs to the first group of H that
  /// it touches and contributes to that layer. Creates the blocks of H that the factors need. The
  /// graph and H must outlive this.
  GraphLinearizer(const FactorGraph& graph, const std::vector<int>& order, BlockMatrix* H);

  /// Drops the factors removed since the last call, and clears the flag of each group that lost
  /// any.
  void DropRemovedFactors(std::vector<char>* is_whole);
  int num_groups() const { return static_cast<int>(term_begins_.size()) - 1; }
  /// 1/2 sum loss(|r|^2) of a group's factors at the graph's values; not finite if a factor cannot
  /// be evaluated.
  double Cost(int group) const;
  /// The same for all other factors.
  double FixedCost() const;
  /// Returns Cost() and fills the group's layer of H and its part of the gradient. The gradient is
  /// laid out like the right-hand sides of BlockElimination: each group has its share of the poses'
  /// part.
  double Linearize(int group, Eigen::VectorXd* gradient);

 private:
  static constexpr std::size_t kMaxBlocks = FactorGraph::kMaxBlocks;
  static constexpr std::size_t kMaxPairs = kMaxBlocks * (kMaxBlocks + 1) / 2;
  /// A pair of a factor's blocks, and where their product goes in H.
  struct Product {
    std::uint8_t first = 0, second = 0;  ///< blocks of the factor
    int target = 0;                      ///< offset in H
    AddProduct add = nullptr;
  };
  /// A factor of the graph with its places in H and in the gradient.
  struct Term {
    const ceres::CostFunction* cost = nullptr;
    const ceres::LossFunction* loss = nullptr;
    int factor = 0;
    int group = 0;
    int num_residuals = 0;
    int num_blocks = 0;
    int num_products = 0;
    std::array<const double*, kMaxBlocks> values = {};
    std::array<int, kMaxBlocks> sizes = {};
    std::array<int, kMaxBlocks> dims = {};
    std::array<int, kMaxBlocks> columns = {};  ///< in the gradient; -1 for a constant block
    std::array<Product, kMaxPairs> products = {};
  };

  Term MakeTerm(int factor, int group, const std::vector<int>& place_of);
  /// Where the group's share of the poses' gradient begins.
  int ShareBegin(int group) const;
  void FindTermBegins(int num_groups);

  const FactorGraph& graph_;
  BlockMatrix* H_;
  std::vector<Term> terms_;  // sorted by group
  std::vector<std::size_t> term_begins_;
};

}  // namespace airdos

#endif  // AIRDOS_COMMON_OPTIMIZATION_SOLVER_GRAPH_LINEARIZER_H_
