#ifndef AIRDOS_PROCESSES_TOOLS_DOCTOR_DOCTOR_MACHINE_H_
#define AIRDOS_PROCESSES_TOOLS_DOCTOR_DOCTOR_MACHINE_H_

#include <string>
#include <vector>

#include "processes/tools/doctor/doctor_report.h"

namespace airdos {

/// Where to look for the parts of lcm-spy; the first that exists is used.
struct SpyPlaces {
  std::vector<std::string> airdos_jar;
  std::string lcm_jar = "/usr/share/java/lcm.jar";
  std::string chart_jar = "/usr/share/java/jchart2d.jar";
};
/// Those of this program's build or installation, as in launch_scripts/spy.sh.
SpyPlaces DefaultSpyPlaces();

/// Checks Java and the jars that lcm-spy needs. Nothing else needs them, so the result is at worst
/// a warning.
Diagnoses JudgeSpy(const SpyPlaces& places);

/// Whether results of a run can be written to `folder` (which need not exist yet), and for how
/// long: the map takes about 0.02 MB per frame, a log of everything with JPEG images up to 0.25 MB.
Diagnoses JudgeDisk(const std::string& folder);

}  // namespace airdos

#endif  // AIRDOS_PROCESSES_TOOLS_DOCTOR_DOCTOR_MACHINE_H_
