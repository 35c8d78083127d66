#ifndef AIRDOS_COMMON_PERCEPTION_NETWORK_INPUT_H_
#define AIRDOS_COMMON_PERCEPTION_NETWORK_INPUT_H_

#include <opencv2/core.hpp>

namespace airdos {

/// What a network wants its image to be like. A value that goes in is (grey level - mean) / scale
/// of its colour.
struct NetworkInputOptions {
  enum class Layout {
    kChannelsFirst,
    kChannelsLast
  };  ///< 1 x 3 x rows x columns, or the 3 at last
  enum class Colours { kRgb, kBgr };

  int width_px = 0;  ///< 0: as ChooseInputSize() says; then the height is 0, too
  int height_px = 0;
  Layout layout = Layout::kChannelsFirst;
  Colours colours = Colours::kRgb;
  double mean_red = 127.5;
  double mean_green = 127.5;
  double mean_blue = 127.5;
  double scale_red = 127.5;
  double scale_green = 127.5;
  double scale_blue = 127.5;
};

/// Where a pixel of the image is in the network's input: input = scale * image + offset_px.
struct InputPlace {
  double scale = 1;
  cv::Point2d offset_px;

  cv::Point2d ToImage(double u_px, double v_px) const {
    return {(u_px - offset_px.x) / scale, (v_px - offset_px.y) / scale};
  }
};

/// The size of an input that shows the image with a shorter side of `short_side_px`, but not larger
/// than it is; to a per cent, the smallest whose sides are multiples of `step_px`. By the shorter
/// side and not by the area, since people are as high in a wide image as in another one.
cv::Size ChooseInputSize(const cv::Size& image, int short_side_px, int step_px);

/// Where the rest of the input is that the image, whose shape is another one, does not fill.
enum class Fill {
  kBelowAndRight,  ///< of black
  kAround,         ///< of grey 114, as the networks of the YOLO family have learnt it
};

/// The whole image (CV_8UC3, BGR) within an input of `size`; `place` receives where.
cv::Mat FitIntoInput(const cv::Mat& bgr, const cv::Size& size, Fill fill, InputPlace* place);

/// The image, which has the size of the input, as the numbers that go into the network.
cv::Mat ToBlob(const NetworkInputOptions& options, const cv::Mat& bgr);

}  // namespace airdos

#endif  // AIRDOS_COMMON_PERCEPTION_NETWORK_INPUT_H_
