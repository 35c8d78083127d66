#include "common/features/image_pyramid.h"

#include <cmath>
#include <opencv2/imgproc.hpp>

#include "common/util/check.h"

namespace airdos {

ImagePyramid::ImagePyramid(const cv::Mat& image, int num_levels) {
  AIRDOS_CHECK(image.type() == CV_8UC1);
  constexpr int kMinSize_px = 64;
  double scale = 1.0;
  for (int index = 0; index < num_levels; ++index) {
    const cv::Size size(cvRound(image.cols / scale), cvRound(image.rows / scale));
    if (index > 0 && (size.width < kMinSize_px || size.height < kMinSize_px)) break;
    cv::Mat level = image;
    if (index > 0) cv::resize(levels_.back(), level, size, 0, 0, cv::INTER_LINEAR);
    levels_.push_back(level);
    scales_.push_back(scale);
    scale *= kScaleFactor;
  }
}

}  // namespace airdos
