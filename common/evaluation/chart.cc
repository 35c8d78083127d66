#include "common/evaluation/chart.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "common/util/format.h"

namespace airdos {
namespace {

const cv::Scalar kInk(40, 40, 40);
const cv::Scalar kGrid(225, 225, 225);
const cv::Scalar kPaper(255, 255, 255);
constexpr int kFont = cv::FONT_HERSHEY_SIMPLEX;
constexpr double kTextScale = 0.55;
constexpr int kLeftMargin = 90;
constexpr int kRightMargin = 30;
constexpr int kTopMargin = 50;
constexpr int kBottomMargin = 70;

struct Range {
  double low = 0;
  double high = 1;
  double span() const { return high - low; }
  void Pad(double by) {
    low -= by;
    high += by;
  }
};

cv::Size TextSize(const std::string& text, double scale = kTextScale) {
  int baseline = 0;
  return cv::getTextSize(text, kFont, scale, 1, &baseline);
}

void DrawText(cv::Mat* picture, const std::string& text, cv::Point at, double scale = kTextScale) {
  cv::putText(*picture, text, at, kFont, scale, kInk, 1, cv::LINE_AA);
}

void DrawVerticalText(cv::Mat* picture, const std::string& text, cv::Point center) {
  const cv::Size size = TextSize(text);
  cv::Mat flat(size.height + 10, size.width + 4, CV_8UC3, kPaper);
  DrawText(&flat, text, {2, size.height + 2});
  cv::Mat turned;
  cv::rotate(flat, turned, cv::ROTATE_90_COUNTERCLOCKWISE);
  const cv::Rect place(center.x - turned.cols / 2, center.y - turned.rows / 2, turned.cols,
                       turned.rows);
  if ((place & cv::Rect({0, 0}, picture->size())) == place) turned.copyTo((*picture)(place));
}

std::string TickText(double value, double step) {
  const int digits = std::max(0, static_cast<int>(std::ceil(-std::log10(step) - 1e-9)));
  constexpr int kMostDigits = 5;
  const double shown = std::abs(value) < 1e-9 * step ? 0.0 : value;
  return digits > kMostDigits ? Format("%.3g", shown) : Format("%.*f", digits, shown);
}

/// Maps the units of the axes to pixels of the picture.
struct Frame {
  cv::Rect area;
  Range x;
  Range y;
  cv::Point ToPixel(const cv::Point2d& p) const {
    return {area.x + cvRound((p.x - x.low) / x.span() * area.width),
            area.y + area.height - cvRound((p.y - y.low) / y.span() * area.height)};
  }
};

Range RangeOf(const Chart& chart, double cv::Point2d::*coordinate) {
  Range range = {1e300, -1e300};
  for (const ChartSeries& series : chart.series) {
    for (const cv::Point2d& point : series.points) {
      range.low = std::min(range.low, point.*coordinate);
      range.high = std::max(range.high, point.*coordinate);
    }
  }
  if (range.low > range.high) range = {0, 1};
  return range;
}

Frame MakeFrame(const Chart& chart, const cv::Rect& area_px) {
  Frame frame;
  frame.area = {area_px.x + kLeftMargin, area_px.y + kTopMargin,
                area_px.width - kLeftMargin - kRightMargin,
                area_px.height - kTopMargin - kBottomMargin};
  frame.x = RangeOf(chart, &cv::Point2d::x);
  frame.y = RangeOf(chart, &cv::Point2d::y);
  if (chart.starts_at_zero) {
    frame.x.low = std::min(0.0, frame.x.low);
    frame.y.low = std::min(0.0, frame.y.low);
  }
  if (chart.equal_scale) {
    frame.x.Pad(0.06 * frame.x.span());
    frame.y.Pad(0.06 * frame.y.span());
    const double unit =
        std::max({frame.x.span() / frame.area.width, frame.y.span() / frame.area.height, 1e-6});
    frame.x.Pad(0.5 * (unit * frame.area.width - frame.x.span()));
    frame.y.Pad(0.5 * (unit * frame.area.height - frame.y.span()));
    return frame;
  }
  frame.y.high += 0.08 * frame.y.span();
  if (frame.x.span() <= 0) frame.x.Pad(0.5);
  if (frame.y.span() <= 0) frame.y.high = frame.y.low + 1e-3;
  return frame;
}

/// The chart's named ticks within the range, if it has any; otherwise round numbers.
std::vector<NamedTick> TicksOf(const std::vector<NamedTick>& named, const Range& range) {
  constexpr int kAboutSoMany = 7;
  std::vector<NamedTick> ticks;
  for (const NamedTick& tick : named) {
    if (tick.value >= range.low && tick.value <= range.high) ticks.push_back(tick);
  }
  if (!named.empty()) return ticks;
  const std::vector<double> values = RoundTicks(range.low, range.high, kAboutSoMany);
  const double step = values.size() > 1 ? values[1] - values[0] : 1;
  for (const double value : values) ticks.push_back({value, TickText(value, step)});
  return ticks;
}

void DrawAxes(const Chart& chart, const Frame& frame, cv::Mat* picture) {
  const cv::Rect& area = frame.area;
  for (const NamedTick& tick : TicksOf(chart.x_ticks, frame.x)) {
    const int column = frame.ToPixel({tick.value, 0}).x;
    cv::line(*picture, {column, area.y}, {column, area.br().y}, kGrid);
    DrawText(picture, tick.name, {column - TextSize(tick.name).width / 2, area.br().y + 22});
  }
  for (const NamedTick& tick : TicksOf(chart.y_ticks, frame.y)) {
    const int row = frame.ToPixel({0, tick.value}).y;
    cv::line(*picture, {area.x, row}, {area.br().x, row}, kGrid);
    DrawText(picture, tick.name, {area.x - TextSize(tick.name).width - 8, row + 5});
  }
  cv::rectangle(*picture, area, kInk);
  DrawText(picture, chart.title, {area.x, area.y - 16}, 0.65);
  DrawText(picture, chart.x_label,
           {area.x + (area.width - TextSize(chart.x_label).width) / 2, area.br().y + 52});
  DrawVerticalText(picture, chart.y_label, {area.x - kLeftMargin + 16, area.y + area.height / 2});
}

std::vector<const ChartSeries*> NamedSeries(const Chart& chart) {
  std::vector<const ChartSeries*> named;
  for (const ChartSeries& series : chart.series) {
    if (!series.name.empty()) named.push_back(&series);
  }
  return named;
}

/// Drawn in the corner of the chart area with the fewest points.
void DrawLegend(const Chart& chart, const Frame& frame, cv::Mat* picture) {
  const std::vector<const ChartSeries*> named = NamedSeries(chart);
  int width = 0;
  for (const ChartSeries* series : named)
    width = std::max(width, TextSize(series->name).width + 70);
  const cv::Size size(width, 14 + 26 * static_cast<int>(named.size()));
  const cv::Point corners[] = {
      {frame.area.x + 10, frame.area.y + 10},
      {frame.area.br().x - size.width - 10, frame.area.y + 10},
      {frame.area.x + 10, frame.area.br().y - size.height - 10},
      {frame.area.br().x - size.width - 10, frame.area.br().y - size.height - 10}};
  cv::Rect best;
  long fewest = -1;
  for (const cv::Point& corner : corners) {
    const cv::Rect box(corner, size);
    long count = 0;
    for (const ChartSeries& series : chart.series) {
      count += std::count_if(series.points.begin(), series.points.end(),
                             [&](const cv::Point2d& p) { return box.contains(frame.ToPixel(p)); });
    }
    if (fewest >= 0 && count >= fewest) continue;
    fewest = count;
    best = box;
  }
  cv::rectangle(*picture, best, kPaper, cv::FILLED);
  cv::rectangle(*picture, best, kGrid);
  for (std::size_t i = 0; i < named.size(); ++i) {
    const int row = best.y + 22 + 26 * static_cast<int>(i);
    if (named[i]->is_dots) {
      cv::circle(*picture, {best.x + 30, row - 5}, named[i]->thickness_px + 1, named[i]->color_bgr,
                 cv::FILLED, cv::LINE_AA);
    } else {
      cv::line(*picture, {best.x + 12, row - 5}, {best.x + 48, row - 5}, named[i]->color_bgr,
               named[i]->thickness_px, cv::LINE_AA);
    }
    DrawText(picture, named[i]->name, {best.x + 58, row});
  }
}

}  // namespace

std::vector<double> RoundTicks(double low, double high, int count) {
  if (!(high > low)) return {low};
  const double raw = (high - low) / count;
  const double power = std::pow(10.0, std::floor(std::log10(raw)));
  double step = 10 * power;
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * power >= raw) {
      step = factor * power;
      break;
    }
  }
  std::vector<double> ticks;
  for (double k = std::ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; ++k) {
    ticks.push_back(k * step);
  }
  return ticks;
}

void DrawChart(const Chart& chart, const cv::Rect& area_px, cv::Mat* picture) {
  const Frame frame = MakeFrame(chart, area_px);
  DrawAxes(chart, frame, picture);
  for (const ChartSeries& series : chart.series) {
    std::vector<cv::Point> pixels;
    for (const cv::Point2d& point : series.points) pixels.push_back(frame.ToPixel(point));
    if (!series.is_dots) {
      cv::polylines(*picture, pixels, false, series.color_bgr, series.thickness_px, cv::LINE_AA);
      continue;
    }
    for (const cv::Point& pixel : pixels) {
      cv::circle(*picture, pixel, series.thickness_px, series.color_bgr, cv::FILLED, cv::LINE_AA);
    }
  }
  if (NamedSeries(chart).size() > 1) DrawLegend(chart, frame, picture);
}

}  // namespace airdos
