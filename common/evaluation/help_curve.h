#ifndef AIRDOS_COMMON_EVALUATION_HELP_CURVE_H_
#define AIRDOS_COMMON_EVALUATION_HELP_CURVE_H_

#include <array>
#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

namespace airdos {

// When people help: the same sequences with fewer and fewer static features a frame, once with
// people only masked (mask_only) and once with people in the estimate (on).

/// The figures of a run that are compared; smaller is better for each.
enum class RunFigure { kAte, kRpeMedian, kRpeRmse, kLost };
constexpr std::size_t kNumRunFigures = 4;
using RunFigures = std::array<double, kNumRunFigures>;  ///< m, m, m, % of the frames

/// One run of one sequence.
struct CappedRun {
  std::string sequence;
  std::string mode;        ///< "mask_only" or "on"
  std::optional<int> cap;  ///< static observations a frame at most; nothing: as configured
  RunFigures figures{};
};

/// Reads one JSON object a line: {"sequence", "mode", "max_observations" (null: as configured),
/// "frames", "frames_lost", "ate_m", "rpe_median_m", "rpe_rmse_m"}. Throws InputError naming file
/// and line.
std::vector<CappedRun> ReadCappedRuns(const std::string& path);

/// Of one figure over the sequences.
struct Spread {
  double median = 0;
  double lower_quartile = 0;  ///< as Quantile() of common/util/quantile.h has them
  double upper_quartile = 0;
};

/// What all sequences say about one cap.
struct HelpPoint {
  std::optional<int> cap;
  std::size_t num_sequences = 0;
  std::array<Spread, kNumRunFigures> mask_only;
  std::array<Spread, kNumRunFigures> on;
  /// Median over the sequences of on / mask_only; below 1, people help. Where both are zero the
  /// ratio of a sequence is 1, where only mask_only is, infinite.
  RunFigures median_ratio{};
  /// Sum over the sequences of on / the same of mask_only; for the frames lost, which are zero in
  /// many sequences, it says more than the median.
  RunFigures ratio_of_sums{};
};

struct HelpCurve {
  std::vector<CappedRun> runs;    ///< by sequence, cap, mode
  std::vector<HelpPoint> points;  ///< by cap, the one without a cap last
};

/// Throws InputError where a sequence lacks one of both modes at a cap that it was run with, has a
/// run twice, or a mode is another one.
HelpCurve ComputeHelpCurve(std::vector<CappedRun> runs);

/// Markdown: a table of all runs, a table over the sequences, and a line for each cap.
std::string ToMarkdown(const HelpCurve& curve);
nlohmann::json ToJson(const HelpCurve& curve);

}  // namespace airdos

#endif  // AIRDOS_COMMON_EVALUATION_HELP_CURVE_H_
