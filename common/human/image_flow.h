#ifndef AIRDOS_COMMON_HUMAN_IMAGE_FLOW_H_
#define AIRDOS_COMMON_HUMAN_IMAGE_FLOW_H_

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <optional>
#include <vector>

namespace airdos {

/// Settings of the ImageFlow.
struct ImageFlowOptions {
  int window_px = 13;                ///< side of the tracked patch
  int num_levels = 4;                ///< pyramid levels above the full image
  double max_return_error_px = 1;    ///< allowed error after tracking forth and back
  double min_shift_response = 0.05;  ///< below it the whole image's shift is taken as zero
};

/// Follows points from one image of a camera to the next by pyramidal Lucas-Kanade, with a
/// forward-backward check.
class ImageFlow {
 public:
  explicit ImageFlow(const ImageFlowOptions& options) : options_(options) {}

  /// Sets the next image (CV_8UC1). If it is empty or differs in size from the last one, the chain
  /// is broken: nothing can be followed into it.
  void SetImage(const cv::Mat& gray);

  /// Shift in px of most of the image from the last one to this one, as caused by the camera's
  /// rotation; zero if it is unclear.
  const Eigen::Vector2d& shift_px() const { return shift_px_; }

  /// Positions in this image of points of the last one, given an initial guess for each; nothing
  /// for a point that leaves the image or fails the forward-backward check.
  std::vector<std::optional<Eigen::Vector2d>> Follow(
      const std::vector<Eigen::Vector2d>& from_px,
      const std::vector<Eigen::Vector2d>& guess_px) const;

 private:
  void MeasureShift(const cv::Mat& gray);

  ImageFlowOptions options_;
  std::vector<cv::Mat> last_pyramid_;
  std::vector<cv::Mat> pyramid_;
  cv::Mat small_;  // reduced image, for the shift of the whole image
  cv::Mat hanning_;
  cv::Size size_;
  Eigen::Vector2d shift_px_ = Eigen::Vector2d::Zero();
};

}  // namespace airdos

#endif  // AIRDOS_COMMON_HUMAN_IMAGE_FLOW_H_
