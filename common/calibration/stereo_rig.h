#ifndef AIRDOS_COMMON_CALIBRATION_STEREO_RIG_H_
#define AIRDOS_COMMON_CALIBRATION_STEREO_RIG_H_

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/geometry/se3.h"
#include "common/geometry/stereo_camera.h"

namespace airdos {

/// How a lens departs from a pinhole.
enum class LensModel {
  kNone,              ///< not at all
  kRadialTangential,  ///< Brown-Conrady with OpenCV's extensions (ROS: plumb_bob,
                      ///< rational_polynomial)
  kFisheye,           ///< Kannala-Brandt, angles equidistant (Kalibr, ROS: equidistant)
};

/// One camera before rectification.
struct CameraIntrinsics {
  int width = 0;   ///< px; 0 = the file does not say
  int height = 0;  ///< px; 0 = the file does not say
  double fx_px = 0;
  double fy_px = 0;
  double cx_px = 0;
  double cy_px = 0;
  LensModel lens = LensModel::kNone;
  /// In OpenCV's order. Radial-tangential: k1 k2 p1 p2 [k3 [k4 k5 k6 [s1 s2 s3 s4 [tx ty]]]], so 4,
  /// 5, 8, 12 or 14 numbers. Fisheye: k1 k2 k3 k4. None: empty.
  std::vector<double> distortion;
};

/// Two cameras that look the same way, as a calibration file describes them.
struct StereoRig {
  CameraIntrinsics left;
  CameraIntrinsics right;
  Se3 T_L_R;  ///< pose of the right camera in the left one (m), both before rectification
  /// The rectified pair of which the file itself speaks: that of images rectified with that file.
  std::optional<StereoCamera> rectified;
  /// The images are rectified already: they are taken as they are, and `rectified` is their camera.
  bool are_images_rectified = false;
  std::vector<std::string> files;  ///< that it was read from
  std::string format;              ///< for example "Kalibr camera chain"
  /// The file has four coefficients that may be either lens model's, and says neither.
  bool is_lens_assumed = false;
  /// What was assumed, converted or left out: a line each, to be shown.
  std::vector<std::string> notes;
};

/// Length of T_L_R's translation, m.
double BaselineOf(const StereoRig& rig);

/// Exchanges the two cameras of a rig that is not rectified; `rectified` is dropped, as it holds
/// for the old order only.
StereoRig Swapped(const StereoRig& rig);

/// The same camera, whose images were made larger or smaller to that size (px). Pixel centres are
/// whole numbers, so the image's corner is at (-0.5, -0.5).
CameraIntrinsics Resized(const CameraIntrinsics& camera, std::pair<int, int> size);

/// T_L_R of a pair whose rectifying rotations are known: p_rect = R_rect_L * p_L in the left
/// camera, p_rect = R_rect_R * p_R in the right one, whose centre is (baseline_m, 0, 0) in
/// rectified axes.
Se3 RelativePose(const Eigen::Matrix3d& R_rect_L, const Eigen::Matrix3d& R_rect_R,
                 double baseline_m);

/// Whether `lens` may have that many coefficients.
bool IsDistortionCount(LensModel lens, std::size_t count);

/// "radial-tangential (5 coefficients)".
std::string LensText(const CameraIntrinsics& camera);

}  // namespace airdos

#endif  // AIRDOS_COMMON_CALIBRATION_STEREO_RIG_H_
