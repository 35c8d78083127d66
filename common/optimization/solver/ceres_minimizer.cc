#include "common/optimization/solver/ceres_minimizer.h"

#include <ceres/crs_matrix.h>
#include <ceres/ordered_groups.h>
#include <ceres/solver.h>
#include <ceres/types.h>

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <algorithm>
#include <initializer_list>
#include <memory>

#include "common/util/check.h"

namespace airdos {
namespace {

using Block = FactorGraph::Block;
using Kind = FactorGraph::Kind;

ceres::Problem::Options ProblemOptions() {
  ceres::Problem::Options options;
  options.manifold_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  options.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  options.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  options.disable_all_safety_checks = true;  // they take a third of the set-up time
  return options;
}

/// On these graphs, a few thousand unknowns with people, SuiteSparse takes twice as long as the
/// other two.
ceres::SparseLinearAlgebraLibraryType SparseLibrary() {
  for (const auto library : {ceres::EIGEN_SPARSE, ceres::CX_SPARSE, ceres::SUITE_SPARSE}) {
    if (ceres::IsSparseLinearAlgebraLibraryTypeAvailable(library)) return library;
  }
  AIRDOS_CHECK(false);
}

}  // namespace

CeresMinimizer::CeresMinimizer(FactorGraph* graph) : graph_(graph), problem_(ProblemOptions()) {
  for (const Block& block : graph_->blocks()) {
    if (block.is_on_manifold()) {
      problem_.AddParameterBlock(block.values, block.size, &manifold_);
    } else {
      problem_.AddParameterBlock(block.values, block.size);
    }
    if (block.is_constant) problem_.SetParameterBlockConstant(block.values);
    has_tracks_ = has_tracks_ || block.kind == Kind::kTrack;
    has_landmarks_ = has_landmarks_ || block.kind == Kind::kLandmark;
  }
  ids_.reserve(graph_->factors().size());
  for (const FactorGraph::Factor& factor : graph_->factors()) {
    std::array<double*, FactorGraph::kMaxBlocks> values = {};
    for (std::size_t i = 0; i < static_cast<std::size_t>(factor.num_blocks); ++i) {
      values[i] = graph_->block(factor.blocks[i]).values;
    }
    ids_.push_back(problem_.AddResidualBlock(factor.cost.get(),
                                             const_cast<ceres::LossFunction*>(factor.loss),
                                             values.data(), factor.num_blocks));
  }
}

void CeresMinimizer::DropRemovedFactors() {
  for (std::size_t i = 0; i < ids_.size(); ++i) {
    if (ids_[i] == nullptr || !graph_->factors()[i].is_removed) continue;
    problem_.RemoveResidualBlock(ids_[i]);
    ids_[i] = nullptr;
  }
}

/// Without people, the landmarks are eliminated first and the poses solved densely. With people,
/// points are coupled with each other by segments and over time, so that no set of unknowns is
/// independent, and one sparse factorisation is faster than any Schur ordering.
MinimizerSummary CeresMinimizer::Minimize(const MinimizerOptions& options) {
  DropRemovedFactors();
  ceres::Solver::Options solver;
  solver.num_threads = 1;
  solver.logging_type = ceres::SILENT;
  solver.max_num_iterations = options.max_iterations;
  solver.function_tolerance = options.function_tolerance;
  solver.gradient_tolerance = options.gradient_tolerance;
  solver.parameter_tolerance = options.parameter_tolerance;
  if (has_tracks_) {
    solver.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
    solver.sparse_linear_algebra_library_type = SparseLibrary();
  } else if (!has_landmarks_) {
    solver.linear_solver_type = ceres::DENSE_NORMAL_CHOLESKY;
  } else {
    solver.linear_solver_type = ceres::DENSE_SCHUR;
    solver.linear_solver_ordering = std::make_shared<ceres::ParameterBlockOrdering>();
    for (const Block& block : graph_->blocks()) {
      const int group = block.kind == Kind::kLandmark ? 0 : 1;
      solver.linear_solver_ordering->AddElementToGroup(block.values, group);
    }
  }
  ceres::Solver::Summary report;
  ceres::Solve(solver, &problem_, &report);
  MinimizerSummary summary;
  summary.initial_cost = std::max(report.initial_cost, 0.0);  // Ceres reports -1 on failure
  summary.final_cost = std::max(report.final_cost, 0.0);
  summary.has_converged = report.termination_type == ceres::CONVERGENCE;
  // Ceres reports -1 on failure.
  summary.num_iterations = std::max(report.num_successful_steps, 0);
  summary.num_iterations += std::max(report.num_unsuccessful_steps, 0);
  return summary;
}

std::optional<Matrix6d> CeresMinimizer::PoseCovariance(int block, double prior_sigma) {
  using Sparse = Eigen::SparseMatrix<double>;
  DropRemovedFactors();
  ceres::Problem::EvaluateOptions evaluate;
  evaluate.num_threads = 1;
  evaluate.parameter_blocks.push_back(graph_->block(block).values);  // of which six columns count
  // Not problem_.GetParameterBlocks(): its order is that of the addresses, so the last bits of the
  // result would depend on the memory layout.
  for (const Kind kind : {Kind::kPose, Kind::kLandmark, Kind::kTrack}) {
    for (const Block& other : graph_->blocks()) {
      if (other.kind != kind || other.is_constant) continue;
      if (other.values != graph_->block(block).values) {
        evaluate.parameter_blocks.push_back(other.values);
      }
    }
  }
  ceres::CRSMatrix rows;
  if (!problem_.Evaluate(evaluate, nullptr, nullptr, nullptr, &rows)) return std::nullopt;
  const Eigen::Map<const Eigen::SparseMatrix<double, Eigen::RowMajor>> J(
      rows.num_rows, rows.num_cols, static_cast<Eigen::Index>(rows.values.size()), rows.rows.data(),
      rows.cols.data(), rows.values.data());
  const Sparse J_columns = J;
  Sparse H = J_columns.transpose() * J_columns;
  Sparse prior(H.rows(), H.cols());
  prior.setIdentity();
  H += prior / (prior_sigma * prior_sigma);
  const Eigen::SimplicialLDLT<Sparse> factorisation(H);
  if (factorisation.info() != Eigen::Success) return std::nullopt;
  Eigen::MatrixXd unit = Eigen::MatrixXd::Zero(H.rows(), 6);
  unit.topRows<6>().setIdentity();
  const Matrix6d covariance = factorisation.solve(unit).topRows<6>();
  if (!covariance.allFinite()) return std::nullopt;
  return 0.5 * (covariance + covariance.transpose());
}

}  // namespace airdos
