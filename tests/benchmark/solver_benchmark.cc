// The solver of the bundle adjustment, ours against Ceres on the same graphs: processor time.
//
// BM_PaperProblem/<artic|rigid>/<variant>/<solver>: the paper's timing problem, the five files of
// that kind in the folder ba_problems of the test data, variants reproj (measurements only), worig
// (and motion), womot (and rigidity), full. One iteration of the benchmark solves one file from its
// start values at a function tolerance of 1e-6, graph and set-up included, with the same steps as
// Ceres (steps_by_track off), so that both end at the same cost; the counters are medians over the
// files.
//
// BM_Scaling/<people>/<window>/<solver>/<cold|warm>: 14 joints each, 300 static points, with the
// iterations and the tolerance that the optimizer has. Cold: poses by odometry, everything
// triangulated. Warm: one frame more on a window that is solved.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <string>
#include <vector>

#include "common/util/quantile.h"
#include "tests/support/ba_problem.h"
#include "tests/support/people_street.h"

namespace airdos {
namespace {

double ProcessorMs() {
  timespec now;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

std::vector<std::string> ProblemFiles(const std::string& kind) {
  const char* const data = std::getenv("AIRDOS_DATA_DIR");
  const std::string root = data != nullptr ? data : AIRDOS_SOURCE_DIR "/../shared/data";
  std::vector<std::string> files;
  std::error_code error;
  for (const auto& entry :
       std::filesystem::directory_iterator(root + "/ba_problems/" + kind, error)) {
    files.push_back(entry.path().string());
  }
  std::sort(files.begin(), files.end());
  return files;
}

struct Variant {
  std::string name;
  bool use_rigidity, use_motion;
};

void PaperProblem(benchmark::State& state, const std::string& kind, const Variant& variant,
                  BundleSolver solver) {
  const std::vector<std::string> files = ProblemFiles(kind);
  if (files.empty()) {
    state.SkipWithError("no folder ba_problems: set AIRDOS_DATA_DIR to the test data");
    return;
  }
  std::vector<BaProblem> problems;
  for (const std::string& file : files) problems.push_back(ReadBaProblem(file));
  std::vector<std::vector<double>> ms(files.size());
  std::vector<double> iterations(files.size()), costs(files.size());
  std::vector<double> memory;
  std::size_t i = 0;
  for (auto _ : state) {
    state.PauseTiming();
    BundleProblem problem = problems[i].problem;
    BundleOptions options = problems[i].options;
    options.use_rigidity = variant.use_rigidity;
    options.use_motion = variant.use_motion;
    options.solver = solver;
    options.steps_by_track = false;  // as Ceres goes, so that both end at the same cost
    state.ResumeTiming();
    const double start_ms = ProcessorMs();
    const BundleSummary summary = SolveBundle(options, &problem, &memory);
    ms[i].push_back(ProcessorMs() - start_ms);
    iterations[i] = summary.num_iterations;
    costs[i] = 2 * summary.final_cost;  // the reference has no 1/2
    i = (i + 1) % files.size();
  }
  std::vector<double> solve_ms, iteration_ms;
  for (std::size_t f = 0; f < files.size(); ++f) {
    if (ms[f].empty()) continue;
    solve_ms.push_back(Quantile(ms[f], 0.5));
    iteration_ms.push_back(solve_ms.back() / iterations[f]);
  }
  state.counters["median_ms"] = Quantile(solve_ms, 0.5);
  state.counters["ms_per_iteration"] = Quantile(iteration_ms, 0.5);
  state.counters["iterations"] = Quantile(iterations, 0.5);
  state.counters["cost"] = Quantile(costs, 0.5);
}

void Scaling(benchmark::State& state, int num_people, int window, BundleSolver solver,
             bool is_warm) {
  PeopleStreetOptions street;
  street.num_people = num_people;
  street.num_frames = window;
  BundleOptions options;
  options.solver = solver;
  options.compute_covariance = false;  // as the window has it where the static scene is strong
  BundleProblem start = MakePeopleStreet(street);
  if (is_warm) {
    BundleOptions until_converged = options;
    until_converged.max_iterations = 50;
    until_converged.max_iterations_after_rejection = 0;
    start = SlideWindow(until_converged, street);
  }
  std::vector<double> memory;
  std::vector<double> ms;
  double iterations = 0, cost = 0;
  for (auto _ : state) {
    state.PauseTiming();
    BundleProblem problem = start;
    state.ResumeTiming();
    const double start_ms = ProcessorMs();
    const BundleSummary summary = SolveBundle(options, &problem, &memory);
    ms.push_back(ProcessorMs() - start_ms);
    iterations = summary.num_iterations;
    cost = summary.final_cost;
  }
  state.counters["median_ms"] = Quantile(ms, 0.5);
  state.counters["ms_per_iteration"] = Quantile(ms, 0.5) / std::max(iterations, 1.0);
  state.counters["iterations"] = iterations;
  state.counters["cost"] = cost;
}

void RegisterAll() {
  const std::vector<std::pair<std::string, BundleSolver>> solvers = {
      {"ceres", BundleSolver::kCeres}, {"structured", BundleSolver::kStructured}};
  const std::vector<Variant> variants = {{"reproj", false, false},
                                         {"worig", false, true},
                                         {"womot", true, false},
                                         {"full", true, true}};
  for (const std::string kind : {"artic", "rigid"}) {
    for (const Variant& variant : variants) {
      for (const auto& [name, solver] : solvers) {
        const std::string label = "BM_PaperProblem/" + kind + "/" + variant.name + "/" + name;
        const BundleSolver with = solver;
        benchmark::RegisterBenchmark(label.c_str(), [=](benchmark::State& state) {
          PaperProblem(state, kind, variant, with);
        })->Unit(benchmark::kMillisecond);
      }
    }
  }
  for (const int people : {1, 5, 10, 30}) {
    for (const int window : {5, 10, 20, 40}) {
      for (const auto& [name, solver] : solvers) {
        for (const bool is_warm : {false, true}) {
          const std::string label = "BM_Scaling/" + std::to_string(people) + "/" +
                                    std::to_string(window) + "/" + name +
                                    (is_warm ? "/warm" : "/cold");
          const BundleSolver with = solver;
          benchmark::RegisterBenchmark(label.c_str(), [=](benchmark::State& state) {
            Scaling(state, people, window, with, is_warm);
          })->Unit(benchmark::kMillisecond);
        }
      }
    }
  }
}

}  // namespace
}  // namespace airdos

int main(int argc, char** argv) {
  airdos::RegisterAll();
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
}
