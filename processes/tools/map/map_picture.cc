#include "processes/tools/map/map_picture.h"

#include <algorithm>
#include <map>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "common/evaluation/chart.h"
#include "common/util/error.h"

namespace airdos {
namespace {

constexpr double kMaxDistance_m =
    30;  // static points farther from the camera's path would shrink the rest
constexpr int kMinLandmarkObservations = 3;
constexpr std::size_t kMinPersonFrames = 5;
const cv::Scalar kLandmarkColor(190, 190, 190);
const cv::Scalar kCameraColor(200, 90, 0);

/// One of evenly spread hues, the same for a track in every picture.
cv::Scalar ColorOf(HumanId id) {
  const auto hue = static_cast<uchar>(id.value * 67 % 180);
  const cv::Mat hsv(1, 1, CV_8UC3, cv::Scalar(hue, 200, 200));
  cv::Mat bgr;
  cv::cvtColor(hsv, bgr, cv::COLOR_HSV2BGR);
  const cv::Vec3b color = bgr.at<cv::Vec3b>(0, 0);
  return {static_cast<double>(color[0]), static_cast<double>(color[1]),
          static_cast<double>(color[2])};
}

ChartSeries CameraPath(const FourDMap& map) {
  ChartSeries series{"camera", kCameraColor, 3, {}};
  for (const auto& [id, frame] : map.frames) {
    if (const std::optional<Se3> T_W_C = frame.best()) {
      series.points.emplace_back(T_W_C->translation.x(), T_W_C->translation.z());
    }
  }
  return series;
}

ChartSeries Landmarks(const FourDMap& map, const std::vector<cv::Point2d>& path) {
  ChartSeries series{"static points", kLandmarkColor, 1, {}, true};
  for (const auto& [id, landmark] : map.landmarks) {
    if (landmark.num_observations < kMinLandmarkObservations) continue;
    const cv::Point2d point(landmark.p_W.x(), landmark.p_W.z());
    const bool is_near = std::any_of(path.begin(), path.end(), [&point](const cv::Point2d& camera) {
      return cv::norm(point - camera) < kMaxDistance_m;
    });
    if (is_near) series.points.push_back(point);
  }
  return series;
}

std::vector<ChartSeries> People(const FourDMap& map) {
  std::map<HumanId, std::vector<cv::Point2d>> paths;
  for (const auto& [key, human] : map.humans) {
    cv::Point2d sum(0, 0);
    for (const auto& [joint, state] : human.joints)
      sum += cv::Point2d(state.p_W.x(), state.p_W.z());
    if (!human.joints.empty())
      paths[key.second].push_back(sum * (1.0 / static_cast<double>(human.joints.size())));
  }
  std::vector<ChartSeries> series;
  for (const auto& [id, path] : paths) {
    if (path.size() < kMinPersonFrames) continue;
    series.push_back({series.empty() ? "people, one colour each" : "", ColorOf(id), 2, path});
  }
  return series;
}

}  // namespace

cv::Mat DrawMap(const FourDMap& map) {
  constexpr int kSize_px = 1100;
  Chart chart;
  chart.title = "map from above: " + std::to_string(map.frames.size()) + " frames, " +
                std::to_string(map.landmarks.size()) + " static points";
  chart.x_label = "x (m), right of the first camera";
  chart.y_label = "z (m), ahead";
  chart.equal_scale = true;
  const ChartSeries camera = CameraPath(map);
  chart.series.push_back(Landmarks(map, camera.points));
  for (ChartSeries& person : People(map)) chart.series.push_back(std::move(person));
  if (!camera.points.empty()) chart.series.push_back(camera);
  cv::Mat picture(kSize_px, kSize_px, CV_8UC3, cv::Scalar(255, 255, 255));
  DrawChart(chart, {0, 40, kSize_px, kSize_px - 40}, &picture);
  return picture;
}

void WriteMapPicture(const FourDMap& map, const std::string& path) {
  bool is_written = false;
  try {
    is_written = cv::imwrite(path, DrawMap(map));
  } catch (const cv::Exception&) {  // no such folder, or an unknown extension
  }
  if (!is_written) throw InputError(path + ": cannot be written as a picture");
}

}  // namespace airdos
