#include "processes/tools/replay_setup.h"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <system_error>
#include <utility>

#include "common/config/config_reader.h"
#include "common/util/error.h"
#include "processes/frontend/frontend_node.h"
#include "processes/human_tracker/human_tracker_node.h"
#include "processes/map_recorder/map_recorder_node.h"
#include "processes/node/channels.h"
#include "processes/optimizer/optimizer_node.h"
#include "processes/stereo_player/dataset_source.h"

namespace airdos {
namespace {

constexpr std::int64_t kSession = 1;  // of data sets: always the same, so that runs compare

struct Process {
  std::string name;  // of its configuration file and in overrides
  std::function<std::unique_ptr<Node>(ConfigReader*)> make_node;
  std::vector<std::string> publishes;
};

const std::vector<Process>& Processes() {
  static const std::vector<Process> processes{
      {"frontend", MakeFrontendNode, {channel::kStaticFeatures}},
      {"human_tracker", MakeHumanTrackerNode, {channel::kHumanObservations}},
      {"optimizer", MakeOptimizerNode, {channel::kStateEstimate, channel::kMapUpdate}},
      {"map_recorder", MakeMapRecorderNode, {}}};
  return processes;
}

using Assignments = std::map<std::string, std::vector<std::string>>;  // by process, in order

void AddOverride(const std::string& text, Assignments* assignments) {
  const std::size_t colon = text.find(':');
  const std::string process = text.substr(0, colon);
  const auto& all = Processes();
  const bool is_known = std::any_of(all.begin(), all.end(),
                                    [&](const Process& known) { return known.name == process; });
  if (colon == std::string::npos || !is_known) {
    throw InputError("--set '" + text + "': is not of the form process:section.key=value" +
                     " with frontend, human_tracker, optimizer or map_recorder as process");
  }
  (*assignments)[process].push_back(text.substr(colon + 1));
}

Assignments AssignmentsOf(const ReplaySetup& setup) {
  Assignments assignments;
  std::string masks = setup.masks;
  if (!setup.people.empty()) {
    assignments["optimizer"].push_back("people.mode=" + setup.people);
    const bool is_on = setup.people == "on";
    assignments["frontend"].push_back(std::string("people.use=") + (is_on ? "true" : "false"));
    if (masks.empty()) masks = setup.people == "off" ? "off" : "on";
  }
  if (!masks.empty()) {
    assignments["frontend"].push_back(std::string("masks.use=") +
                                      (masks == "on" ? "true" : "false"));
  }
  if (!setup.run_dir.empty())
    assignments["map_recorder"].push_back("output.directory=" + setup.run_dir);
  for (const std::string& text : setup.overrides) AddOverride(text, &assignments);
  return assignments;
}

void WriteText(const std::string& path, const std::string& text) {
  std::ofstream file(path);
  file << text;
  file.close();
  if (!file) throw InputError(path + ": cannot be written");
}

}  // namespace

std::vector<ReplayNode> MakeReplayNodes(const ReplaySetup& setup) {
  Assignments assignments = AssignmentsOf(setup);
  if (!setup.run_dir.empty()) {
    std::error_code error;
    std::filesystem::create_directories(setup.run_dir, error);
    if (error) throw InputError(setup.run_dir + ": cannot be created: " + error.message());
  }
  std::vector<ReplayNode> nodes;
  for (const Process& process : Processes()) {
    const bool makes_features = process.name == "frontend" || process.name == "human_tracker";
    if (setup.from_features && makes_features) continue;
    ConfigReader config = ConfigReader::FromFile(setup.config_dir + "/" + process.name + ".yaml");
    for (const std::string& assignment : assignments[process.name]) config.Override(assignment);
    nodes.push_back({process.make_node(&config), process.publishes});
    config.Finish();
    if (!setup.run_dir.empty())
      WriteText(setup.run_dir + "/" + process.name + ".yaml", config.Resolved());
  }
  return nodes;
}

std::unique_ptr<FrameSource> OpenFrameSource(const std::string& path, std::int64_t first,
                                             std::int64_t last, LogInputs inputs) {
  if (std::filesystem::is_directory(path))
    return std::make_unique<DatasetSource>(path, first, last, kSession, ImagePackerOptions());
  return std::make_unique<LogSource>(path, first, last, inputs);
}

ProgressBar::ProgressBar() : is_terminal_(isatty(STDERR_FILENO) == 1) {}

void ProgressBar::Show(double fraction_done) {
  constexpr int kWidth = 40;
  const int percent = static_cast<int>(100 * std::clamp(fraction_done, 0.0, 1.0));
  if (is_terminal_ && percent != last_percent_) {
    std::string bar(static_cast<std::size_t>(kWidth * percent / 100), '#');
    bar.resize(kWidth, '.');
    std::fprintf(stderr, "\r[%s] %3d %%%s", bar.c_str(), percent, percent == 100 ? "\n" : "");
    last_percent_ = percent;
  } else if (!is_terminal_ && percent / 10 > last_percent_ / 10) {
    std::fprintf(stderr, "%d %%\n", percent / 10 * 10);
    last_percent_ = percent;
  }
}

}  // namespace airdos
