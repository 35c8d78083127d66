#ifndef AIRDOS_PROCESSES_TOOLS_EVALUATE_DO_NO_HARM_H_
#define AIRDOS_PROCESSES_TOOLS_EVALUATE_DO_NO_HARM_H_

#include <cstdint>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "processes/tools/evaluate/ablation.h"

namespace airdos {

/// When people are believed in the measurement of do-no-harm.
struct DoNoHarmOptions {
  AblationOptions ablation;
  /// People are believed only if the static scene does not contradict them: its residuals at the
  /// poses with people may exceed those at its own solution only by what chance allows (a
  /// likelihood ratio with 6 degrees of freedom per free pose; this many sigmas above the mean) ...
  double max_deviance_sigmas = 3;
  /// ... and the static scene has not determined everything already: sigma of the last position
  /// with people relative to the one without.
  double max_relative_sigma = 0.98;
};
/// As in the measurement of do-no-harm: as accurate as an estimator would be, not to ten digits.
DoNoHarmOptions DefaultDoNoHarmOptions();

/// One sequence: the full adjustment, or the static one if people are not believed.
struct DoNoHarmRun {
  std::uint64_t seed = 0;
  AblationErrors without_people;
  AblationErrors decided;
  bool is_trusted = false;
  double deviance_sigmas = 0;  ///< see DoNoHarmOptions
  double relative_sigma = 1;
  double AteRatio() const { return decided.ate_aligned_m / without_people.ate_aligned_m; }
  double RpeRatio() const { return decided.rpe_m / without_people.rpe_m; }
};

/// The runs of one setting.
struct DoNoHarmSetting {
  std::string setting;
  std::vector<DoNoHarmRun> runs;
};

/// Simulates and solves `num_sequences` sequences of a setting, with seeds from `first_seed` on.
/// `on_run` may be empty.
DoNoHarmSetting RunDoNoHarm(const DoNoHarmOptions& options, const std::string& setting,
                            std::uint64_t first_seed, int num_sequences,
                            const std::function<void(const DoNoHarmRun&)>& on_run);

std::string DoNoHarmTitle();
/// One line: median and worst ratio of the errors with people to those without, and share of
/// trusted runs.
std::string ToLine(const DoNoHarmSetting& setting);
nlohmann::json ToJson(const DoNoHarmSetting& setting);

}  // namespace airdos

#endif  // AIRDOS_PROCESSES_TOOLS_EVALUATE_DO_NO_HARM_H_
