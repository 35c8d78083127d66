#ifndef AIRDOS_COMMON_EVALUATION_CHART_H_
#define AIRDOS_COMMON_EVALUATION_CHART_H_

#include <opencv2/core.hpp>
#include <string>
#include <vector>

namespace airdos {

/// One line of a chart, or a cloud of dots.
struct ChartSeries {
  std::string name;
  cv::Scalar color_bgr;
  int thickness_px = 2;
  std::vector<cv::Point2d> points;  ///< in the units of the axes
  bool is_dots = false;             ///< dots of thickness_px instead of a line through the points
};

/// A place on an axis that has a name of its own instead of a round number.
struct NamedTick {
  double value = 0;
  std::string name;
};

/// A chart with ticks at round numbers, a grid and a legend (where more than one series has a
/// name).
struct Chart {
  std::string title;
  std::string x_label;
  std::string y_label;
  bool equal_scale = false;  ///< one unit of x as long as one of y
  bool starts_at_zero = false;
  std::vector<NamedTick> x_ticks;  ///< instead of round numbers where there are any
  std::vector<NamedTick> y_ticks;
  std::vector<ChartSeries> series;
};

/// Draws the chart into a part of an 8-bit BGR picture.
void DrawChart(const Chart& chart, const cv::Rect& area_px, cv::Mat* picture);

/// The ticks at 1, 2 or 5 times a power of ten that lie in [low, high], about `count` of them.
std::vector<double> RoundTicks(double low, double high, int count);

}  // namespace airdos

#endif  // AIRDOS_COMMON_EVALUATION_CHART_H_
