#include "common/evaluation/trajectory_plot.h"

#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "common/evaluation/chart.h"
#include "common/util/error.h"
#include "common/util/format.h"

namespace airdos {
namespace {

const cv::Scalar kTruthColor(170, 170, 170);
const cv::Scalar kEstimateColor(200, 90, 0);
const cv::Scalar kErrorColor(40, 40, 200);

/// The two world axes that span the plane seen from above: horizontal x vertical = up.
struct PlaneFromAbove {
  int horizontal = 0;
  int vertical = 2;
};

PlaneFromAbove FindPlane(const std::vector<TrajectoryPose>& poses) {
  Eigen::Vector3d down = Eigen::Vector3d::Zero();
  for (const TrajectoryPose& pose : poses) down += pose.rotation.col(1);
  int axis = 0;
  down.cwiseAbs().maxCoeff(&axis);
  const bool axis_points_down = down[axis] > 0;
  const int next = (axis + 1) % 3;  // axis, next, after: right-handed
  const int after = (axis + 2) % 3;
  return axis_points_down ? PlaneFromAbove{after, next} : PlaneFromAbove{next, after};
}

ChartSeries SeriesFromAbove(const std::string& name, const cv::Scalar& color, int thickness_px,
                            const PlaneFromAbove& plane, const std::vector<TrajectoryPose>& poses) {
  ChartSeries series = {name, color, thickness_px, {}};
  for (const TrajectoryPose& pose : poses) {
    series.points.emplace_back(pose.position_m[plane.horizontal], pose.position_m[plane.vertical]);
  }
  return series;
}

Chart ChartOverTime(const TrajectoryReport& report, const std::string& title,
                    const std::string& y_label, const std::vector<double>& values) {
  Chart chart;
  chart.title = title;
  chart.x_label = report.has_times ? "time since the first pose (s)" : "row";
  chart.y_label = y_label;
  chart.starts_at_zero = true;
  ChartSeries series = {"", kErrorColor, 1, {}};
  const std::vector<TrajectoryPose>& truth = report.aligned.ground_truth;
  const std::size_t offset = truth.size() - values.size();  // a motion is plotted at its end
  for (std::size_t i = 0; i < values.size(); ++i) {
    series.points.emplace_back(truth[i + offset].time_s - truth[0].time_s, values[i]);
  }
  chart.series = {series};
  return chart;
}

}  // namespace

cv::Mat DrawEvaluation(const TrajectoryReport& report, const std::string& title) {
  constexpr int kWidth = 1800;
  constexpr int kHeight = 950;
  constexpr int kTitleHeight = 70;
  constexpr int kLeftWidth = 900;
  constexpr int kPanelHeight = (kHeight - kTitleHeight) / 2;
  cv::Mat picture(kHeight, kWidth, CV_8UC3, cv::Scalar(255, 255, 255));
  cv::putText(picture, title, {90, 44}, cv::FONT_HERSHEY_SIMPLEX, 0.8, cv::Scalar(40, 40, 40), 1,
              cv::LINE_AA);

  constexpr char kAxisNames[] = {'x', 'y', 'z'};
  const PlaneFromAbove plane =
      FindPlane(report.truth_has_rotations ? report.aligned.ground_truth : report.aligned.estimate);
  Chart above;
  above.title = "from above, SE(3) aligned" + Format(", %.1f m", report.path_m) +
                Format(", %.1f %% complete", 100 * report.completeness);
  above.x_label = std::string(1, kAxisNames[plane.horizontal]) + " (m)";
  above.y_label = std::string(1, kAxisNames[plane.vertical]) + " (m)";
  above.equal_scale = true;
  above.series = {
      SeriesFromAbove("ground truth", kTruthColor, 6, plane, report.aligned.ground_truth),
      SeriesFromAbove("estimate", kEstimateColor, 2, plane, report.aligned.estimate)};
  DrawChart(above, {0, kTitleHeight, kLeftWidth, kHeight - kTitleHeight}, &picture);

  DrawChart(ChartOverTime(report, "position error" + Format(", rmse %.4f m", report.ate_se3_m.rmse),
                          "error (m)",
                          PositionErrors(report.aligned.estimate, report.aligned.ground_truth)),
            {kLeftWidth, kTitleHeight, kWidth - kLeftWidth, kPanelHeight}, &picture);
  std::vector<double> rotation_deg;
  const bool has_rotations = report.no_rotations_because.empty();
  if (has_rotations) {
    for (const RelativeError& error : ErrorsPerFrame(report.aligned)) {
      rotation_deg.push_back(error.rotation_deg);
    }
  }
  const std::string summary =
      has_rotations ? Format(", rmse %.4f deg", report.rpe_rotation_per_frame_deg.rmse)
                    : ": n/a, " + report.no_rotations_because;
  DrawChart(
      ChartOverTime(report, "rotation error per frame" + summary, "error (deg)", rotation_deg),
      {kLeftWidth, kTitleHeight + kPanelHeight, kWidth - kLeftWidth, kPanelHeight}, &picture);
  return picture;
}

void WritePng(const cv::Mat& picture, const std::string& path) {
  std::vector<unsigned char> bytes;
  cv::imencode(".png", picture, bytes);
  std::ofstream file(path, std::ios::binary);
  file.write(reinterpret_cast<const char*>(bytes.data()),
             static_cast<std::streamsize>(bytes.size()));
  if (!file.flush()) throw InputError(path + ": cannot be written");
}

}  // namespace airdos
