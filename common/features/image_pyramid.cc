#include "common/features/image_pyramid.h"

#include <opencv2/imgproc.hpp>

#include "common/util/check.h"

namespace airdos {

ImagePyramid::ImagePyramid(const cv::Mat& image, int num_levels) {
  AIRDOS_CHECK(image.type() == CV_8UC1);
  constexpr int kMinSize_px = 64;
  double scale = 1.0;
  cv::Mat level = image;
  for (int index = 0; index < num_levels; ++index) {
    if (index > 0) {
      // By factor, not by size: sizes are integers, so a given size would stretch the level by up
      // to 0.4 px at its far border, unknown to ToLevel().
      cv::Mat smaller;
      cv::resize(level, smaller, {}, 1 / kScaleFactor, 1 / kScaleFactor, cv::INTER_LINEAR);
      if (smaller.cols < kMinSize_px || smaller.rows < kMinSize_px) break;
      level = smaller;
    }
    levels_.push_back(level);
    scales_.push_back(scale);
    scale *= kScaleFactor;
  }
}

}  // namespace airdos
