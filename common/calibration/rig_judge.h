#ifndef AIRDOS_COMMON_CALIBRATION_RIG_JUDGE_H_
#define AIRDOS_COMMON_CALIBRATION_RIG_JUDGE_H_

#include <string>

#include "common/calibration/calibration_file.h"

namespace airdos {

/// Makes of what stands in a file a rig for the user's images: cameras exchanged, images taken as
/// rectified, size and unit of length where `options` say so or the numbers leave no doubt (then
/// with a note). Throws InputError beginning with `where` if it is no horizontal stereo pair for
/// these images.
void JudgeRig(const std::string& where, const CalibrationOptions& options, StereoRig* rig);

}  // namespace airdos

#endif  // AIRDOS_COMMON_CALIBRATION_RIG_JUDGE_H_
