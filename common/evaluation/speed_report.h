#ifndef AIRDOS_COMMON_EVALUATION_SPEED_REPORT_H_
#define AIRDOS_COMMON_EVALUATION_SPEED_REPORT_H_

#include <map>
#include <nlohmann/json_fwd.hpp>
#include <opencv2/core.hpp>
#include <optional>
#include <string>
#include <vector>

namespace airdos {

/// CPU ms of one process for a frame.
struct FrameTime {
  double p50_ms = 0;
  double p99_ms = 0;
  std::optional<double> peak_memory_mb;  ///< of the process, where it ran by itself
};

/// The whole chain on one sequence.
struct ChainSpeed {
  std::string sequence;
  int num_frames = 0;
  std::map<std::string, FrameTime> processes;  ///< by name, in one process each
  double serial_fps = 0;                       ///< airdos-replay, one thread
  double parallel_fps = 0;                     ///< airdos-replay, a thread for each process
  double replay_memory_mb = 0;                 ///< peak of the latter
  std::optional<double> live_fps;              ///< the processes in lock-step, over LCM
  std::optional<double> messages_per_s;        ///< that they exchanged then
};

/// One solve by one solver.
struct SolveTime {
  std::string problem;  ///< "artic/full", …, of the paper's timing problem; empty for scaling
  int num_people = 0;   ///< scaling only
  int window = 0;       ///< frames; scaling only
  std::string solver;
  bool is_warm = false;
  double cpu_ms = 0;
  std::optional<double> iteration_ms;
};

/// Rows of JSON as launch_scripts/benchmark/benchmark_speed.sh writes them. Throws InputError
/// naming file and row.
std::vector<ChainSpeed> ReadChainSpeeds(const std::string& path);
/// The file of airdos_solver_benchmark --benchmark_out_format=json; benchmarks of other names than
/// BM_PaperProblem/<data>/<variant>/<solver> and BM_Scaling/<people>/<window>/<solver>/<cold|warm>
/// are left out, those that failed too. Throws InputError if it is no such file.
std::vector<SolveTime> ReadSolveTimes(const std::string& path);

/// Tables; parts without figures are left out.
std::string ToMarkdown(const std::vector<ChainSpeed>& chains, const std::vector<SolveTime>& solves);
nlohmann::json ToJson(const std::vector<ChainSpeed>& chains, const std::vector<SolveTime>& solves);
/// How solving grows with people (at the window measured that is nearest to 20 frames) and with the
/// window (at the most people), both logarithmic, and what each process costs on each sequence.
/// 8-bit BGR.
cv::Mat DrawSpeed(const std::vector<ChainSpeed>& chains, const std::vector<SolveTime>& solves);

}  // namespace airdos

#endif  // AIRDOS_COMMON_EVALUATION_SPEED_REPORT_H_
