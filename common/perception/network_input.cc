#include "common/perception/network_input.h"

#include <algorithm>
#include <cmath>
#include <opencv2/dnn.hpp>
#include <opencv2/imgproc.hpp>

namespace airdos {
namespace {

constexpr double kHardly = 0.01;  // relative difference of scales
constexpr int kYoloGrey = 114;

double ScaleInto(const cv::Size& image, const cv::Size& size) {
  return std::min(static_cast<double>(size.width) / image.width,
                  static_cast<double>(size.height) / image.height);
}

}  // namespace

cv::Size ChooseInputSize(const cv::Size& image, int short_side_px, int step_px) {
  const double scale =
      std::min(1.0, static_cast<double>(short_side_px) / std::min(image.width, image.height));
  const auto side = [&](int length) {
    return step_px * std::max(1, cvCeil((1 - kHardly) * scale * length / step_px));
  };
  return {side(image.width), side(image.height)};
}

cv::Mat FitIntoInput(const cv::Mat& bgr, const cv::Size& size, Fill fill, InputPlace* place) {
  place->scale = ScaleInto(bgr.size(), size);
  const auto scaled = [&](int length, int limit) {
    return std::clamp(static_cast<int>(std::lround(length * place->scale)), 1, limit);
  };
  const cv::Size inner(scaled(bgr.cols, size.width), scaled(bgr.rows, size.height));
  cv::Mat resized;
  cv::resize(bgr, resized, inner, 0, 0, place->scale < 1 ? cv::INTER_AREA : cv::INTER_LINEAR);
  cv::Point corner(0, 0);
  if (fill == Fill::kAround)
    corner = {(size.width - inner.width) / 2, (size.height - inner.height) / 2};
  place->offset_px = corner;
  cv::Mat input(size, CV_8UC3, cv::Scalar::all(fill == Fill::kAround ? kYoloGrey : 0));
  resized.copyTo(input(cv::Rect(corner, inner)));
  return input;
}

cv::Mat ToBlob(const NetworkInputOptions& options, const cv::Mat& bgr) {
  cv::Mat values;
  bgr.convertTo(values, CV_32FC3);
  values -= cv::Scalar(options.mean_blue, options.mean_green, options.mean_red);
  cv::multiply(values,
               cv::Scalar(1 / options.scale_blue, 1 / options.scale_green, 1 / options.scale_red),
               values);
  if (options.colours == NetworkInputOptions::Colours::kRgb)
    cv::cvtColor(values, values, cv::COLOR_BGR2RGB);
  if (options.layout == NetworkInputOptions::Layout::kChannelsFirst)
    return cv::dnn::blobFromImage(values);
  const int shape[] = {1, bgr.rows, bgr.cols, 3};
  return cv::Mat(4, shape, CV_32F, values.data).clone();
}

}  // namespace airdos
