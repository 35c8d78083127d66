#include "common/optimization/solver/factor_graph.h"

#include <cstdint>
#include <limits>
#include <utility>

#include "common/util/check.h"

namespace airdos {

int FactorGraph::AddBlock(const Block& block) {
  AIRDOS_CHECK(block.values != nullptr);
  AIRDOS_CHECK(block.size == 1 || block.size == 3 || block.size == kPoseBlockSize);
  blocks_.push_back(block);
  return static_cast<int>(blocks_.size()) - 1;
}

int FactorGraph::AddFactor(Factor factor) {
  AIRDOS_CHECK(factor.cost != nullptr);
  const int num_residuals = factor.cost->num_residuals();
  AIRDOS_CHECK(num_residuals >= 1 && num_residuals <= kMaxResiduals);
  const std::vector<std::int32_t>& sizes = factor.cost->parameter_block_sizes();
  AIRDOS_CHECK(sizes.size() == static_cast<std::size_t>(factor.num_blocks));
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    const int index = factor.blocks[i];
    AIRDOS_CHECK(index >= 0 && index < static_cast<int>(blocks_.size()));
    AIRDOS_CHECK(sizes[i] == block(index).size);
  }
  factors_.push_back(std::move(factor));
  return static_cast<int>(factors_.size()) - 1;
}

bool FactorGraph::IsFixed(const Factor& factor) const {
  for (int i = 0; i < factor.num_blocks; ++i) {
    if (!block(factor.blocks[static_cast<std::size_t>(i)]).is_constant) return false;
  }
  return true;
}

double FactorGraph::SquaredError(int index) const {
  const Factor& factor = factors_[static_cast<std::size_t>(index)];
  std::array<const double*, kMaxBlocks> values = {};
  for (std::size_t i = 0; i < static_cast<std::size_t>(factor.num_blocks); ++i) {
    values[i] = block(factor.blocks[i]).values;
  }
  std::array<double, kMaxResiduals> residuals = {};
  if (!factor.cost->Evaluate(values.data(), residuals.data(), nullptr)) {
    return std::numeric_limits<double>::quiet_NaN();
  }
  double sum = 0;
  for (int i = 0; i < factor.cost->num_residuals(); ++i) {
    sum += residuals[static_cast<std::size_t>(i)] * residuals[static_cast<std::size_t>(i)];
  }
  return sum;
}

}  // namespace airdos
