#include "common/optimization/solver/graph_linearizer.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/util/check.h"

namespace airdos {
namespace {

constexpr int kConstant = -1;
constexpr double kInvalid = std::numeric_limits<double>::quiet_NaN();

struct Weighted {
  double cost = 0;    // loss(|r|^2)
  double weight = 1;  // of the residual: sqrt(loss')
};

Weighted ApplyLoss(const ceres::LossFunction* loss, const double* residuals, int num) {
  double squared = 0;
  for (int i = 0; i < num; ++i) squared += residuals[i] * residuals[i];
  if (loss == nullptr) return {squared, 1};
  std::array<double, 3> rho = {};
  loss->Evaluate(squared, rho.data());
  AIRDOS_CHECK(!(rho[2] > 0));
  return {rho[0], std::sqrt(rho[1])};
}

}  // namespace

GraphLinearizer::GraphLinearizer(const FactorGraph& graph, const std::vector<int>& order,
                                 BlockMatrix* H)
    : graph_(graph), H_(H) {
  const int num_groups = H->num_groups();
  std::vector<int> place_of(graph.blocks().size(), kConstant);
  std::vector<int> group_of(graph.blocks().size(), num_groups - 1);
  for (int group = 0; group < num_groups; ++group) {
    for (int i = H->group_begin(group); i < H->group_begin(group + 1); ++i) {
      place_of[order[i]] = i;
      group_of[order[i]] = group;
    }
  }
  std::vector<std::vector<int>> factors(num_groups);
  for (int i = 0; i < static_cast<int>(graph.factors().size()); ++i) {
    const FactorGraph::Factor& factor = graph.factors()[i];
    if (factor.is_removed || graph.IsFixed(factor)) continue;
    int group = num_groups - 1;
    for (int k = 0; k < factor.num_blocks; ++k) group = std::min(group, group_of[factor.blocks[k]]);
    factors[group].push_back(i);
  }
  terms_.reserve(graph.factors().size());
  for (int group = 0; group < num_groups; ++group) {
    for (const int factor : factors[group]) {
      terms_.push_back(MakeTerm(factor, group, place_of));
    }
  }
  FindTermBegins(num_groups);
}

int GraphLinearizer::ShareBegin(int group) const {
  if (group == H_->num_groups() - 1) return H_->first_pose_scalar();
  return H_->num_scalars() + group * H_->num_pose_scalars();
}

void GraphLinearizer::FindTermBegins(int num_groups) {
  term_begins_.assign(num_groups + 1, terms_.size());
  for (std::size_t i = terms_.size(); i-- > 0;) term_begins_[terms_[i].group] = i;
  for (int group = num_groups - 1; group >= 0; --group) {
    term_begins_[group] = std::min(term_begins_[group], term_begins_[group + 1]);
  }
}

GraphLinearizer::Term GraphLinearizer::MakeTerm(int index, int group,
                                                const std::vector<int>& place_of) {
  const FactorGraph::Factor& factor = graph_.factors()[index];
  Term term;
  term.cost = factor.cost.get();
  term.loss = factor.loss;
  term.factor = index;
  term.group = group;
  term.num_residuals = factor.cost->num_residuals();
  term.num_blocks = factor.num_blocks;
  AIRDOS_CHECK(term.num_residuals <= FactorGraph::kMaxResiduals);
  std::array<int, kMaxBlocks> places = {};
  for (int i = 0; i < factor.num_blocks; ++i) {
    const FactorGraph::Block& block = graph_.block(factor.blocks[i]);
    places[i] = block.is_constant ? kConstant : place_of[factor.blocks[i]];
    AIRDOS_CHECK(block.is_constant || places[i] != kConstant);
    term.values[i] = block.values;
    term.sizes[i] = block.size;
    term.dims[i] = block.tangent_size();
    if (block.is_constant) {
      term.columns[i] = kConstant;
    } else if (block.kind == FactorGraph::Kind::kPose) {
      term.columns[i] = ShareBegin(group) + H_->begin(places[i]) - H_->first_pose_scalar();
    } else {
      term.columns[i] = H_->begin(places[i]);
    }
  }
  for (int i = 0; i < factor.num_blocks; ++i) {
    for (int j = 0; j < factor.num_blocks; ++j) {
      AIRDOS_CHECK(i == j || factor.blocks[i] != factor.blocks[j]);
      const bool is_upper = places[i] < places[j] || i == j;
      if (places[i] == kConstant || !is_upper) continue;
      term.products[term.num_products++] = {
          static_cast<std::uint8_t>(i), static_cast<std::uint8_t>(j),
          H_->Offset(places[i], places[j], group),
          FindAddProduct(term.num_residuals, term.dims[i], term.dims[j])};
    }
  }
  return term;
}

void GraphLinearizer::DropRemovedFactors(std::vector<char>* is_whole) {
  const auto is_removed = [&](const Term& term) {
    if (!graph_.factors()[term.factor].is_removed) return false;
    (*is_whole)[term.group] = false;
    return true;
  };
  terms_.erase(std::remove_if(terms_.begin(), terms_.end(), is_removed), terms_.end());
  FindTermBegins(num_groups());
}

double GraphLinearizer::FixedCost() const {
  double cost = 0;
  for (std::size_t i = 0; i < graph_.factors().size(); ++i) {
    const FactorGraph::Factor& factor = graph_.factors()[i];
    if (factor.is_removed || !graph_.IsFixed(factor)) continue;
    const double error = std::sqrt(graph_.SquaredError(static_cast<int>(i)));
    cost += ApplyLoss(factor.loss, &error, 1).cost;
  }
  return 0.5 * cost;
}

double GraphLinearizer::Cost(int group) const {
  double cost = 0;
  std::array<double, FactorGraph::kMaxResiduals> residuals = {};
  for (std::size_t i = term_begins_[group]; i < term_begins_[group + 1]; ++i) {
    const Term& term = terms_[i];
    if (!term.cost->Evaluate(term.values.data(), residuals.data(), nullptr)) return kInvalid;
    cost += ApplyLoss(term.loss, residuals.data(), term.num_residuals).cost;
  }
  return 0.5 * cost;
}

double GraphLinearizer::Linearize(int group, Eigen::VectorXd* gradient) {
  constexpr int kMaxJacobian = FactorGraph::kMaxResiduals * kPoseBlockSize;
  H_->SetZero(group);
  const int begin = H_->begin(H_->group_begin(group));
  gradient->segment(begin, H_->begin(H_->group_begin(group + 1)) - begin).setZero();
  gradient->segment(ShareBegin(group), H_->num_pose_scalars()).setZero();
  double* const H = H_->values();
  double cost = 0;
  std::array<double, FactorGraph::kMaxResiduals> residuals = {};
  std::array<std::array<double, kMaxJacobian>, kMaxBlocks> J = {};
  for (std::size_t t = term_begins_[group]; t < term_begins_[group + 1]; ++t) {
    const Term& term = terms_[t];
    std::array<double*, kMaxBlocks> jacobians = {};
    for (int i = 0; i < term.num_blocks; ++i) {
      if (term.columns[i] != kConstant) jacobians[i] = J[i].data();
    }
    if (!term.cost->Evaluate(term.values.data(), residuals.data(), jacobians.data())) {
      return kInvalid;
    }
    const Weighted weighted = ApplyLoss(term.loss, residuals.data(), term.num_residuals);
    cost += weighted.cost;
    for (int i = 0; i < term.num_residuals; ++i) residuals[i] *= weighted.weight;
    for (int i = 0; i < term.num_blocks; ++i) {
      if (term.columns[i] == kConstant) continue;
      const int size = term.sizes[i];
      if (weighted.weight != 1) {
        for (int k = 0; k < term.num_residuals * size; ++k) J[i][k] *= weighted.weight;
      }
      double* const g = gradient->data() + term.columns[i];
      for (int col = 0; col < term.dims[i]; ++col) {
        double sum = g[col];
        for (int row = 0; row < term.num_residuals; ++row) {
          sum += J[i][row * size + col] * residuals[row];
        }
        g[col] = sum;
      }
    }
    for (int p = 0; p < term.num_products; ++p) {
      const Product& product = term.products[p];
      product.add(J[product.first].data(), term.sizes[product.first], J[product.second].data(),
                  term.sizes[product.second], H + product.target);
    }
  }
  return 0.5 * cost;
}

}  // namespace airdos
