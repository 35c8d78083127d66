#ifndef AIRDOS_PROCESSES_PERSON_DETECTOR_PERSON_DETECTOR_OPTIONS_H_
#define AIRDOS_PROCESSES_PERSON_DETECTOR_PERSON_DETECTOR_OPTIONS_H_

#include "common/config/config_reader.h"
#include "common/config/option_table.h"
#include "common/perception/person_detector.h"

namespace airdos {

/// launch_scripts/config/person_detector.yaml. A network without a file is the one
/// that fetch_networks.sh fetches.
OptionTable TableOf(PersonDetectorOptions* options);

/// Throws InputError naming key and value, or the file of a network that is missing. Leaves
/// Finish() to the caller.
PersonDetectorOptions ReadPersonDetectorOptions(ConfigReader* config);

}  // namespace airdos

#endif  // AIRDOS_PROCESSES_PERSON_DETECTOR_PERSON_DETECTOR_OPTIONS_H_
