#include "processes/tools/replay/replay_setup.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <system_error>
#include <utility>

#include "common/config/config_reader.h"
#include "common/config/option_pages.h"
#include "common/util/error.h"
#include "common/util/input_file.h"
#include "common/util/output_folder.h"
#include "common/util/suggestion.h"
#include "common/util/words.h"
#include "processes/frontend/frontend_node.h"
#include "processes/human_tracker/human_tracker_node.h"
#include "processes/map_recorder/map_recorder_node.h"
#include "processes/node/live/process_cli.h"
#include "processes/node/message/channels.h"
#include "processes/optimizer/optimizer_node.h"
#include "processes/person_detector/person_detector_node.h"
#include "processes/stereo_player/dataset_source.h"

namespace airdos {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t kSession = 1;  // of data sets; always the same, so that runs are comparable

constexpr char kDetector[] = "person_detector";

struct Process {
  std::string name;  // in its configuration file and in overrides
  RenamedKeys renamed;
  // Not set for the map recorder, which is created last.
  std::function<std::unique_ptr<Node>(ConfigReader*)> make_node;
  std::vector<std::string> publishes;
};

const std::vector<Process>& AllProcesses() {
  static const std::vector<Process> processes{
      {kDetector,
       PagesOf<PersonDetectorOptions>().renamed,
       MakePersonDetectorNode,
       {channel::kPersonKeypointsLeft, channel::kPersonKeypointsRight, channel::kPersonMask}},
      {"frontend",
       PagesOf<FrontendOptions>().renamed,
       MakeFrontendNode,
       {channel::kStaticFeatures}},
      {"human_tracker",
       PagesOf<HumanTrackerOptions>().renamed,
       MakeHumanTrackerNode,
       {channel::kHumanObservations}},
      {"optimizer",
       PagesOf<OptimizerOptions>().renamed,
       MakeOptimizerNode,
       {channel::kStateEstimate, channel::kMapUpdate}},
      {"map_recorder", PagesOf<MapRecorderOptions>().renamed, nullptr, {}}};
  return processes;
}

/// Those that run.
std::vector<Process> Processes(const ReplaySetup& setup) {
  std::vector<Process> processes = AllProcesses();
  if (!setup.detects) processes.erase(processes.begin());
  return processes;
}

using Configs = std::map<std::string, ConfigReader>;                  // by process
using Assignments = std::map<std::string, std::vector<std::string>>;  // by process, in order

std::string ConfigPath(const ReplaySetup& setup, const std::string& process) {
  const fs::path file = setup.config_file;
  if (file.stem() == process) return file.string();
  return setup.config_dir + "/" + process + ".yaml";
}

Configs ReadConfigs(const ReplaySetup& setup) {
  Configs configs;
  for (const Process& process : Processes(setup)) {
    configs.emplace(process.name,
                    ConfigReader::FromFile(ConfigPath(setup, process.name), process.renamed));
  }
  return configs;
}

/// The only process whose configuration has the key in "section.key=value".
std::string OwnerOf(const std::string& text, const Configs& configs) {
  const std::string key = text.substr(0, text.find('='));
  std::string owner;
  std::vector<std::string> all_keys;
  for (const auto& [process, config] : configs) {
    for (const std::string& known : config.Keys()) all_keys.push_back(known);
    if (!config.Has(key)) continue;
    if (!owner.empty()) {
      throw InputError("--set '" + text + "': more than one process has this key; write " + owner +
                       ":" + key + " or " + process + ":" + key);
    }
    owner = process;
  }
  if (owner.empty()) {
    for (const auto& [process, config] : configs) config.RequireNotRenamed(key);
    throw InputError("--set '" + text + "': no process has the key '" + key + "'" +
                     DidYouMean(key, all_keys));
  }
  return owner;
}

void AddOverride(const std::string& text, const Configs& configs, Assignments* assignments) {
  const Assignment assignment = ParseAssignment(text);
  const std::string process =
      assignment.process.empty() ? OwnerOf(text, configs) : assignment.process;
  if (configs.count(process) == 0) {
    throw InputError("--set '" + text + "': " + process + " is not part of a replay");
  }
  (*assignments)[process].push_back(assignment.text);
}

Assignments AssignmentsOf(const ReplaySetup& setup, const Configs& configs) {
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
  // Not taken from the configuration: an earlier run's names that run's folder.
  assignments["map_recorder"].push_back("output.directory=" + setup.run_dir);
  for (const std::string& text : setup.overrides) AddOverride(text, configs, &assignments);
  return assignments;
}

void WriteText(const std::string& path, const std::string& text) {
  std::ofstream file(path);
  file << text;
  file.close();
  if (!file) throw InputError(path + ": cannot be written");
}

/// The name of the file within the folder; empty if it is elsewhere.
std::string NameWithin(const std::string& folder, const std::string& path) {
  std::error_code error;
  const fs::path name = fs::weakly_canonical(fs::absolute(path, error), error)
                            .lexically_relative(fs::weakly_canonical(fs::absolute(folder, error)));
  const bool is_within = !name.empty() && *name.begin() != ".." && *name.begin() != ".";
  return is_within ? name.string() : "";
}

/// Refuses what must not be written before anything is written: duplicate names, or files in the
/// way.
void ClaimOutputs(const std::vector<std::string>& names, OutputFolder* results) {
  results->RequireReplaceable(names, [](const std::string&, const std::string&) { return false; });
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (std::find(names.begin(), names.begin() + static_cast<std::ptrdiff_t>(i), names[i]) !=
        names.begin() + static_cast<std::ptrdiff_t>(i)) {
      throw InputError(results->PathOf(names[i]) +
                       ": would be written twice; give each output its own name");
    }
  }
  for (const std::string& name : names) results->Claim(name, "run");
}

}  // namespace

void SetConfig(const std::string& path, ReplaySetup* setup) {
  if (fs::is_directory(path)) {
    setup->config_dir = path;
    return;
  }
  RequireRegularFile(path);
  std::vector<std::string> names;
  for (const Process& process : AllProcesses()) names.push_back(process.name);
  const std::string stem = fs::path(path).stem().string();
  if (std::find(names.begin(), names.end(), stem) == names.end()) {
    const std::string hint = DidYouMean(stem, names);
    throw InputError("--config " + path + ": the name does not tell which process it belongs to: " +
                     JoinWords(names, ".yaml, ") + ".yaml" + hint);
  }
  setup->config_file = path;
}

ReplayNodes PrepareReplay(const ReplaySetup& setup) {
  Configs configs = ReadConfigs(setup);
  for (const auto& [process, assignments] : AssignmentsOf(setup, configs)) {
    for (const std::string& assignment : assignments) configs.at(process).Override(assignment);
  }
  ReplayNodes result;
  for (const Process& process : Processes(setup)) {
    const bool makes_features = process.name != "optimizer";
    if (process.make_node == nullptr || (setup.from_features && makes_features)) continue;
    ConfigReader& config = configs.at(process.name);
    result.nodes.push_back({process.make_node(&config), process.publishes});
    config.Finish();
  }
  MapRecorderOptions recording = ReadMapRecorderOptions(&configs.at("map_recorder"));
  configs.at("map_recorder").Finish();
  recording.rules = setup.rules;
  for (const Process& process : Processes(setup)) {
    recording.rules.inputs.push_back(ConfigPath(setup, process.name));
  }
  if (recording.directory.empty()) {
    result.outputs = std::make_unique<OutputFiles>(setup.outputs, recording.rules);
    return result;
  }
  auto recorder = std::make_unique<MapRecorderNode>(recording);
  std::vector<std::string> outside, within;
  for (const std::string& path : setup.outputs) {
    if (path.empty()) continue;
    const std::string name = NameWithin(recording.directory, path);
    (name.empty() ? outside : within).push_back(name.empty() ? path : name);
  }
  result.outputs = std::make_unique<OutputFiles>(outside, recording.rules);
  std::vector<std::string> configurations;
  for (const Process& process : Processes(setup)) {
    const bool is_run =
        process.make_node == nullptr || !setup.from_features || process.name == "optimizer";
    if (is_run && !setup.run_dir.empty()) configurations.push_back(process.name);
  }
  for (const std::string& process : configurations) within.push_back(process + ".yaml");
  ClaimOutputs(within, recorder->results());
  for (const std::string& process : configurations) {
    WriteText(recorder->results()->PathOf(process + ".yaml"), configs.at(process).Resolved());
  }
  result.nodes.push_back({std::move(recorder), {}});
  return result;
}

std::vector<ReplayNode> MakeReplayNodes(const ReplaySetup& setup) {
  return std::move(PrepareReplay(setup).nodes);
}

std::unique_ptr<FrameSource> OpenFrameSource(const std::string& path, std::int64_t first,
                                             std::int64_t last, LogInputs inputs,
                                             const std::string& calibration) {
  if (std::filesystem::is_directory(path))
    return std::make_unique<DatasetSource>(path, first, last, kSession, ImagePackerOptions(),
                                           calibration);
  return std::make_unique<LogSource>(path, first, last, inputs);
}

std::unique_ptr<FrameSource> OpenRecordingSource(const RecordingArguments& recording,
                                                 std::int64_t first, std::int64_t last) {
  return std::make_unique<DatasetSource>(recording.Open(), recording.name(), first, last, kSession,
                                         ImagePackerOptions());
}

}  // namespace airdos
