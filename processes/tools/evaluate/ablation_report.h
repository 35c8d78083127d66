#ifndef AIRDOS_PROCESSES_TOOLS_EVALUATE_ABLATION_REPORT_H_
#define AIRDOS_PROCESSES_TOOLS_EVALUATE_ABLATION_REPORT_H_

#include <cstdint>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "processes/tools/evaluate/ablation.h"

namespace airdos {

/// One setting's rows over several sequences.
struct AblationGroup {
  std::string setting;
  std::uint64_t first_seed = 0;
  std::vector<std::vector<AblationErrors>> rows;  ///< [row as in AblationRows()][sequence]
};

/// Simulates `num_sequences` sequences of the setting, with seeds from `first_seed` on, and solves
/// every row. `on_progress` is called with the completed fraction; it may be empty. Throws
/// InputError for an unknown setting.
AblationGroup RunAblation(const AblationOptions& options, const std::string& setting,
                          std::uint64_t first_seed, int num_sequences,
                          const std::function<void(double)>& on_progress);

/// The paper's table as text: mean and spread over the sequences, and what the full adjustment
/// gains over the static one.
std::string ToTable(const AblationGroup& group);
nlohmann::json ToJson(const AblationGroup& group);

}  // namespace airdos

#endif  // AIRDOS_PROCESSES_TOOLS_EVALUATE_ABLATION_REPORT_H_
