#ifndef AIRDOS_PROCESSES_TOOLS_CALIBRATION_RIG_TEXT_H_
#define AIRDOS_PROCESSES_TOOLS_CALIBRATION_RIG_TEXT_H_

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "common/calibration/stereo_rectifier.h"
#include "common/check/check_rig.h"

namespace airdos {

/// What a calibration says and what was assumed, a table for people.
std::string RigText(const StereoRig& rig, const StereoRectifier& rectifier);
/// The same for programs: lengths in m, angles in rad, T_L_R as translation and x, y, z, w.
nlohmann::json RigJson(const StereoRig& rig, const StereoRectifier& rectifier);

/// Rows before and after rectification, and after it by thirds of the image.
std::string RigCheckText(const RigCheck& check);

}  // namespace airdos

#endif  // AIRDOS_PROCESSES_TOOLS_CALIBRATION_RIG_TEXT_H_
