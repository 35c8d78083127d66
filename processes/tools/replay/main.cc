#include <cstdint>
#include <iostream>
#include <limits>
#include <memory>
#include <opencv2/core/utility.hpp>
#include <set>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "common/util/error.h"
#include "processes/node/check/input_check.h"
#include "processes/node/check/watched_source.h"
#include "processes/node/live/process_cli.h"
#include "processes/node/live/recording_cli.h"
#include "processes/node/log/looped_source.h"
#include "processes/node/log/partial_source.h"
#include "processes/tools/progress/progress_bar.h"
#include "processes/tools/replay/replay.h"
#include "processes/tools/replay/replay_setup.h"

int main(int argc, char** argv) {
  airdos::CommandLine app(
      "Runs all processes in one, as fast as the machine allows, on a log or data set. Writes only "
      "what --out, --run-dir and --timing specify.",
      "airdos-replay");
  airdos::ReplaySetup setup;
  airdos::ReplayOptions options;
  std::string config_path;
  std::string timing_path;
  std::int64_t first = std::numeric_limits<std::int64_t>::min();
  std::int64_t last = std::numeric_limits<std::int64_t>::max();
  std::string threads = "auto";
  int num_loops = 1;
  bool no_progress = false;
  bool digest = false;
  bool digest_only = false;
  setup.config_dir = airdos::ConfigFolder();
  airdos::InputOptions input(&app);
  airdos::RecordingArguments recording;
  recording.AddTo(&app);
  airdos::InputCheckOptions check;
  airdos::AddInputCheckOptions(&app, &check);
  app.AddFile("--out", &options.out_path, "log of what the processes publish");
  app.AddFlag("--all", &options.writes_inputs, "include the inputs in that log");
  app.AddFolder("--run-dir", &setup.run_dir,
                "folder for map, trajectories, configurations; without it no map is recorded");
  app.AddFile("--config", &config_path,
              "folder with <process>.yaml, or one of these files [" + setup.config_dir + "]");
  app.AddFolder("--config-dir", &config_path, "older name of --config").Hide();
  app.Add("--set", &setup.overrides,
          "process:section.key=value (repeatable); the process may be omitted if "
          "only one has the key")
      .OneEachTime();
  app.Add("--people", &setup.people, "how people are used").OneOf({"off", "mask_only", "on"});
  app.Add("--masks", &setup.masks, "whether pixels on people are excluded").OneOf({"off", "on"});
  app.Add("--first", &first, "first image number");
  app.Add("--last", &last, "last image number");
  app.Add("--loop", &num_loops, "how often to play it, as one long session").Within(1, 1000000);
  app.AddFlag("--from-features", &setup.from_features,
              "run only the optimizer and the map recorder, on the features and people that the "
              "log holds (airdos-simulate)");
  app.AddFlag("--detect", &setup.detects,
              "run the person detector as well; keypoints and masks of the log or data set are not "
              "used")
      .Excludes("--from-features");
  app.Add("--threads", &threads, "1: all in one; auto: one per process, if there are enough cores")
      .OneOf({"1", "auto"})
      .ShowDefault();
  app.AddFile("--timing", &timing_path, "JSON file for ms per frame of each process");
  app.AddForce(&setup.rules.force);
  app.AddFlag("--no-progress", &no_progress, "do not report progress");
  app.AddFlag("--digest", &digest, "print the digests of the output channels only");
  app.AddFlag("--digest-only", &digest_only, "print the digests of the log itself; run nothing");

  return airdos::RunProgram(argc, argv, &app, [&] {
    recording.Settle(&input);
    check.calibration = recording.named_calibration();
    if (recording.is_given() && (digest_only || setup.from_features)) {
      throw airdos::InputError("--digest-only and --from-features are for logs");
    }
    if (digest_only) {
      std::cout << airdos::FormatDigests(airdos::DigestLog(input.path()));
      return 0;
    }
    cv::setNumThreads(1);
    const auto inputs =
        setup.from_features ? airdos::LogInputs::kFeatures : airdos::LogInputs::kImages;
    const auto say = [](const std::string& line) {
      std::cerr << "airdos-replay: " << line << std::endl;
    };
    const auto open = [&] {
      auto whole = recording.is_given() ? airdos::OpenRecordingSource(recording, first, last)
                                        : airdos::OpenFrameSource(input.path(), first, last, inputs,
                                                                  check.calibration);
      if (!setup.detects) return whole;
      return std::unique_ptr<airdos::FrameSource>(std::make_unique<airdos::PartialSource>(
          std::move(whole), airdos::ChannelsOfPeople("--detect", {"keypoints", "masks"})));
    };
    airdos::RowWatch rows(recording.is_given() ? recording.HowToExamine()
                                               : airdos::HowToRectify("airdos-replay"));
    const std::string name = recording.is_given() ? recording.name() : input.path();
    airdos::WatchedSource source(std::make_unique<airdos::LoopedSource>(open, num_loops), name,
                                 &rows);
    // Reported only once everything else is known to be right.
    std::vector<std::string> remarks;
    for (const std::string& note : source.TakeNotes()) remarks.push_back("note: " + note);
    if (!check.is_off && !setup.from_features) {
      const auto keep = [&](const std::string& line) { remarks.push_back(line); };
      if (recording.is_given()) {
        airdos::CheckRecordingBeforeRun(*recording.Open(), keep);
      } else {
        airdos::CheckBeforeRun(input.path(), check.calibration, keep);
      }
    }
    if (!config_path.empty()) airdos::SetConfig(config_path, &setup);
    setup.rules.inputs =
        recording.is_given() ? recording.paths() : std::vector<std::string>{input.path()};
    setup.outputs = {options.out_path, timing_path};
    const airdos::ReplayNodes replay = airdos::PrepareReplay(setup);
    for (const std::string& remark : remarks) say(remark);
    options.is_parallel = threads == "auto" && std::thread::hardware_concurrency() > 1;
    airdos::ProgressBar bar;
    if (!no_progress) options.on_progress = [&bar](double fraction) { bar.Show(fraction); };
    std::set<std::string> said;
    options.on_remark = [&](const std::string& remark) {
      bar.MakeRoom();
      say((remark.find("warning: ") == std::string::npos ? "note: " : "") + remark);
      said.insert(remark);
    };
    const airdos::ReplayResult result = airdos::Replay(&source, replay.nodes, options);
    if (!timing_path.empty()) airdos::WriteTiming(result, timing_path);
    std::cout << (digest ? airdos::FormatDigests(result.digests) : airdos::FormatSummary(result));
    if (digest) {  // which must not hide that something was rejected
      for (const std::string& remark : result.remarks) {
        if (said.count(remark) == 0) std::cerr << "note: " << remark << "\n";
      }
    }
    const std::string why_in_vain = airdos::WhyInVain(result.tally);
    if (!why_in_vain.empty()) say(why_in_vain);
    return why_in_vain.empty() ? 0 : 1;
  });
}
