#include "common/optimization/solver/factor_graph.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <memory>

namespace airdos {
namespace {

/// Has no meaning, only a shape.
class Cost : public ceres::CostFunction {
 public:
  Cost(int num_residuals, const std::vector<std::int32_t>& sizes) {
    set_num_residuals(num_residuals);
    *mutable_parameter_block_sizes() = sizes;
  }
  bool Evaluate(double const* const*, double* residuals, double**) const override {
    for (int i = 0; i < num_residuals(); ++i) residuals[i] = i + 1;
    return true;
  }
};

class FactorGraphTest : public testing::Test {
 protected:
  int AddBlock(int size) {
    FactorGraph::Block block;
    block.values = values_.data();
    block.size = size;
    return graph_.AddBlock(block);
  }
  int AddFactor(int num_residuals, const std::vector<std::int32_t>& sizes, int a, int b) {
    return graph_.AddFactor(std::make_unique<Cost>(num_residuals, sizes), nullptr, a, b);
  }

  std::array<double, 10> values_ = {};
  FactorGraph graph_;
};
using FactorGraphDeathTest = FactorGraphTest;

TEST_F(FactorGraphTest, TakesScalarsPointsAndMotions) {
  EXPECT_EQ(AddBlock(1), 0);
  EXPECT_EQ(AddBlock(3), 1);
  EXPECT_EQ(AddBlock(kPoseBlockSize), 2);
  EXPECT_EQ(graph_.block(0).tangent_size(), 1);
  EXPECT_EQ(graph_.block(1).tangent_size(), 3);
  EXPECT_EQ(graph_.block(2).tangent_size(), 6);
  EXPECT_EQ(AddFactor(2, {7, 1}, 2, 0), 0);
  EXPECT_EQ(AddFactor(FactorGraph::kMaxResiduals, {3, 3}, 1, 1), 1);
  EXPECT_EQ(graph_.SquaredError(0), 1 + 4);
}

// For two scalars the kernels would take those for six and write beyond the block.
TEST_F(FactorGraphDeathTest, RefusesBlocksThatTheKernelsDoNotKnow) {
  for (const int size : {-1, 0, 2, 4, 5, 6, 8}) {
    EXPECT_DEATH(AddBlock(size), "check failed: block.size == 1") << size;
  }
  EXPECT_DEATH(graph_.AddBlock({}), "check failed: block.values");
}

TEST_F(FactorGraphDeathTest, RefusesFactorsThatDoNotFitTheirBlocks) {
  AddBlock(1);
  AddBlock(3);
  EXPECT_DEATH(AddFactor(2, {1, 1}, 0, 1), "check failed: sizes.i. == block");
  EXPECT_DEATH(AddFactor(2, {1}, 0, 1), "check failed: sizes.size");
  EXPECT_DEATH(AddFactor(2, {1, 3}, 0, 2), "check failed: index >= 0");
  EXPECT_DEATH(AddFactor(2, {1, 3}, -1, 1), "check failed: index >= 0");
  EXPECT_DEATH(AddFactor(0, {1, 3}, 0, 1), "check failed: num_residuals");
  EXPECT_DEATH(AddFactor(FactorGraph::kMaxResiduals + 1, {1, 3}, 0, 1), "check failed: num_resid");
  EXPECT_DEATH(graph_.AddFactor(nullptr, nullptr, 0), "check failed: factor.cost");
}

}  // namespace
}  // namespace airdos
