#ifndef AIRDOS_COMMON_SIMULATION_SETTINGS_H_
#define AIRDOS_COMMON_SIMULATION_SETTINGS_H_

#include <cstdint>
#include <string>
#include <vector>

#include "common/simulation/feature_simulator.h"

namespace airdos {

/// The paper's four groups: "group1" .. "group4".
const std::vector<std::string>& PaperGroups();

/// All named settings:
///   group1 .. group4   the paper's groups: people and rigid objects, points with 5 cm of noise
///   walkers3 .. 50     ten walking people, stereo noise of 1 px, this many static landmarks per
///                      frame, 11 to 22 degrees of rotation per frame
///   turn8, stop8, sit8, swap8, and the same with 30   like walkers8 and walkers30, but six of the
///                      ten turn, stop, sit down or are confused with each other
///   erratic8, 30       like walkers8 and walkers30, but nobody keeps a constant velocity: 2 m/s^2
///                      all the time
const std::vector<std::string>& SettingNames();

/// Throws InputError for an unknown name.
SimulationOptions SettingByName(const std::string& name, std::uint64_t seed);

}  // namespace airdos

#endif  // AIRDOS_COMMON_SIMULATION_SETTINGS_H_
