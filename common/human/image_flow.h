#ifndef AIRDOS_COMMON_HUMAN_IMAGE_FLOW_H_
#define AIRDOS_COMMON_HUMAN_IMAGE_FLOW_H_

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <optional>
#include <vector>

namespace airdos {

struct ImageFlowOptions {
  int window_px = 13;                ///< side of the patch that is followed
  int num_levels = 4;                ///< pyramid levels above the full image
  double max_return_error_px = 1;    ///< between a point and its way there and back
  double min_shift_response = 0.05;  ///< below it the shift of the whole image is taken as none
};

/// Follows points from one image of a camera to its next by pyramidal Lucas-Kanade, there and back.
class ImageFlow {
 public:
  explicit ImageFlow(const ImageFlowOptions& options) : options_(options) {}

  /// Takes the next image (CV_8UC1). An empty one, or one of another size than the last, breaks the
  /// chain: nothing can be followed into it.
  void SetImage(const cv::Mat& gray);

  /// Shift in px of most of the image from the last to this one, as the camera turns; zero where it
  /// is not clear.
  const Eigen::Vector2d& shift_px() const { return shift_px_; }

  /// Where points of the last image are in this one, with a first guess each; nothing for a point
  /// that leaves the image or does not come back to where it started.
  std::vector<std::optional<Eigen::Vector2d>> Follow(
      const std::vector<Eigen::Vector2d>& from_px,
      const std::vector<Eigen::Vector2d>& guess_px) const;

 private:
  void MeasureShift(const cv::Mat& gray);

  ImageFlowOptions options_;
  std::vector<cv::Mat> last_pyramid_;
  std::vector<cv::Mat> pyramid_;
  cv::Mat small_;  // for the shift of the whole image
  cv::Mat hanning_;
  cv::Size size_;
  Eigen::Vector2d shift_px_ = Eigen::Vector2d::Zero();
};

}  // namespace airdos

#endif  // AIRDOS_COMMON_HUMAN_IMAGE_FLOW_H_
