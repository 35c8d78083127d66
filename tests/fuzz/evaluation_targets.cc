#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "common/evaluation/detection_report.h"
#include "common/evaluation/help_curve.h"
#include "common/evaluation/help_curve_plot.h"
#include "common/evaluation/people_files.h"
#include "common/evaluation/people_report.h"
#include "common/evaluation/speed_report.h"
#include "common/evaluation/trajectory_plot.h"
#include "common/evaluation/trajectory_report.h"
#include "common/util/error.h"
#include "common/util/json_file.h"
#include "processes/node/log/event_log.h"
#include "processes/node/message/channels.h"
#include "processes/tools/evaluate/keypoint_log.h"
#include "tests/fuzz/fuzz_input.h"
#include "tests/support/sample_messages.h"

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

// --- detections
std::int16_t I16(FuzzInput* input) {
  const unsigned low = input->U8();
  return static_cast<std::int16_t>(low + 256u * input->U8());
}

/// Each person is a count, then the first joints: u, v (px, two bytes each) and confidence.
std::vector<BodyKeypoints> TakePeople(FuzzInput* input) {
  constexpr std::size_t kMostPeople = 20;
  std::vector<BodyKeypoints> people(input->U8() % kMostPeople);
  for (BodyKeypoints& person : people) {
    const std::size_t num = input->U8() % (kNumJoints + 1);
    for (std::size_t joint = 0; joint < num; ++joint) {
      person[joint].u_px = I16(input);
      person[joint].v_px = I16(input);
      person[joint].confidence = input->U8() / 255.0;
    }
  }
  return people;
}

void RunDetections(const std::uint8_t* data, std::size_t size) {
  FuzzInput input(data, size);
  constexpr StereoCamera kCamera = {640, 360, 500, 500, 320, 180, 0.25};
  std::vector<DetectionFrame> frames;
  try {
    for (const TruePeople& truth : ReadTruePeople(WriteBlock("joints_gt.json", &input))) {
      DetectionFrame frame;
      frame.truth = TrueScene{truth.people, TrajectoryPose()};
      frames.push_back(frame);
    }
  } catch (const InputError&) {
  }
  for (std::size_t i = 0; i == 0 || (i < frames.size() && !input.empty()); ++i) {
    if (frames.empty()) frames.emplace_back();
    frames[i].detected = {TakePeople(&input), TakePeople(&input)};
    frames[i].given = {TakePeople(&input), TakePeople(&input)};
  }
  const DetectionReport report = EvaluateDetections(kCamera, frames);
  DoubtsAbout(report);
  ToTable(report);
  JsonText(ToJson(report));
}

std::vector<FuzzBytes> DetectionSeeds() {
  FuzzOutput seed;
  seed.Block(TruePeopleText());
  for (int list = 0; list < 8; ++list) {
    seed.U8(2);
    for (int person = 0; person < 2; ++person) {
      seed.U8(kNumJoints);
      for (int joint = 0; joint < kNumJoints; ++joint) {
        for (const int value : {64 + joint, 1, 180 + 9 * joint - 40 * person, 0, 200}) {
          seed.U8(value % 256);
        }
      }
    }
  }
  return {seed.Take()};
}

void RunKeypointLog(const std::uint8_t* data, std::size_t size) {
  try {
    ReadKeypointLog(FuzzFolder::Write("keypoints.lcm", data, size));
  } catch (const InputError&) {
  }
}

std::vector<FuzzBytes> KeypointLogSeeds() {
  const std::string path = FuzzFolder::Path() + "/keypoint_seed.lcm";
  {
    EventLogWriter writer(path);
    const auto add = [&](const char* channel, std::int64_t seq, auto message) {
      message.seq = seq;
      const FuzzBytes bytes = Encode(message);
      writer.Append(seq, channel, bytes.data(), bytes.size());
    };
    for (std::int64_t seq = 0; seq < 3; ++seq) {
      add(channel::kCalibration, seq, Sample<stereo_calibration_t>());
      add(channel::kPersonKeypointsLeft, seq, Sample<person_keypoints_t>());
      add(channel::kPersonKeypointsRight, seq, Sample<person_keypoints_t>());
    }
  }
  std::ifstream file(path, std::ios::binary);
  return {FuzzBytes(std::istreambuf_iterator<char>(file), {})};
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
          {"detections", RunDetections, DetectionSeeds, 8192},
          {"keypoint_log", RunKeypointLog, KeypointLogSeeds, 16384},
          {"help_curve", RunHelpCurve, HelpCurveSeeds, 4096},
          {"speed", RunSpeed, SpeedSeeds, 4096}};
}

}  // namespace airdos
