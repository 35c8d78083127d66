#include "processes/tools/evaluate/do_no_harm.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "common/evaluation/statistics.h"
#include "common/simulation/settings.h"
#include "common/util/format.h"

namespace airdos {
namespace {

/// Twice the cost of the static scene's residuals at the poses of `problem`. Its landmarks are
/// optimal for these poses, since nothing else constrains them.
double StaticDeviance(BundleOptions bundle, BundleProblem problem) {
  bundle.use_people = bundle.compute_covariance = false;
  bundle.max_iterations = bundle.max_iterations_after_rejection = 0;
  return 2 * SolveBundle(bundle, &problem).initial_cost;
}

void Judge(const DoNoHarmOptions& options, const Ablation::Solution& without_people,
           const Ablation::Solution& with_people, DoNoHarmRun* run) {
  const double num_free = 6.0 * static_cast<double>(with_people.problem.frames.size() - 1);
  const double deviance = StaticDeviance(BundleOptions(), with_people.problem) -
                          StaticDeviance(BundleOptions(), without_people.problem);
  run->deviance_sigmas = (deviance - num_free) / std::sqrt(2 * num_free);
  const auto& P = without_people.summary.newest_covariance;
  const auto& P_with = with_people.summary.newest_covariance;
  if (P && P_with) {
    run->relative_sigma =
        std::sqrt((*P_with).topLeftCorner<3, 3>().trace() / (*P).topLeftCorner<3, 3>().trace());
  }
  run->is_trusted = run->deviance_sigmas <= options.max_deviance_sigmas &&
                    run->relative_sigma <= options.max_relative_sigma;
}

Statistics Ratios(const DoNoHarmSetting& setting, double (DoNoHarmRun::*ratio)() const) {
  std::vector<double> ratios;
  for (const DoNoHarmRun& run : setting.runs) ratios.push_back((run.*ratio)());
  return ComputeStatistics(ratios);
}

double MedianAte(const DoNoHarmSetting& setting, AblationErrors DoNoHarmRun::*errors) {
  std::vector<double> values;
  for (const DoNoHarmRun& run : setting.runs) values.push_back((run.*errors).ate_aligned_m);
  return ComputeStatistics(values).median;
}

double TrustedShare(const DoNoHarmSetting& setting) {
  const auto num = std::count_if(setting.runs.begin(), setting.runs.end(),
                                 [](const DoNoHarmRun& run) { return run.is_trusted; });
  return static_cast<double>(num) /
         static_cast<double>(std::max<std::size_t>(setting.runs.size(), 1));
}

}  // namespace

DoNoHarmOptions DefaultDoNoHarmOptions() {
  DoNoHarmOptions options;
  options.ablation.max_iterations = 60;
  options.ablation.function_tolerance = 1e-5;
  options.ablation.compute_covariance = true;
  return options;
}

DoNoHarmSetting RunDoNoHarm(const DoNoHarmOptions& options, const std::string& setting,
                            std::uint64_t first_seed, int num_sequences,
                            const std::function<void(const DoNoHarmRun&)>& on_run) {
  DoNoHarmSetting result{setting, {}};
  for (int i = 0; i < num_sequences; ++i) {
    DoNoHarmRun run;
    run.seed = first_seed + static_cast<std::uint64_t>(i);
    const SimulatedSequence sequence = Simulate(SettingByName(setting, run.seed));
    const Ablation ablation(options.ablation, sequence);
    const Ablation::Solution without_people = ablation.Solve(AblationRow::kStatic);
    const Ablation::Solution with_people = ablation.Solve(AblationRow::kFull);
    Judge(options, without_people, with_people, &run);
    run.without_people = ablation.Evaluate(without_people.problem);
    run.decided = run.is_trusted ? ablation.Evaluate(with_people.problem) : run.without_people;
    result.runs.push_back(run);
    if (on_run) on_run(run);
  }
  return result;
}

std::string DoNoHarmTitle() {
  return "                ATE SE(3), cm     with people / without: ATE        RPE-T      trusted\n"
         "setting          without   with       median    worst   median    worst\n";
}

std::string ToLine(const DoNoHarmSetting& setting) {
  const Statistics ate = Ratios(setting, &DoNoHarmRun::AteRatio);
  const Statistics rpe = Ratios(setting, &DoNoHarmRun::RpeRatio);
  return Format("%-14s %9.2f %6.2f %12.3f %8.3f %8.3f %8.3f %7.0f %%\n", setting.setting.c_str(),
                100 * MedianAte(setting, &DoNoHarmRun::without_people),
                100 * MedianAte(setting, &DoNoHarmRun::decided), ate.median, ate.max, rpe.median,
                rpe.max, 100 * TrustedShare(setting));
}

nlohmann::json ToJson(const DoNoHarmSetting& setting) {
  nlohmann::json json{{"setting", setting.setting}, {"trusted_share", TrustedShare(setting)}};
  const auto describe = [](const Statistics& statistics) {
    return nlohmann::json{{"median", statistics.median}, {"worst", statistics.max}};
  };
  json["ate_ratio"] = describe(Ratios(setting, &DoNoHarmRun::AteRatio));
  json["rpe_ratio"] = describe(Ratios(setting, &DoNoHarmRun::RpeRatio));
  for (const DoNoHarmRun& run : setting.runs) {
    json["runs"].push_back({{"seed", run.seed},
                            {"is_trusted", run.is_trusted},
                            {"deviance_sigmas", run.deviance_sigmas},
                            {"relative_sigma", run.relative_sigma},
                            {"ate_without_people_m", run.without_people.ate_aligned_m},
                            {"ate_m", run.decided.ate_aligned_m},
                            {"rpe_without_people_m", run.without_people.rpe_m},
                            {"rpe_m", run.decided.rpe_m}});
  }
  return json;
}

}  // namespace airdos
