#include "common/evaluation/help_curve_plot.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>

#include "common/evaluation/chart.h"
#include "common/util/format.h"

namespace airdos {
namespace {

const cv::Scalar kMaskOnlyColor(40, 40, 200);
const cv::Scalar kOnColor(200, 90, 0);
constexpr double kDotsBeside = 0.08;  // relative to the distance between two caps

using ToAxis = std::function<double(double)>;

/// The runs as dots, the quartiles as thin lines, the median as a thick one.
void AddMode(const HelpCurve& curve, RunFigure run_figure, bool is_on, const ToAxis& to_axis,
             Chart* chart) {
  const auto figure = static_cast<std::size_t>(run_figure);
  const cv::Scalar color = is_on ? kOnColor : kMaskOnlyColor;
  ChartSeries dots = {"", color, 3, {}, /*is_dots=*/true};
  ChartSeries lower = {"", color, 1, {}};
  ChartSeries upper = {"", color, 1, {}};
  ChartSeries median = {is_on ? "people on" : "mask_only", color, 3, {}};
  for (std::size_t i = 0; i < curve.points.size(); ++i) {
    const double x = static_cast<double>(i);
    const Spread& spread = (is_on ? curve.points[i].on : curve.points[i].mask_only)[figure];
    lower.points.emplace_back(x, to_axis(spread.lower_quartile));
    upper.points.emplace_back(x, to_axis(spread.upper_quartile));
    median.points.emplace_back(x, to_axis(spread.median));
    for (const CappedRun& run : curve.runs) {
      if (run.cap != curve.points[i].cap || (run.mode == "on") != is_on) continue;
      dots.points.emplace_back(x + (is_on ? kDotsBeside : -kDotsBeside),
                               to_axis(run.figures[figure]));
    }
  }
  for (ChartSeries* series : {&dots, &lower, &upper, &median}) chart->series.push_back(*series);
}

Chart MakeChart(const HelpCurve& curve, RunFigure figure, const ToAxis& to_axis) {
  Chart chart;
  chart.x_label = "static features per frame, at most";
  for (std::size_t i = 0; i < curve.points.size(); ++i) {
    const auto& cap = curve.points[i].cap;
    chart.x_ticks.push_back({static_cast<double>(i), cap ? std::to_string(*cap) : "uncapped"});
  }
  AddMode(curve, figure, /*is_on=*/false, to_axis, &chart);
  AddMode(curve, figure, /*is_on=*/true, to_axis, &chart);
  return chart;
}

double LogarithmOfMm(double value_m) {
  constexpr double kLeastMm = 0.01;  // keeps a perfect run on the logarithmic axis
  return std::log10(std::max(1000 * value_m, kLeastMm));
}

}  // namespace

cv::Mat DrawHelpCurve(const HelpCurve& curve) {
  constexpr int kPanelWidth = 850;
  constexpr int kHeight = 620;
  cv::Mat picture(kHeight, 2 * kPanelWidth, CV_8UC3, cv::Scalar(255, 255, 255));
  Chart rpe = MakeChart(curve, RunFigure::kRpeMedian, LogarithmOfMm);
  rpe.title = "error of a frame's step (RPE-T, median)";
  rpe.y_label = "mm, logarithmic";
  for (const double mm :
       {0.01, 0.1, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0, 200.0, 500.0, 1000.0}) {
    rpe.y_ticks.push_back({std::log10(mm), Format("%g", mm)});
  }
  DrawChart(rpe, {0, 0, kPanelWidth, kHeight}, &picture);
  Chart lost = MakeChart(curve, RunFigure::kLost, [](double percent) { return percent; });
  lost.title = "frames lost (step wrong by over 0.10 m or 2 deg)";
  lost.y_label = "% of the frames";
  lost.starts_at_zero = true;
  DrawChart(lost, {kPanelWidth, 0, kPanelWidth, kHeight}, &picture);
  return picture;
}

}  // namespace airdos
