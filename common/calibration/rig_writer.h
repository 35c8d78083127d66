#ifndef AIRDOS_COMMON_CALIBRATION_RIG_WRITER_H_
#define AIRDOS_COMMON_CALIBRATION_RIG_WRITER_H_

#include <string>
#include <vector>

#include "common/calibration/stereo_rectifier.h"
#include "common/calibration/stereo_rig.h"

namespace airdos {

/// A file to be written.
struct NamedText {
  std::string name;
  std::string text;
};

/// The formats that WriteRig() knows: kalibr, ros, opencv, euroc, orbslam3, calib.json.
const std::vector<std::string>& WrittenFormats();

/// A rig in the format of another tool, with all digits, as one file ("kalibr.yaml") or one a
/// camera ("left.yaml", "right.yaml"). calib.json holds the rectified pair only, and so fits the
/// images that `rectifier` makes. Throws InputError where the format cannot say what the rig is:
/// distortion that the format does not know, or images that are rectified already (which only
/// calib.json is for).
std::vector<NamedText> WriteRig(const StereoRig& rig, const StereoRectifier& rectifier,
                                const std::string& format);

}  // namespace airdos

#endif  // AIRDOS_COMMON_CALIBRATION_RIG_WRITER_H_
