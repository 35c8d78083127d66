#ifndef AIRDOS_PROCESSES_FRONTEND_FRONTEND_OPTIONS_H_
#define AIRDOS_PROCESSES_FRONTEND_FRONTEND_OPTIONS_H_

#include "common/config/config_reader.h"
#include "common/config/option_table.h"
#include "common/features/visual_odometry.h"

namespace airdos {

/// What the frontend is asked to do.
struct FrontendOptions {
  VisualOdometryOptions odometry;
  bool use_masks = true;
  bool use_people = true;                ///< in the pose of a frame that sees little else
  double min_keypoint_confidence = 0.1;  ///< of joints that mark where people are without a mask
  int mask_dilation_px = 8;              ///< around people: masks are ragged
  /// MAP_UPDATE of the frame that many frames back must be there before a frame starts; 0: no
  /// feedback.
  int feedback_lag_frames = 2;
};

/// launch_scripts/config/frontend.yaml
OptionTable TableOf(FrontendOptions* options);

/// Throws InputError naming key and value. Leaves Finish() to the caller.
FrontendOptions ReadFrontendOptions(ConfigReader* config);

}  // namespace airdos

#endif  // AIRDOS_PROCESSES_FRONTEND_FRONTEND_OPTIONS_H_
