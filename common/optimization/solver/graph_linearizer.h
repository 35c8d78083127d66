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

/// Cost, gradient and Gauss-Newton Hessian of the factors of a graph that touch a free unknown.
/// Losses enter by weighting residual and Jacobian with sqrt(loss'), as Ceres does for losses that
/// are concave in the squared error (Huber's is; others are not let in).
class GraphLinearizer {
 public:
  /// `order`: the block of the graph behind each block of H. A factor belongs to the first group of
  /// H that it touches, and speaks in that layer. Makes the blocks of H that the factors need. Both
  /// graph and H must outlive this.
  GraphLinearizer(const FactorGraph& graph, const std::vector<int>& order, BlockMatrix* H);

  /// Leaves out factors that were removed since, and clears the flag of the groups that lost any.
  void DropRemovedFactors(std::vector<char>* is_whole);
  int num_groups() const { return static_cast<int>(term_begins_.size()) - 1; }
  /// 1/2 sum loss(|r|^2) of a group's factors at the graph's values; not finite where a factor
  /// cannot be evaluated.
  double Cost(int group) const;
  /// Likewise, of all other factors.
  double FixedCost() const;
  /// The same, with the group's layer of H and its part of the gradient, which is laid out as
  /// BlockElimination wants its right sides: each group has a share of the poses'.
  double Linearize(int group, Eigen::VectorXd* gradient);

 private:
  static constexpr std::size_t kMaxBlocks = FactorGraph::kMaxBlocks;
  static constexpr std::size_t kMaxPairs = kMaxBlocks * (kMaxBlocks + 1) / 2;
  struct Product {
    std::uint8_t first = 0, second = 0;  ///< blocks of the factor
    int target = 0;                      ///< offset in H
    AddProduct add = nullptr;
  };
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
    std::array<int, kMaxBlocks> columns = {};  ///< in the gradient; -1: constant
    std::array<Product, kMaxPairs> products = {};
  };

  Term MakeTerm(int factor, int group, const std::vector<int>& place_of);
  /// Where the group's part of the poses' gradient begins.
  int ShareBegin(int group) const;
  void FindTermBegins(int num_groups);

  const FactorGraph& graph_;
  BlockMatrix* H_;
  std::vector<Term> terms_;  // by group
  std::vector<std::size_t> term_begins_;
};

}  // namespace airdos

#endif  // AIRDOS_COMMON_OPTIMIZATION_SOLVER_GRAPH_LINEARIZER_H_
