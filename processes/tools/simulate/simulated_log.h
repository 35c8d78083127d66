#ifndef AIRDOS_PROCESSES_TOOLS_SIMULATE_SIMULATED_LOG_H_
#define AIRDOS_PROCESSES_TOOLS_SIMULATE_SIMULATED_LOG_H_

#include <cstdint>
#include <string>
#include <vector>

#include "common/simulation/feature_simulator.h"
#include "processes/node/node.h"

namespace airdos {

/// What frontend and human tracker would publish for a simulated sequence, frame by frame:
/// CALIBRATION once a second, STATIC_FEATURES with the odometry as the frontend's pose,
/// HUMAN_OBSERVATIONS and GROUND_TRUTH. Only people are included, not other objects, with the 14
/// joints that messages support. Noise of points in m is converted to the pixels by which it shifts
/// a point at its depth.
std::vector<std::vector<Envelope>> SimulatedMessages(const SimulatedSequence& sequence,
                                                     std::int64_t session);

/// Writes them as an LCM log, stamped with capture times. Throws InputError or WriteError.
void WriteSimulatedLog(const SimulatedSequence& sequence, const std::string& path);

}  // namespace airdos

#endif  // AIRDOS_PROCESSES_TOOLS_SIMULATE_SIMULATED_LOG_H_
