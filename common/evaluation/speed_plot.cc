#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "common/evaluation/chart.h"
#include "common/evaluation/speed_report.h"
#include "common/util/format.h"

namespace airdos {
namespace {

constexpr int kPanelWidth = 640;
constexpr int kHeight = 520;
const std::vector<cv::Scalar> kColors{{40, 40, 200}, {200, 90, 0}, {60, 150, 60}, {150, 60, 150}};

double Logarithm(double value) { return std::log10(std::max(value, 1e-3)); }

std::vector<NamedTick> LogarithmicTicks(const std::set<int>& values) {
  std::vector<NamedTick> ticks;
  for (const int value : values) ticks.push_back({Logarithm(value), std::to_string(value)});
  return ticks;
}

// ms over one of the figures of each solve, with one line per solver and kind of start.
Chart GrowthChart(const std::vector<SolveTime>& solves, int SolveTime::*figure) {
  std::map<std::string, ChartSeries> series;
  std::set<int> values;
  for (const SolveTime& solve : solves) {
    const std::string name = solve.solver + (solve.is_warm ? ", warm" : ", cold");
    series[name].points.emplace_back(Logarithm(solve.*figure), Logarithm(solve.cpu_ms));
    values.insert(solve.*figure);
  }
  Chart chart;
  chart.y_label = "ms, logarithmic";
  chart.x_ticks = LogarithmicTicks(values);
  for (const double ms : {0.1, 1.0, 3.0, 10.0, 30.0, 100.0, 300.0, 1000.0, 3000.0, 10000.0}) {
    chart.y_ticks.push_back({Logarithm(ms), Format("%g", ms)});
  }
  for (auto& [name, line] : series) {
    line.name = name;
    line.color_bgr = kColors[chart.series.size() % kColors.size()];
    std::sort(line.points.begin(), line.points.end(),
              [](const cv::Point2d& a, const cv::Point2d& b) { return a.x < b.x; });
    chart.series.push_back(line);
  }
  return chart;
}

Chart ProcessChart(const std::vector<ChainSpeed>& chains) {
  Chart chart;
  chart.title = "CPU per frame, median, by sequence";
  chart.x_label = "sequence, in the table's order";
  chart.y_label = "ms";
  chart.starts_at_zero = true;
  std::map<std::string, ChartSeries> series;
  for (std::size_t i = 0; i < chains.size(); ++i) {
    const double x = static_cast<double>(i) + 1;
    chart.x_ticks.push_back({x, std::to_string(i + 1)});
    for (const auto& [name, time] : chains[i].processes)
      series[name].points.emplace_back(x, time.p50_ms);
  }
  for (auto& [name, line] : series) {
    line.name = name;
    line.color_bgr = kColors[(chart.series.size() / 2) % kColors.size()];  // as its dots
    ChartSeries dots = line;
    dots.name.clear();
    dots.is_dots = true;
    dots.thickness_px = 4;
    chart.series.push_back(line);
    chart.series.push_back(dots);
  }
  return chart;
}

}  // namespace

cv::Mat DrawSpeed(const std::vector<ChainSpeed>& chains, const std::vector<SolveTime>& solves) {
  constexpr int kUsualWindow = 20;
  std::vector<Chart> charts;
  int window = 0, num_people = 0;
  for (const SolveTime& solve : solves) {
    if (!solve.problem.empty()) continue;
    if (std::abs(solve.window - kUsualWindow) < std::abs(window - kUsualWindow))
      window = solve.window;
    num_people = std::max(num_people, solve.num_people);
  }
  const auto select = [&](int SolveTime::*figure, int value) {
    std::vector<SolveTime> selected;
    for (const SolveTime& solve : solves) {
      if (solve.problem.empty() && solve.*figure == value) selected.push_back(solve);
    }
    return selected;
  };
  if (num_people > 0) {
    charts.push_back(GrowthChart(select(&SolveTime::window, window), &SolveTime::num_people));
    charts.back().title = "adjustment, window of " + std::to_string(window) + " frames";
    charts.back().x_label = "people";
    charts.push_back(GrowthChart(select(&SolveTime::num_people, num_people), &SolveTime::window));
    charts.back().title = "adjustment, " + std::to_string(num_people) + " people";
    charts.back().x_label = "window, frames";
  }
  if (!chains.empty()) charts.push_back(ProcessChart(chains));
  const int num_panels = std::max(1, static_cast<int>(charts.size()));
  cv::Mat picture(kHeight, num_panels * kPanelWidth, CV_8UC3, cv::Scalar(255, 255, 255));
  for (std::size_t i = 0; i < charts.size(); ++i) {
    DrawChart(charts[i], {static_cast<int>(i) * kPanelWidth, 0, kPanelWidth, kHeight}, &picture);
  }
  return picture;
}

}  // namespace airdos
