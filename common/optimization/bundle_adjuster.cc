#include "common/optimization/bundle_adjuster.h"

#include <ceres/ordered_groups.h>
#include <ceres/solver.h>
#include <ceres/types.h>

#include <algorithm>
#include <initializer_list>
#include <memory>

#include "common/optimization/bundle_graph.h"
#include "common/util/check.h"

namespace airdos {
namespace {

/// On these graphs, of a few thousand unknowns with people, SuiteSparse takes twice the time of the
/// other two.
ceres::SparseLinearAlgebraLibraryType SparseLibrary() {
  for (const auto library : {ceres::EIGEN_SPARSE, ceres::CX_SPARSE, ceres::SUITE_SPARSE}) {
    if (ceres::IsSparseLinearAlgebraLibraryTypeAvailable(library)) return library;
  }
  AIRDOS_CHECK(false);
}

/// Without people the landmarks are eliminated first and the poses solved densely. People's points
/// are coupled with each other over segments and time, so there no set of unknowns is independent;
/// one sparse factorisation is then faster than any Schur ordering.
ceres::Solver::Options SolverOptions(const BundleOptions& options, const BundleGraph& graph) {
  ceres::Solver::Options solver;
  solver.num_threads = 1;
  solver.logging_type = ceres::SILENT;
  solver.function_tolerance = options.function_tolerance;
  solver.gradient_tolerance = 1e-12;
  solver.parameter_tolerance = 1e-10;
  if (graph.has_people()) {
    solver.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
    solver.sparse_linear_algebra_library_type = SparseLibrary();
  } else if (graph.landmark_blocks().empty()) {
    solver.linear_solver_type = ceres::DENSE_NORMAL_CHOLESKY;
  } else {
    solver.linear_solver_type = ceres::DENSE_SCHUR;
    solver.linear_solver_ordering = std::make_shared<ceres::ParameterBlockOrdering>();
    for (double* block : graph.landmark_blocks()) {
      solver.linear_solver_ordering->AddElementToGroup(block, 0);
    }
    for (double* block : graph.pose_blocks()) {
      solver.linear_solver_ordering->AddElementToGroup(block, 1);
    }
  }
  return solver;
}

/// One run of Levenberg-Marquardt. Returns the cost it started from.
double Minimize(int max_iterations, ceres::Solver::Options solver, BundleGraph* graph,
                BundleSummary* summary) {
  solver.max_num_iterations = max_iterations;
  ceres::Solver::Summary report;
  ceres::Solve(solver, &graph->ceres_problem(), &report);
  summary->final_cost = std::max(report.final_cost, 0.0);  // Ceres says -1 where it gave up
  summary->has_converged = report.termination_type == ceres::CONVERGENCE;
  summary->num_iterations += report.num_successful_steps + report.num_unsuccessful_steps;
  return std::max(report.initial_cost, 0.0);
}

}  // namespace

BundleSummary SolveBundle(const BundleOptions& options, BundleProblem* problem) {
  for (BundleProblem::Human& human : problem->humans) {
    human.motions.clear();
    human.num_rigidity_eliminated = 0;
    human.num_motion_eliminated = 0;
  }
  BundleGraph graph(options, problem);
  const ceres::Solver::Options solver = SolverOptions(options, graph);
  BundleSummary solve;
  solve.initial_cost = Minimize(options.max_iterations, solver, &graph, &solve);
  if (options.max_iterations_after_elimination > 0 && graph.Eliminate() > 0) {
    Minimize(options.max_iterations_after_elimination, solver, &graph, &solve);
  }
  graph.WriteBack();

  BundleSummary summary = graph.summary();
  summary.has_converged = solve.has_converged;
  summary.num_iterations = solve.num_iterations;
  summary.initial_cost = solve.initial_cost;
  summary.final_cost = solve.final_cost;
  if (options.compute_covariance) summary.newest_covariance = graph.NewestPoseCovariance();
  return summary;
}

}  // namespace airdos
