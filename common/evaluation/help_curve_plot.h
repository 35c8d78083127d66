#ifndef AIRDOS_COMMON_EVALUATION_HELP_CURVE_PLOT_H_
#define AIRDOS_COMMON_EVALUATION_HELP_CURVE_PLOT_H_

#include <opencv2/core.hpp>

#include "common/evaluation/help_curve.h"

namespace airdos {

/// Draws two panels over the caps, which are evenly spaced: median RPE-T of the runs (logarithmic)
/// and the share of lost frames. Each mode has the median over the sequences (thick), the quartiles
/// (thin) and every sequence (dots). 8-bit BGR.
cv::Mat DrawHelpCurve(const HelpCurve& curve);

}  // namespace airdos

#endif  // AIRDOS_COMMON_EVALUATION_HELP_CURVE_PLOT_H_
