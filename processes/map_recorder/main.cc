#include <memory>
#include <string>

#include "processes/map_recorder/map_recorder_node.h"
#include "processes/node/live/process_log.h"
#include "processes/node/live/process_main.h"

int main(int argc, char** argv) {
  airdos::ProcessInfo info;
  info.program = "airdos-map-recorder";
  info.options = airdos::PagesOf<airdos::MapRecorderOptions>();
  info.description = "Records trajectory, people and map into a crash-safe file";
  std::string run_dir;
  const airdos::CommonArguments* common = nullptr;
  info.add_options = [&](airdos::CommandLine* app, const airdos::CommonArguments& arguments) {
    app->AddFolder("--run-dir", &run_dir, "folder of map and trajectories (output.directory)");
    common = &arguments;
  };
  info.make_node = [&](airdos::ConfigReader* config) {
    if (!run_dir.empty()) config->Override("output.directory=" + run_dir);
    airdos::MapRecorderOptions options = airdos::ReadMapRecorderOptions(config);
    options.rules.force = common->force;
    const airdos::ProcessLog log(info.program, airdos::ParseLogLevel(common->log_level));
    options.say = [log](const std::string& line) { log.Relay(line); };
    return std::make_unique<airdos::MapRecorderNode>(options);
  };
  info.publishes_frame_done = true;
  return airdos::RunNodeProcess(argc, argv, info);
}
