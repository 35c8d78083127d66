#ifndef AIRDOS_COMMON_EVALUATION_SPEED_REPORT_H_
#define AIRDOS_COMMON_EVALUATION_SPEED_REPORT_H_

#include <map>
#include <nlohmann/json_fwd.hpp>
#include <opencv2/core.hpp>
#include <optional>
#include <string>
#include <vector>

namespace airdos {

/// CPU time of one process per frame, ms.
struct FrameTime {
  double p50_ms = 0;
  double p99_ms = 0;
  std::optional<double> peak_memory_mb;  ///< of the process, if it ran on its own
};

/// Speed of the whole chain on one sequence.
struct ChainSpeed {
  std::string sequence;
  int num_frames = 0;
  std::map<std::string, FrameTime> processes;  ///< by name, each in its own process
  double serial_fps = 0;                       ///< airdos-replay, one thread
  double parallel_fps = 0;                     ///< airdos-replay, one thread per process
  double replay_memory_mb = 0;                 ///< peak of the latter
  std::optional<double> live_fps;              ///< the processes in lockstep, over LCM
  std::optional<double> messages_per_s;        ///< exchanged in that run
};

/// Time of one solve with one solver.
struct SolveTime {
  std::string problem;  ///< "artic/full", … for the paper's timing problem; empty for scaling
  int num_people = 0;   ///< scaling only
  int window = 0;       ///< frames; scaling only
  std::string solver;
  bool is_warm = false;
  double cpu_ms = 0;
  std::optional<double> iteration_ms;
};

/// Reads rows of JSON as written by launch_scripts/benchmark/benchmark_speed.sh. Throws InputError
/// naming file and row.
std::vector<ChainSpeed> ReadChainSpeeds(const std::string& path);
/// Reads the output of airdos_solver_benchmark --benchmark_out_format=json. Benchmarks that failed,
/// or whose names are not BM_PaperProblem/<data>/<variant>/<solver> or
/// BM_Scaling/<people>/<window>/<solver>/<cold|warm>, are skipped. Throws InputError if it is no
/// such file.
std::vector<SolveTime> ReadSolveTimes(const std::string& path);

/// Markdown tables; parts without figures are left out.
std::string ToMarkdown(const std::vector<ChainSpeed>& chains, const std::vector<SolveTime>& solves);
nlohmann::json ToJson(const std::vector<ChainSpeed>& chains, const std::vector<SolveTime>& solves);
/// Draws how solving time grows with the number of people (at the measured window nearest to 20
/// frames) and with the window (at the largest number of people), both logarithmic, and what each
/// process costs on each sequence. 8-bit BGR.
cv::Mat DrawSpeed(const std::vector<ChainSpeed>& chains, const std::vector<SolveTime>& solves);

}  // namespace airdos

#endif  // AIRDOS_COMMON_EVALUATION_SPEED_REPORT_H_
