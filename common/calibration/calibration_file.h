#ifndef AIRDOS_COMMON_CALIBRATION_CALIBRATION_FILE_H_
#define AIRDOS_COMMON_CALIBRATION_CALIBRATION_FILE_H_

#include <optional>
#include <string>
#include <vector>

#include "common/calibration/rig_formats.h"
#include "common/calibration/stereo_rig.h"

namespace airdos {

/// What the user says about a calibration beyond its file.
struct CalibrationOptions {
  FormatOptions format;
  bool swap = false;                  ///< the file's first camera is the right one
  bool are_images_rectified = false;  ///< with the rectification that the file itself describes
  bool scale = false;  ///< the images are those that were calibrated, made larger or smaller
  /// Length of the file's unit; otherwise judged by its size.
  std::optional<double> baseline_unit_m;
};

/// The names of the formats that ReadStereoRig() knows, for help texts.
const std::vector<std::string>& CalibrationFormats();

/// The stereo pair that one calibration file describes, or two, one a camera (left first). The
/// format is found by content. Translations become metres. Throws InputError with one line where
/// the files are of no known format, where a number is missing or wrong, and where they describe no
/// horizontal stereo pair for the images: cameras one above the other, exchanged (unless `swap`),
/// turned away from each other, a baseline that is no length in m or mm, another resolution.
StereoRig ReadStereoRig(const std::vector<std::string>& paths, const CalibrationOptions& options);

}  // namespace airdos

#endif  // AIRDOS_COMMON_CALIBRATION_CALIBRATION_FILE_H_
