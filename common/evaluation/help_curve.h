#ifndef AIRDOS_COMMON_EVALUATION_HELP_CURVE_H_
#define AIRDOS_COMMON_EVALUATION_HELP_CURVE_H_

#include <array>
#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

namespace airdos {

// When do people help? The same sequences with fewer and fewer static features per frame, once with
// people only masked (mask_only) and once with people in the estimate (on).

/// The figures of a run that are compared; for each, smaller is better.
enum class RunFigure { kAte, kRpeMedian, kRpeRmse, kLost };
constexpr std::size_t kNumRunFigures = 4;
using RunFigures = std::array<double, kNumRunFigures>;  ///< in m, m, m, % of the frames

/// One run on one sequence.
struct CappedRun {
  std::string sequence;
  std::string mode;        ///< "mask_only" or "on"
  std::optional<int> cap;  ///< limit of static observations per frame; nothing: as configured
  RunFigures figures{};
};

/// Reads one JSON object per line: {"sequence", "mode", "max_observations" (null: as configured),
/// "frames", "frames_lost", "ate_m", "rpe_median_m", "rpe_rmse_m"}. Throws InputError naming file
/// and line.
std::vector<CappedRun> ReadCappedRuns(const std::string& path);

/// Distribution of one figure over the sequences.
struct Spread {
  double median = 0;
  double lower_quartile = 0;  ///< as Quantile() of common/util/quantile.h has them
  double upper_quartile = 0;
};

/// Summary of all sequences for one cap.
struct HelpPoint {
  std::optional<int> cap;
  std::size_t num_sequences = 0;
  std::array<Spread, kNumRunFigures> mask_only;
  std::array<Spread, kNumRunFigures> on;
  /// Median over the sequences of on / mask_only; below 1, people help. If both are zero, the ratio
  /// of a sequence is 1; if only mask_only is zero, it is infinite.
  RunFigures median_ratio{};
  /// Sum over the sequences of on / the same for mask_only. For lost frames, which are zero in many
  /// sequences, it is more informative than the median.
  RunFigures ratio_of_sums{};
};

/// The runs and their summary for each cap.
struct HelpCurve {
  std::vector<CappedRun> runs;    ///< sorted by sequence, cap, mode
  std::vector<HelpPoint> points;  ///< sorted by cap; without a cap comes last
};

/// Throws InputError if a sequence was not run in both modes at one of its caps, if it was run
/// twice, or if a mode is unknown.
HelpCurve ComputeHelpCurve(std::vector<CappedRun> runs);

/// Markdown: a table of all runs, a table over the sequences, and one line per cap.
std::string ToMarkdown(const HelpCurve& curve);
nlohmann::json ToJson(const HelpCurve& curve);

}  // namespace airdos

#endif  // AIRDOS_COMMON_EVALUATION_HELP_CURVE_H_
