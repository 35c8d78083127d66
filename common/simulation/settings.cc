#include "common/simulation/settings.h"

#include <algorithm>
#include <map>

#include "common/util/error.h"

namespace airdos {
namespace {

/// One of the paper's groups. Its start errors per axis are the paper's "before BA" divided by the
/// square root of three.
struct PaperGroup {
  int num_frames;
  int static_per_frame;
  int num_people;
  int num_boxes;
  int num_points;
  double sigma_m;
  double sigma_deg;
  double farthest_m;  ///< calibrated with the static row only: 3.3 to 4.3 cm, 0.10 to 0.20 degrees
};
constexpr PaperGroup kGroups[] = {{38, 36, 2, 2, 16, 0.092, 0.283, 40},
                                  {50, 30, 2, 2, 14, 0.102, 0.366, 35},
                                  {70, 24, 1, 2, 15, 0.122, 0.635, 28},
                                  {80, 34, 2, 2, 15, 0.111, 0.458, 32}};

SimulationOptions MakeGroup(const PaperGroup& group) {
  SimulationOptions options;
  options.num_frames = group.num_frames;
  options.static_per_frame = group.static_per_frame;
  options.objects = {{true, Behaviour::kCruise, group.num_people, group.num_points},
                     {false, Behaviour::kCruise, group.num_boxes, group.num_points}};
  options.farthest_m = group.farthest_m;
  options.odometry_sigma_m = group.sigma_m;
  options.odometry_sigma_deg = group.sigma_deg;
  return options;
}

SimulationOptions MakeWalkers(int static_per_frame, Behaviour behaviour, int num_behaving) {
  constexpr int kPeople = 10;
  SimulationOptions options;
  options.num_frames = 30;
  options.static_per_frame = static_per_frame;
  options.path.min_pan_deg = 11;
  options.path.max_pan_deg = 22;
  options.objects = {{true, Behaviour::kCruise, kPeople - num_behaving, 14},
                     {true, behaviour, num_behaving, 14}};
  options.object_nearest_m = 3;
  options.object_farthest_m = 8;
  options.min_seen_share = 0.25;
  options.has_point_noise = false;
  options.odometry_sigma_m = 0.05;
  options.odometry_sigma_deg = 0.5;
  return options;
}

std::map<std::string, SimulationOptions> MakeSettings() {
  std::map<std::string, SimulationOptions> settings;
  for (int i = 0; i < 4; ++i) settings["group" + std::to_string(i + 1)] = MakeGroup(kGroups[i]);
  for (const int num : {3, 4, 5, 8, 15, 30, 50}) {
    settings["walkers" + std::to_string(num)] = MakeWalkers(num, Behaviour::kCruise, 0);
  }
  const std::pair<const char*, Behaviour> harmful[] = {{"turn", Behaviour::kTurn},
                                                       {"stop", Behaviour::kStop},
                                                       {"sit", Behaviour::kSit},
                                                       {"swap", Behaviour::kSwapped}};
  for (const auto& [name, behaviour] : harmful) {
    for (const int num : {8, 30}) {
      // An even number, because people are confused in pairs.
      settings[name + std::to_string(num)] = MakeWalkers(num, behaviour, 6);
    }
  }
  for (const int num : {8, 30}) {
    SimulationOptions erratic = MakeWalkers(num, Behaviour::kCruise, 0);
    erratic.object_acceleration_m_s2 = 2;
    settings["erratic" + std::to_string(num)] = erratic;
  }
  return settings;
}

const std::map<std::string, SimulationOptions>& Settings() {
  static const std::map<std::string, SimulationOptions> settings = MakeSettings();
  return settings;
}

}  // namespace

const std::vector<std::string>& PaperGroups() {
  static const std::vector<std::string> names = {"group1", "group2", "group3", "group4"};
  return names;
}

const std::vector<std::string>& SettingNames() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (const auto& [name, options] : Settings()) all.push_back(name);
    return all;
  }();
  return names;
}

SimulationOptions SettingByName(const std::string& name, std::uint64_t seed) {
  const auto found = Settings().find(name);
  if (found == Settings().end()) {
    std::string known;
    for (const std::string& other : SettingNames()) known += " " + other;
    throw InputError("simulation: there is no setting '" + name + "'; there are:" + known);
  }
  SimulationOptions options = found->second;
  options.seed = seed;
  return options;
}

}  // namespace airdos
