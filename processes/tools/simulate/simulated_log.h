#ifndef AIRDOS_PROCESSES_TOOLS_SIMULATE_SIMULATED_LOG_H_
#define AIRDOS_PROCESSES_TOOLS_SIMULATE_SIMULATED_LOG_H_

#include <cstdint>
#include <string>
#include <vector>

#include "common/simulation/feature_simulator.h"
#include "processes/node/node.h"

namespace airdos {

/// What the frontend and the human tracker would say of a simulated sequence, frame by frame:
/// CALIBRATION once a second, STATIC_FEATURES with the odometry as the frontend's pose,
/// HUMAN_OBSERVATIONS and GROUND_TRUTH. Of objects only people are in it, with the 14 joints that
/// messages know. Noise of points in m becomes the pixels that it shifts a point by at its depth.
std::vector<std::vector<Envelope>> SimulatedMessages(const SimulatedSequence& sequence,
                                                     std::int64_t session);

/// Writes them as an LCM log, stamped with capture time. Throws InputError or WriteError.
void WriteSimulatedLog(const SimulatedSequence& sequence, const std::string& path);

}  // namespace airdos

#endif  // AIRDOS_PROCESSES_TOOLS_SIMULATE_SIMULATED_LOG_H_
