#ifndef AIRDOS_PROCESSES_NODE_LIVE_CALIBRATION_CLI_H_
#define AIRDOS_PROCESSES_NODE_LIVE_CALIBRATION_CLI_H_

#include <string>
#include <utility>
#include <vector>

#include "common/calibration/calibration_file.h"
#include "common/calibration/stereo_rectifier.h"
#include "processes/node/command_line.h"

namespace airdos {

/// How a program is told about the user's calibration: --calibration FILE [FILE], and what else may
/// have to be said about it.
class CalibrationArguments {
 public:
  /// Adds the options, and returns that of the files, called `names` ("--calibration", or "INPUT"
  /// where they are arguments).
  /// `more` is added to its help.
  CommandOption AddTo(const std::string& names, CommandLine* line, const std::string& more = "");

  bool is_given() const { return !paths_.empty(); }
  const std::vector<std::string>& paths() const { return paths_; }
  /// For images of that size (px); {0, 0} = not known. Throws InputError as ReadStereoRig() does.
  StereoRig Read(std::pair<int, int> image_size = {0, 0}) const;
  RectifierOptions rectifier_options() const { return rectifier_; }

 private:
  std::vector<std::string> paths_;
  std::string size_;
  std::string lens_;
  std::string baseline_unit_;
  std::string kitti_cameras_ = "0,1";
  bool swap_ = false;
  bool rectified_ = false;
  bool scale_ = false;
  RectifierOptions rectifier_;
};

}  // namespace airdos

#endif  // AIRDOS_PROCESSES_NODE_LIVE_CALIBRATION_CLI_H_
