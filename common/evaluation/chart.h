#ifndef AIRDOS_COMMON_EVALUATION_CHART_H_
#define AIRDOS_COMMON_EVALUATION_CHART_H_

#include <opencv2/core.hpp>
#include <string>
#include <vector>

namespace airdos {

/// A line or a set of dots in a chart.
struct ChartSeries {
  std::string name;
  cv::Scalar color_bgr;
  int thickness_px = 2;
  std::vector<cv::Point2d> points;  ///< in axis units
  bool is_dots = false;             ///< dots of thickness_px instead of a line through the points
};

/// A tick with a name instead of a round number.
struct NamedTick {
  double value = 0;
  std::string name;
};

/// A chart with ticks at round numbers, a grid, and a legend if more than one series is named.
struct Chart {
  std::string title;
  std::string x_label;
  std::string y_label;
  bool equal_scale = false;  ///< whether a unit of x is as long as a unit of y
  bool starts_at_zero = false;
  std::vector<NamedTick> x_ticks;  ///< if not empty, used instead of round numbers
  std::vector<NamedTick> y_ticks;
  std::vector<ChartSeries> series;
};

/// Draws the chart into a region of an 8-bit BGR picture.
void DrawChart(const Chart& chart, const cv::Rect& area_px, cv::Mat* picture);

/// About `count` ticks in [low, high], at 1, 2 or 5 times a power of ten.
std::vector<double> RoundTicks(double low, double high, int count);

}  // namespace airdos

#endif  // AIRDOS_COMMON_EVALUATION_CHART_H_
