#ifndef AIRDOS_PROCESSES_OPTIMIZER_OPTIMIZER_OPTIONS_H_
#define AIRDOS_PROCESSES_OPTIMIZER_OPTIMIZER_OPTIONS_H_

#include "common/config/config_reader.h"
#include "common/config/option_table.h"
#include "common/optimization/window/sliding_window.h"

namespace airdos {

/// What part people have in the adjustment.
enum class PeopleMode {
  kOff,       ///< people are ignored
  kMaskOnly,  ///< they only mask static features (the front end does); the same here as kOff
  kOn,        ///< their joints are unknowns of the adjustment
};

/// What the optimizer is asked to do.
struct OptimizerOptions {
  PeopleMode people = PeopleMode::kOn;
  SlidingWindowOptions window;
};

/// launch_scripts/config/optimizer.yaml
OptionTable TableOf(OptimizerOptions* options);

/// Throws InputError naming key and value. Leaves Finish() to the caller.
OptimizerOptions ReadOptimizerOptions(ConfigReader* config);

}  // namespace airdos

#endif  // AIRDOS_PROCESSES_OPTIMIZER_OPTIMIZER_OPTIONS_H_
