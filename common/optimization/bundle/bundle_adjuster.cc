#include "common/optimization/bundle/bundle_adjuster.h"

#include <optional>
#include <variant>

#include "common/optimization/bundle/bundle_graph.h"
#include "common/optimization/solver/ceres_minimizer.h"
#include "common/optimization/solver/structured_minimizer.h"

namespace airdos {
namespace {

/// Solves the graph as it is, and again after factors have been removed from it.
class Minimizer {
 public:
  Minimizer(const BundleOptions& bundle, FactorGraph* graph, std::vector<double>* memory) {
    options_.function_tolerance = bundle.function_tolerance;
    options_.steps_by_track = bundle.steps_by_track;
    if (bundle.solver == BundleSolver::kCeres) {
      minimizer_.emplace<CeresMinimizer>(graph);
    } else {
      minimizer_.emplace<StructuredMinimizer>(graph, memory);
    }
  }

  MinimizerSummary Minimize(int max_iterations) {
    options_.max_iterations = max_iterations;
    if (auto* ceres = std::get_if<CeresMinimizer>(&minimizer_)) return ceres->Minimize(options_);
    return std::get<StructuredMinimizer>(minimizer_).Minimize(options_);
  }

  std::optional<Matrix6d> PoseCovariance(int block) {
    if (auto* ceres = std::get_if<CeresMinimizer>(&minimizer_)) {
      return ceres->PoseCovariance(block, kUnobservedSigma);
    }
    return std::get<StructuredMinimizer>(minimizer_).PoseCovariance(block, kUnobservedSigma);
  }

 private:
  MinimizerOptions options_;
  std::variant<std::monostate, CeresMinimizer, StructuredMinimizer> minimizer_;
};

}  // namespace

BundleSummary SolveBundle(const BundleOptions& options, BundleProblem* problem,
                          std::vector<double>* memory) {
  for (BundleProblem::Human& human : problem->humans) {
    human.motions.clear();
    human.num_rigidity_rejected = 0;
    human.num_motion_rejected = 0;
  }
  BundleGraph graph(options, problem);
  Minimizer minimizer(options, graph.factor_graph(), memory);
  const MinimizerSummary first = minimizer.Minimize(options.max_iterations);
  MinimizerSummary last = first;
  if (options.max_iterations_after_rejection > 0 && graph.RejectOutliers() > 0) {
    last = minimizer.Minimize(options.max_iterations_after_rejection);
    last.num_iterations += first.num_iterations;
  }
  graph.WriteBack();

  BundleSummary summary = graph.summary();
  summary.has_converged = last.has_converged;
  summary.num_iterations = last.num_iterations;
  summary.initial_cost = first.initial_cost;
  summary.final_cost = last.final_cost;
  const int newest = graph.newest_pose();
  if (options.compute_covariance && newest >= 0) {
    summary.newest_covariance = minimizer.PoseCovariance(newest);
  }
  return summary;
}

}  // namespace airdos
