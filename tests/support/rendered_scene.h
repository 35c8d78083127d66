#ifndef AIRDOS_TESTS_SUPPORT_RENDERED_SCENE_H_
#define AIRDOS_TESTS_SUPPORT_RENDERED_SCENE_H_

#include <Eigen/Core>
#include <cstdint>
#include <opencv2/core.hpp>
#include <vector>

#include "common/geometry/se3.h"
#include "common/geometry/stereo_camera.h"

namespace airdos {

/// Smooth noise over the plane, 0..1: seeded random values on the integer lattice, interpolated by
/// cubics. The same seed and position give the same value everywhere.
double SmoothNoise(std::uint32_t seed, double x, double y);

/// A grey picture (CV_8UC1) of SmoothNoise: point (u, v) shows the noise at (u + shift_u, v +
/// shift_v), with a grain of `grain_px`. Sub-pixel shifts are exact up to rounding to grey levels.
cv::Mat NoisePicture(int width, int height, std::uint32_t seed, double shift_u_px = 0,
                     double shift_v_px = 0, double grain_px = 6);

/// The images of a stereo camera.
struct StereoPair {
  cv::Mat left;  ///< CV_8UC1
  cv::Mat right;
};

/// A seeded static world: a room of about 12 m x 4 m x 20 m with boxes in it, all faces textured.
/// Axes like the camera's: x right, y down, z along the room; the camera should stay within 1.5 m
/// of the origin. Images are exact (one ray per pixel, no motion blur), rounded to grey levels.
class RenderedScene {
 public:
  explicit RenderedScene(std::uint32_t seed);

  StereoPair Render(const StereoCamera& camera, const Se3& T_W_C) const;
  /// Depth along z of the pixel's ray, m.
  double Depth_m(const StereoCamera& camera, const Se3& T_W_C, const Eigen::Vector2d& uv_px) const;

 private:
  struct Box {
    Eigen::Vector3d min_W;
    Eigen::Vector3d max_W;
  };
  struct Hit {
    double distance = 0;  // in ray lengths
    double grey = 0;
  };

  cv::Mat RenderOne(const StereoCamera& camera, const Se3& T_W_C) const;
  Hit Trace(const Eigen::Vector3d& origin_W, const Eigen::Vector3d& ray_W) const;
  double Grey(std::size_t box, int axis, bool is_far_side, const Eigen::Vector3d& p_W) const;

  std::uint32_t seed_;
  std::vector<Box> boxes_;  // the first one is the room, seen from inside
};

/// 320 x 192 px, 75 degrees wide, 0.25 m baseline.
StereoCamera SmallStereoCamera();

/// Pose of frame `k` of a smooth walk that sways, climbs and turns: about 5 cm and 1.5 degrees per
/// frame, within 1.5 m of the origin for k in 0..60. The pose of frame 0 is not the identity.
Se3 SwayingPath(int k);

}  // namespace airdos

#endif  // AIRDOS_TESTS_SUPPORT_RENDERED_SCENE_H_
