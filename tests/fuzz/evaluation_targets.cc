#include <nlohmann/json.hpp>

#include "common/evaluation/help_curve.h"
#include "common/evaluation/help_curve_plot.h"
#include "common/evaluation/people_files.h"
#include "common/evaluation/people_report.h"
#include "common/evaluation/speed_report.h"
#include "common/evaluation/trajectory_plot.h"
#include "common/evaluation/trajectory_report.h"
#include "common/util/error.h"
#include "common/util/json_file.h"
#include "tests/fuzz/fuzz_input.h"

// What airdos-evaluate reads: files of other programs, and what follows from their numbers.

namespace airdos {
namespace {

std::string WriteBlock(const std::string& name, FuzzInput* input) {
  const FuzzBytes bytes = input->Block();
  return FuzzFolder::Write(name, bytes.data(), bytes.size());
}

/// Blocks, behind a byte that says whether to draw as well, which takes time.
FuzzBytes Blocks(bool draws, const std::vector<std::string>& texts) {
  FuzzOutput seed;
  seed.U8(draws ? 1 : 0);
  for (const std::string& text : texts) seed.Block(text);
  return seed.Take();
}

// --- trajectories
constexpr char kTum[] = "0 0 0 0 0 0 0 1\n0.1 1 0 0 0 0 0 1\n0.2 2 0 0.5 0 0.0998334 0 0.9950042\n";
constexpr char kKitti[] =
    "1 0 0 0 0 1 0 0 0 0 1 0\n1 0 0 0 0 1 0 0 0 0 1 2\n0 0 1 0 0 1 0 0 -1 0 0 4\n";

constexpr char kEuroc[] =
    "#timestamp, p_RS_R_x [m], p_RS_R_y [m], p_RS_R_z [m], q_RS_w [], q_RS_x [], q_RS_y [], "
    "q_RS_z []\n1400000000000000000,0,0,0,1,0,0,0\n1400000000100000000,0,1,0,,,,\n"
    "1400000000200000000,0,2,0.5,0.995004,0,0.0998334,0\n";
constexpr char kPositions[] = "t;x;y;z\n0;0;0;0\n100;1;0;0\n200;2;0;nan\n";

void RunTrajectory(const std::uint8_t* data, std::size_t size) {
  FuzzInput input(data, size);
  const bool draws = input.U8() == 1;
  const std::string estimate_path = WriteBlock("estimate.txt", &input);
  const std::string truth_path = WriteBlock("truth.txt", &input);
  const std::string times_path = WriteBlock("times.txt", &input);
  try {
    Trajectory estimate = ReadTrajectory(estimate_path);
    Trajectory truth = ReadTrajectory(truth_path);
    if (estimate.has_times != truth.has_times) SetTimesOfPair(times_path, &estimate, &truth);
    const TrajectoryReport report = EvaluateTrajectory(estimate, truth, EvaluationOptions());
    ToTable(report);
    JsonText(ToJson(report));
    if (draws) DrawEvaluation(report, "fuzz");
  } catch (const InputError&) {
  }
}

std::vector<FuzzBytes> TrajectorySeeds() {
  return {Blocks(true, {kTum, kTum, ""}), Blocks(false, {kKitti, kKitti, ""}),
          Blocks(false, {kKitti, kTum, "0\n0.1\n0.2\n"}), Blocks(true, {kEuroc, kEuroc, ""}),
          Blocks(true, {kPositions, kTum, ""})};
}

// --- people
constexpr int kPeopleFrames = 12;  // lengths count after ten

std::string Time(int frame) { return std::to_string(0.1 * frame); }

std::string Cameras() {
  std::string rows;
  for (int frame = 0; frame < kPeopleFrames; ++frame) rows += Time(frame) + " 0 0 0 0 0 0 1\n";
  return rows;
}

std::string People() {
  std::string rows;
  for (int frame = 0; frame < kPeopleFrames; ++frame) {
    rows += "{\"utime\":" + std::to_string(100000 * frame) +
            R"(,"track":3,"joints":{"1":[0,0,4],"8":[0,1,4]},"measured":{"1":[0,0,4.1]},)"
            R"("segment_lengths_m":{"4":0.2}})"
            "\n";
  }
  return rows;
}

std::string TruePeopleText() {
  std::string rows;
  for (int frame = 0; frame < kPeopleFrames; ++frame) {
    rows += (rows.empty() ? "[" : ",") + ("{\"t\":" + Time(frame)) +
            R"(,"humans":[{"id":1,"joints_w":{"1":[0,0,4],"8":[0,1,4],"17":[0,0,0]},)"
            R"("vis0":[1,1,0],"vis1":[2,0,1]}]})";
  }
  return rows + "]";
}

void RunPeople(const std::uint8_t* data, std::size_t size) {
  FuzzInput input(data, size);
  const std::string people_path = WriteBlock("people.jsonl", &input);
  const std::string truth_path = WriteBlock("joints_gt.json", &input);
  static const std::string cameras_path = [] {
    const std::string text = Cameras();
    return FuzzFolder::Write("cameras.txt", text.data(), text.size());
  }();
  try {
    const Trajectory cameras = ReadTrajectory(cameras_path);
    const PeopleReport report = EvaluatePeople(ReadPeople(people_path), ReadTruePeople(truth_path),
                                               Associate(cameras, cameras, 0.001));
    ToTable(report);
    JsonText(ToJson(report));
  } catch (const InputError&) {
  }
}

std::vector<FuzzBytes> PeopleSeeds() {
  FuzzOutput seed;
  seed.Block(People());
  seed.Block(TruePeopleText());
  return {seed.Take()};
}

// --- figures of benchmarks
constexpr char kRuns[] =
    R"({"sequence":"a","mode":"mask_only","max_observations":3,"frames":9,"frames_lost":1,)"
    R"("ate_m":0.1,"rpe_median_m":0.01,"rpe_rmse_m":0.02})"
    "\n"
    R"({"sequence":"a","mode":"on","max_observations":3,"frames":9,"frames_lost":0,)"
    R"("ate_m":0.05,"rpe_median_m":0.01,"rpe_rmse_m":0.01})"
    "\n";

void RunHelpCurve(const std::uint8_t* data, std::size_t size) {
  FuzzInput input(data, size);
  const bool draws = input.U8() == 1;
  const std::string path = WriteBlock("runs.jsonl", &input);
  try {
    const HelpCurve curve = ComputeHelpCurve(ReadCappedRuns(path));
    ToMarkdown(curve);
    JsonText(ToJson(curve));
    if (draws) DrawHelpCurve(curve);
  } catch (const InputError&) {
  }
}

std::vector<FuzzBytes> HelpCurveSeeds() { return {Blocks(true, {kRuns})}; }

constexpr char kChains[] =
    R"({"sequence":"a","num_frames":10,"processes":{"frontend":{"p50_ms":20,"p99_ms":30,)"
    R"("peak_memory_mb":90}},"serial_fps":10,"parallel_fps":20,"replay_memory_mb":100,)"
    R"("live_fps":null,"messages_per_s":200})"
    "\n";
constexpr char kSolves[] =
    R"({"benchmarks":[{"name":"BM_Scaling/5/20/structured/cold","run_type":"iteration",)"
    R"("cpu_time":5.5,"time_unit":"ms","iteration_ms":0.5},{"name":"BM_PaperProblem/artic/full/)"
    R"(ceres","run_type":"iteration","cpu_time":5e6,"time_unit":"ns"}]})";

void RunSpeed(const std::uint8_t* data, std::size_t size) {
  FuzzInput input(data, size);
  const bool draws = input.U8() == 1;
  const std::string chains_path = WriteBlock("chains.jsonl", &input);
  const std::string solves_path = WriteBlock("solves.json", &input);
  try {
    const std::vector<ChainSpeed> chains = ReadChainSpeeds(chains_path);
    const std::vector<SolveTime> solves = ReadSolveTimes(solves_path);
    ToMarkdown(chains, solves);
    JsonText(ToJson(chains, solves));
    if (draws) DrawSpeed(chains, solves);
  } catch (const InputError&) {
  }
}

std::vector<FuzzBytes> SpeedSeeds() { return {Blocks(true, {kChains, kSolves})}; }

}  // namespace

std::vector<FuzzTarget> EvaluationTargets() {
  return {{"trajectory", RunTrajectory, TrajectorySeeds, 4096},
          {"people", RunPeople, PeopleSeeds, 8192},
          {"help_curve", RunHelpCurve, HelpCurveSeeds, 4096},
          {"speed", RunSpeed, SpeedSeeds, 4096}};
}

}  // namespace airdos
