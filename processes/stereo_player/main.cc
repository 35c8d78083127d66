#include <iostream>
#include <memory>
#include <opencv2/core/utility.hpp>
#include <string>
#include <utility>
#include <vector>

#include "common/util/output_files.h"
#include "common/util/version.h"
#include "processes/node/check/input_check.h"
#include "processes/node/check/watched_source.h"
#include "processes/node/live/lcm_transport.h"
#include "processes/node/live/process_cli.h"
#include "processes/node/live/process_log.h"
#include "processes/node/live/process_usage.h"
#include "processes/node/log/log_source.h"
#include "processes/stereo_player/player_loop.h"
#include "processes/stereo_player/player_options.h"

namespace {

void Check(const airdos::PlayerOptions& options, const airdos::ProcessLog& log) {
  if (options.check.is_off) return;
  const auto say = [&log](const std::string& line) { log.Relay(line); };
  if (options.recording.is_given()) {
    airdos::CheckRecordingBeforeRun(*options.recording.Open(), say);
  } else {
    airdos::CheckBeforeRun(options.data, options.check.calibration, say);
  }
}

int Play(const airdos::PlayerOptions& options, const airdos::CommonArguments& common) {
  airdos::InstallStopSignals();
  cv::setNumThreads(1);
  const airdos::ProcessLog log("airdos-stereo-player", airdos::ParseLogLevel(common.log_level));
  const std::vector<std::string> inputs = options.recording.is_given()
                                              ? options.recording.paths()
                                              : std::vector<std::string>{options.data};
  const airdos::OutputFiles outputs({options.write_log}, {inputs, common.force});
  const std::int64_t session = options.session.value_or(airdos::WallClock_us());
  const bool is_recording = options.recording.is_given();
  airdos::RowWatch rows(is_recording ? options.recording.HowToExamine()
                                     : airdos::HowToRectify("airdos-stereo-player"));
  const auto open = [&](std::int64_t number) -> std::unique_ptr<airdos::FrameSource> {
    return std::make_unique<airdos::WatchedSource>(
        airdos::OpenPlayerSource(options, number),
        is_recording ? options.recording.name() : options.data, &rows);
  };
  // Opened before anything is published, so that a wrong path is reported first.
  std::unique_ptr<airdos::FrameSource> first = open(session);
  if (!options.write_log.empty()) {
    Check(options, log);
    airdos::WriteLog(options.write_log, first.get(), log);
    return 0;
  }
  const auto open_next = [&](int num_sessions) {
    return num_sessions == 0 ? std::move(first) : open(session + num_sessions);
  };
  airdos::LcmTransport transport(common.lcm_url);
  Check(options, log);
  airdos::PlayerLoop loop(options, open_next, &transport, &log,
                          airdos::NotifySocketOfEnvironment());
  std::cout << "airdos-stereo-player READY version " << airdos::kVersion << " url "
            << common.lcm_url << " config " << common.config_file << std::endl;
  loop.Run();
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  airdos::CommandLine app("Plays a recorded stereo sequence as LCM messages",
                          "airdos-stereo-player");
  const airdos::PlayerArguments arguments(&app);
  return airdos::RunProgram(argc, argv, &app,
                            [&] { return Play(arguments.Resolve(), arguments.common()); });
}
