#ifndef AIRDOS_TESTS_SUPPORT_SMALL_SEQUENCE_H_
#define AIRDOS_TESTS_SUPPORT_SMALL_SEQUENCE_H_

#include <array>
#include <filesystem>
#include <functional>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "common/geometry/se3.h"
#include "common/geometry/stereo_camera.h"

namespace airdos {

/// A sequence of the TartanAir-Shibuya layout, sound in every way, whose parts a test spoils before
/// it is written: a camera sways through a rendered room, two people stand before it.
struct SmallSequence {
  static constexpr int kNumFrames = 14;
  using Row = std::vector<std::array<double, 3>>;  ///< u, v (px), confidence of a person

  StereoCamera camera;               ///< of the images
  std::string calib_json;            ///< what the file says
  std::vector<std::string> times_s;  ///< as text
  std::vector<cv::Mat> left;         ///< CV_8UC1
  std::vector<cv::Mat> right;
  std::vector<cv::Mat> masks;                 ///< CV_8UC1; empty: no file
  std::vector<std::vector<Row>> people_left;  ///< by frame
  std::vector<std::vector<Row>> people_right;
  std::vector<Se3> T_W_C;  ///< optical axes
  std::string image_ending = ".png";
  int jpeg_quality = 95;

  /// Renders the sequence; the same every time.
  static SmallSequence Make();
  void SetCalibration(const StereoCamera& said);
  /// Writes the folder anew. Ground truth: gt_pose.txt in NED, each row passed through `spoil`,
  /// which gets t, position and rotation in NED.
  void Write(const std::filesystem::path& folder,
             const std::function<void(Eigen::Vector3d*, Eigen::Matrix3d*)>& spoil = {}) const;
};

}  // namespace airdos

#endif  // AIRDOS_TESTS_SUPPORT_SMALL_SEQUENCE_H_
