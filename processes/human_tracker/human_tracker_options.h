#ifndef AIRDOS_PROCESSES_HUMAN_TRACKER_HUMAN_TRACKER_OPTIONS_H_
#define AIRDOS_PROCESSES_HUMAN_TRACKER_HUMAN_TRACKER_OPTIONS_H_

#include "common/config/config_reader.h"
#include "common/config/option_table.h"
#include "common/human/human_tracker.h"

namespace airdos {

/// launch_scripts/config/human_tracker.yaml
OptionTable TableOf(HumanTrackerOptions* options);

/// Throws InputError naming key and value. Leaves Finish() to the caller.
HumanTrackerOptions ReadHumanTrackerOptions(ConfigReader* config);

}  // namespace airdos

#endif  // AIRDOS_PROCESSES_HUMAN_TRACKER_HUMAN_TRACKER_OPTIONS_H_
