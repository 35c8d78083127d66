#include "tests/support/rendered_scene.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace airdos {
namespace {

/// Well-mixed bits for a lattice point (the finalizer of MurmurHash3 applied to a sum of odd
/// multiples).
double LatticeValue(std::uint32_t seed, std::int32_t x, std::int32_t y) {
  std::uint32_t bits = seed * 0x9e3779b1u + static_cast<std::uint32_t>(x) * 0x85ebca77u +
                       static_cast<std::uint32_t>(y) * 0xc2b2ae3du;
  bits = (bits ^ (bits >> 16)) * 0x85ebca6bu;
  bits = (bits ^ (bits >> 13)) * 0xc2b2ae35u;
  return static_cast<double>(bits ^ (bits >> 16)) / 4294967295.0;
}

double SmoothStep(double t) { return t * t * (3 - 2 * t); }

std::uint8_t ToGrey(double value) {
  return static_cast<std::uint8_t>(std::lround(std::min(255.0, std::max(0.0, value))));
}

}  // namespace

double SmoothNoise(std::uint32_t seed, double x, double y) {
  const auto x0 = static_cast<std::int32_t>(std::floor(x));
  const auto y0 = static_cast<std::int32_t>(std::floor(y));
  const double fx = SmoothStep(x - x0);
  const double fy = SmoothStep(y - y0);
  const double top = (1 - fx) * LatticeValue(seed, x0, y0) + fx * LatticeValue(seed, x0 + 1, y0);
  const double bottom =
      (1 - fx) * LatticeValue(seed, x0, y0 + 1) + fx * LatticeValue(seed, x0 + 1, y0 + 1);
  return (1 - fy) * top + fy * bottom;
}

cv::Mat NoisePicture(int width, int height, std::uint32_t seed, double shift_u_px,
                     double shift_v_px, double grain_px) {
  cv::Mat picture(height, width, CV_8UC1);
  for (int v = 0; v < height; ++v) {
    for (int u = 0; u < width; ++u) {
      picture.at<std::uint8_t>(v, u) = ToGrey(
          20 + 200 * SmoothNoise(seed, (u + shift_u_px) / grain_px, (v + shift_v_px) / grain_px));
    }
  }
  return picture;
}

RenderedScene::RenderedScene(std::uint32_t seed) : seed_(seed) {
  boxes_.push_back({{-6, -2.4, -8}, {6, 1.6, 12}});
  std::mt19937 random(seed);
  // Computed from raw numbers: std::uniform_real_distribution differs between standard libraries.
  // One draw per statement, as the evaluation order of arguments differs between compilers.
  const auto uniform = [&random](double low, double high) {
    return low + (high - low) * static_cast<double>(random()) / 4294967295.0;
  };
  for (const double x : {-4.0, -2.2, 0.2, 2.2, 4.2}) {
    Eigen::Vector3d size, corner;
    size.z() = uniform(0.5, 1.2);
    size.y() = uniform(0.8, 2.6);
    size.x() = uniform(0.6, 1.2);
    corner.z() = uniform(4, 8);
    corner.y() = 1.6 - size.y();
    corner.x() = x + uniform(-0.4, 0.4);
    boxes_.push_back({corner, corner + size});
  }
}

double RenderedScene::Grey(std::size_t box, int axis, bool is_far_side,
                           const Eigen::Vector3d& p_W) const {
  const double a = p_W[(axis + 1) % 3];
  const double b = p_W[(axis + 2) % 3];
  const std::uint32_t face =
      seed_ * 64 + static_cast<std::uint32_t>(box * 6) + static_cast<std::uint32_t>(2 * axis);
  const std::uint32_t texture = face + (is_far_side ? 1 : 0);
  // Three grain sizes, so that near and far faces have corners at the scale of a few pixels.
  return 15 + 90 * SmoothNoise(texture, a / 0.8, b / 0.8) +
         80 * SmoothNoise(texture + 7919, a / 0.3, b / 0.3) +
         60 * SmoothNoise(texture + 15401, a / 0.13, b / 0.13);
}

RenderedScene::Hit RenderedScene::Trace(const Eigen::Vector3d& origin_W,
                                        const Eigen::Vector3d& ray_W) const {
  // The innermost loop of many tests, without functions of Eigen or the standard library, each of
  // which a build with sanitizers calls and checks.
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const double* origin = origin_W.data();
  const double inverse[] = {1.0 / ray_W.x(), 1.0 / ray_W.y(), 1.0 / ray_W.z()};
  double nearest = kInfinity;
  std::size_t nearest_box = 0;
  int nearest_axis = 0;
  const Box* box = boxes_.data();
  const std::size_t num_boxes = boxes_.size();
  for (std::size_t i = 0; i < num_boxes; ++i, ++box) {
    const double* min = box->min_W.data();
    const double* max = box->max_W.data();
    double enter = -kInfinity;
    double leave = kInfinity;
    int enter_axis = 0;
    int leave_axis = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const double to_min = (min[axis] - origin[axis]) * inverse[axis];
      const double to_max = (max[axis] - origin[axis]) * inverse[axis];
      const double first = to_max < to_min ? to_max : to_min;
      const double last = to_max < to_min ? to_min : to_max;
      if (first > enter) {
        enter = first;
        enter_axis = axis;
      }
      if (last < leave) {
        leave = last;
        leave_axis = axis;
      }
    }
    const bool is_room = i == 0;
    const double distance = is_room ? leave : enter;
    if (enter > leave || distance <= 0 || distance >= nearest) continue;
    nearest = distance;
    nearest_box = i;
    nearest_axis = is_room ? leave_axis : enter_axis;
  }
  return {nearest,
          Grey(nearest_box, nearest_axis, ray_W[nearest_axis] > 0, origin_W + nearest * ray_W)};
}

cv::Mat RenderedScene::RenderOne(const StereoCamera& camera, const Se3& T_W_C) const {
  cv::Mat image(camera.height, camera.width, CV_8UC1);
  const Eigen::Matrix3d R_W_C = T_W_C.rotation.toRotationMatrix();
  for (int v = 0; v < camera.height; ++v) {
    auto* row = image.ptr<std::uint8_t>(v);
    for (int u = 0; u < camera.width; ++u) {
      const Eigen::Vector3d ray_C((u - camera.cx_px) / camera.fx_px,
                                  (v - camera.cy_px) / camera.fy_px, 1);
      row[u] = ToGrey(Trace(T_W_C.translation, R_W_C * ray_C).grey);
    }
  }
  return image;
}

StereoPair RenderedScene::Render(const StereoCamera& camera, const Se3& T_W_C) const {
  Se3 T_C_Cr;
  T_C_Cr.translation.x() = camera.baseline_m;
  return {RenderOne(camera, T_W_C), RenderOne(camera, T_W_C * T_C_Cr)};
}

double RenderedScene::Depth_m(const StereoCamera& camera, const Se3& T_W_C,
                              const Eigen::Vector2d& uv_px) const {
  const Eigen::Vector3d ray_C((uv_px.x() - camera.cx_px) / camera.fx_px,
                              (uv_px.y() - camera.cy_px) / camera.fy_px, 1);
  return Trace(T_W_C.translation, T_W_C.rotation * ray_C).distance;
}

StereoCamera SmallStereoCamera() {
  StereoCamera camera;
  camera.width = 320;
  camera.height = 192;
  camera.fx_px = 210;
  camera.fy_px = 210;
  camera.cx_px = 159.5;
  camera.cy_px = 95.5;
  camera.baseline_m = 0.25;
  return camera;
}

Se3 SwayingPath(int k) {
  const double t = 0.1 * k;
  Se3 T_W_C;
  T_W_C.translation = {0.7 * std::sin(0.6 * t), 0.15 * std::sin(0.9 * t), 0.5 * std::sin(0.5 * t)};
  T_W_C.rotation =
      ExpSo3({0.05 * std::sin(1.1 * t), 0.4 * std::sin(0.65 * t + 0.3), 0.06 * std::sin(0.8 * t)});
  return T_W_C;
}

}  // namespace airdos
