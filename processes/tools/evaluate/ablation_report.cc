#include "processes/tools/evaluate/ablation_report.h"

#include <array>
#include <nlohmann/json.hpp>

#include "common/evaluation/statistics.h"
#include "common/simulation/settings.h"
#include "common/util/format.h"

namespace airdos {
namespace {

struct Column {
  const char* title;
  const char* key;  // in JSON
  double AblationErrors::*value;
  double scale;  // factor to the unit in the title
};
constexpr std::array<Column, 5> kColumns = {
    {{"ATE cm", "ate_unaligned_m", &AblationErrors::ate_unaligned_m, 100},
     {"ATE SE(3) cm", "ate_aligned_m", &AblationErrors::ate_aligned_m, 100},
     {"RPE-T cm", "rpe_m", &AblationErrors::rpe_m, 100},
     {"RPE-R deg", "rpe_deg", &AblationErrors::rpe_deg, 1},
     {"dynamic cm", "dynamic_m", &AblationErrors::dynamic_m, 100}}};

Statistics Of(const std::vector<AblationErrors>& sequences, const Column& column) {
  std::vector<double> values;
  for (const AblationErrors& errors : sequences) values.push_back(errors.*column.value);
  return ComputeStatistics(values);
}

int CountUnconverged(const std::vector<AblationErrors>& sequences) {
  int num = 0;
  for (const AblationErrors& errors : sequences) num += errors.has_converged ? 0 : 1;
  return num;
}

}  // namespace

AblationGroup RunAblation(const AblationOptions& options, const std::string& setting,
                          std::uint64_t first_seed, int num_sequences,
                          const std::function<void(double)>& on_progress) {
  AblationGroup group{setting, first_seed, {}};
  group.rows.resize(AblationRows().size());
  for (int i = 0; i < num_sequences; ++i) {
    const SimulatedSequence sequence =
        Simulate(SettingByName(setting, first_seed + static_cast<std::uint64_t>(i)));
    const Ablation ablation(options, sequence);
    for (std::size_t row = 0; row < AblationRows().size(); ++row) {
      group.rows[row].push_back(ablation.Run(AblationRows()[row]));
    }
    if (on_progress) on_progress(static_cast<double>(i + 1) / num_sequences);
  }
  return group;
}

std::string ToTable(const AblationGroup& group) {
  const std::size_t num_sequences = group.rows.front().size();
  std::string text = Format("%s, %zu sequences, seeds from %llu\n%-17s", group.setting.c_str(),
                            num_sequences, static_cast<unsigned long long>(group.first_seed), "");
  for (const Column& column : kColumns) text += Format(" %17s", column.title);
  text += "  unconverged\n";
  for (std::size_t row = 0; row < group.rows.size(); ++row) {
    text += Format("%-17s", NameOf(AblationRows()[row]));
    for (const Column& column : kColumns) {
      const Statistics statistics = Of(group.rows[row], column);
      text +=
          Format(" %8.3f +- %5.3f", column.scale * statistics.mean, column.scale * statistics.std);
    }
    text += Format("  %d\n", CountUnconverged(group.rows[row]));
  }
  const auto& fixed = group.rows[static_cast<std::size_t>(AblationRow::kStatic)];
  const auto& full = group.rows[static_cast<std::size_t>(AblationRow::kFull)];
  text += Format("%-17s", "full over static");
  for (std::size_t i = 0; i + 1 < kColumns.size(); ++i) {
    const double before = Of(fixed, kColumns[i]).mean;
    text += Format(" %15.1f %%", before > 0 ? 100 * (1 - Of(full, kColumns[i]).mean / before) : 0);
  }
  return text + "\n";
}

nlohmann::json ToJson(const AblationGroup& group) {
  nlohmann::json json{{"setting", group.setting}, {"first_seed", group.first_seed}};
  for (std::size_t row = 0; row < group.rows.size(); ++row) {
    nlohmann::json& into = json["rows"][NameOf(AblationRows()[row])];
    for (const Column& column : kColumns) {
      const Statistics statistics = Of(group.rows[row], column);
      into[column.key] = {{"mean", statistics.mean},
                          {"std", statistics.std},
                          {"median", statistics.median},
                          {"max", statistics.max}};
      for (const AblationErrors& errors : group.rows[row]) {
        into[column.key]["each"].push_back(errors.*column.value);
      }
    }
    into["unconverged"] = CountUnconverged(group.rows[row]);
  }
  return json;
}

}  // namespace airdos
