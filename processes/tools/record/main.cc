#include <CLI/CLI.hpp>
#include <iostream>

#include "common/util/output_files.h"
#include "processes/node/live/lcm_transport.h"
#include "processes/node/live/log_recorder.h"
#include "processes/node/live/process_cli.h"
#include "processes/node/live/process_log.h"
#include "processes/node/live/service_notifier.h"

int main(int argc, char** argv) {
  CLI::App app("Records what is said on LCM into an event log, without losing anything.",
               "airdos-record");
  airdos::LogRecorderOptions options;
  std::string lcm_url = airdos::DefaultLcmUrl();
  app.add_option("--lcm-url", lcm_url, "where the processes are (LCM URL)")->capture_default_str();
  airdos::AddFile("--out", &options.path, "log to write; lcm-logplayer and airdos-replay read it",
                  &app)
      ->required();
  app.add_option("--channels", options.channels, "regular expression of the channels")
      ->capture_default_str();
  app.add_flag("--inputs-only", options.inputs_only,
               "only images and what else comes from outside, nothing that the processes made of "
               "it: such a log can be played into running processes");
  app.add_option("--flush-s", options.flush_s, "the disk is told to keep what came this often (s)")
      ->check(CLI::Range(0.01, 1e6))
      ->capture_default_str();
  // A recording cannot be made again: it is never marked as one that may be replaced.
  app.add_flag("--force", options.replaces_file, "replace the log if there is one");
  std::string log_level = "info";
  airdos::AddLogLevel(&log_level, &app);

  return airdos::RunProgram(argc, argv, &app, [&] {
    airdos::InstallStopSignals();
    airdos::LcmTransport transport(lcm_url);
    const airdos::ProcessLog log("airdos-record", airdos::ParseLogLevel(log_level));
    airdos::ServiceNotifier service(airdos::NotifySocketOfEnvironment(), &log);
    return airdos::RunLogRecorder(&transport, options, &std::cout, log, &service);
  });
}
