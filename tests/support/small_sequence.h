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

/// A sequence in the TartanAir-Shibuya layout, valid in every respect, whose parts a test corrupts
/// before it is written: a camera sways through a rendered room with two people in front of it.
struct SmallSequence {
  static constexpr int kNumFrames = 14;
  /// u, v (px) and confidence of each joint of a person.
  using Row = std::vector<std::array<double, 3>>;

  StereoCamera camera;               ///< of the images
  std::string calib_json;            ///< content of the file
  std::vector<std::string> times_s;  ///< as text
  std::vector<cv::Mat> left;         ///< CV_8UC1
  std::vector<cv::Mat> right;
  std::vector<cv::Mat> masks;                 ///< CV_8UC1; no file if empty
  std::vector<std::vector<Row>> people_left;  ///< indexed by frame
  std::vector<std::vector<Row>> people_right;
  std::vector<Se3> T_W_C;  ///< optical axes
  std::string image_ending = ".png";
  int jpeg_quality = 95;

  /// Renders the sequence, identically every time.
  static SmallSequence Make();
  void SetCalibration(const StereoCamera& said);
  /// Writes the folder from scratch. Ground truth: gt_pose.txt in NED, each row passed through
  /// `spoil`, which gets t, position and rotation in NED.
  void Write(const std::filesystem::path& folder,
             const std::function<void(Eigen::Vector3d*, Eigen::Matrix3d*)>& spoil = {}) const;
};

}  // namespace airdos

#endif  // AIRDOS_TESTS_SUPPORT_SMALL_SEQUENCE_H_
