#include "processes/node/live/process_main.h"

#include <iostream>
#include <opencv2/core/utility.hpp>

#include "common/util/version.h"
#include "processes/node/live/lcm_runner.h"
#include "processes/node/live/lcm_transport.h"
#include "processes/node/live/process_cli.h"
#include "processes/node/live/process_log.h"

namespace airdos {
namespace {

constexpr double kLockstepDeadline_s = 5;
constexpr double kRealtimeDeadline_s = 0.2;

int Run(const ProcessInfo& info, const CommonArguments& arguments, LcmRunnerOptions options) {
  InstallStopSignals();
  cv::setNumThreads(1);  // several threads may add in another order
  ConfigReader config = ReadConfig(arguments);
  const std::unique_ptr<Node> node = info.make_node(&config);
  FinishConfig(config, arguments);
  LcmTransport transport(arguments.lcm_url);
  options.process = info.program;
  options.publishes_frame_done = info.publishes_frame_done;
  options.notify_socket = NotifySocketOfEnvironment();
  const ProcessLog log(info.program, ParseLogLevel(arguments.log_level));
  LcmRunner runner(node.get(), &transport, options, &log);
  runner.Start();
  std::cout << info.program << " READY version " << kVersion << " url " << arguments.lcm_url
            << " config " << arguments.config_file << std::endl;
  runner.Run();
  node->Finish();
  const std::string why_in_vain = node->why_in_vain();
  if (!why_in_vain.empty()) log.Error(why_in_vain);
  return runner.has_refused() || !why_in_vain.empty() ? 1 : 0;
}

}  // namespace

int RunNodeProcess(int argc, char** argv, const ProcessInfo& info) {
  using Pace = LcmRunnerOptions::Pace;
  CommandLine app(info.description, info.program);
  CommonArguments arguments;
  AddCommonOptions(info.options, &app, &arguments);
  LcmRunnerOptions options;
  std::string pace = "lockstep";
  app.Add("--pace", &pace, "lockstep: every frame is worked on; realtime: the newest one")
      .ShowDefault()
      .OneOf({"lockstep", "realtime"});
  const CommandOption deadline =
      app.Add("--deadline-s", &options.deadline_s,
              "A frame that lacks inputs for longer is completed without (s); default " +
                  std::string("5 in lockstep, 0.2 in realtime"))
          .Within(1e-3, 1e6);
  if (info.add_options) info.add_options(&app, arguments);
  return RunProgram(argc, argv, &app, [&] {
    options.pace = pace == "lockstep" ? Pace::kLockstep : Pace::kRealtime;
    if (!deadline.is_given()) {
      options.deadline_s =
          options.pace == Pace::kLockstep ? kLockstepDeadline_s : kRealtimeDeadline_s;
    }
    return Run(info, arguments, options);
  });
}

}  // namespace airdos
