#include <iostream>

#include "common/util/output_files.h"
#include "processes/node/live/lcm_transport.h"
#include "processes/node/live/log_recorder.h"
#include "processes/node/live/process_cli.h"
#include "processes/node/live/process_log.h"
#include "processes/node/live/service_notifier.h"

int main(int argc, char** argv) {
  airdos::CommandLine app("Records LCM messages to an event log, without losing any.",
                          "airdos-record");
  airdos::LogRecorderOptions options;
  std::string lcm_url = airdos::DefaultLcmUrl();
  app.Add("--lcm-url", &lcm_url, "LCM URL of the processes").ShowDefault();
  app.AddFile("--out", &options.path, "log to write; lcm-logplayer and airdos-replay read it")
      .Required();
  app.Add("--channels", &options.channels, "regular expression of the channels").ShowDefault();
  app.AddFlag("--inputs-only", &options.inputs_only,
              "only images and other external inputs, nothing that the processes computed from "
              "them: such a log can be played to running processes");
  app.Add("--flush-s", &options.flush_s, "interval between flushes to disk (s)")
      .Within(0.01, 1e6)
      .ShowDefault();
  // A recording cannot be repeated, so it is never marked as a file that may be replaced.
  app.AddFlag("--force", &options.replaces_file, "replace the log if there is one");
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
