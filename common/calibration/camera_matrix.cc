#include "common/calibration/camera_matrix.h"

#include <cmath>

#include "common/util/error.h"
#include "common/util/format.h"

namespace airdos {

std::pair<int, int> ToImageSize(double width, double height, const std::string& where) {
  constexpr double kMax = 100000;
  const auto is_length = [](double length) {
    return length == std::floor(length) && length >= 1 && length <= kMax;
  };
  if (!is_length(width) || !is_length(height)) {
    throw InputError(where + ": " + Format("%.9g x %.9g", width, height) +
                     " is no size of images in px");
  }
  return {static_cast<int>(width), static_cast<int>(height)};
}

CameraIntrinsics ToIntrinsics(const Eigen::Matrix3d& K, const std::string& where) {
  if (K.isZero()) throw InputError(where + " is all zeros: this camera was not calibrated");
  if (K(2, 0) > 1 && K(2, 1) > 1 && K(0, 2) == 0 && K(1, 2) == 0)
    throw InputError(where + " is written column by column; row by row is expected");
  if (K(1, 0) != 0 || K(2, 0) != 0 || K(2, 1) != 0 || K(2, 2) != 1)
    throw InputError(where + " is no camera matrix (fx 0 cx 0 fy cy 0 0 1)");
  constexpr double kMaxSkew = 1e-3;  // of fx: less than a pixel at the border
  if (std::abs(K(0, 1)) > kMaxSkew * std::abs(K(0, 0))) {
    throw InputError(where + Format(" has a skew of %.4g px, which is not supported", K(0, 1)));
  }
  CameraIntrinsics camera;
  camera.fx_px = K(0, 0);
  camera.fy_px = K(1, 1);
  camera.cx_px = K(0, 2);
  camera.cy_px = K(1, 2);
  return camera;
}

ProjectionMatrix ToProjection(const std::vector<double>& numbers, const std::string& where) {
  if (numbers.size() != 12)
    throw InputError(where + " must hold 12 numbers, holds " + std::to_string(numbers.size()));
  const ProjectionMatrix P = Eigen::Map<const ProjectionMatrix>(numbers.data());
  if (!(P(0, 0) > 0 && P(1, 1) > 0)) {
    throw InputError(where +
                     ": the first and the sixth number (focal lengths, px) must be above 0");
  }
  return P;
}

double BaselineOf(const ProjectionMatrix& left, const ProjectionMatrix& right) {
  return (left(0, 3) - right(0, 3)) / left(0, 0);
}

std::optional<StereoCamera> RectifiedPair(const ProjectionMatrix& left,
                                          const ProjectionMatrix& right, std::pair<int, int> size) {
  constexpr double kSame_px = 0.01;
  const double difference_px = (left.leftCols<3>() - right.leftCols<3>()).cwiseAbs().maxCoeff();
  if (!(difference_px <= kSame_px)) return std::nullopt;
  return StereoCamera{size.first,
                      size.second,
                      left(0, 0),
                      left(1, 1),
                      left(0, 2),
                      left(1, 2),
                      BaselineOf(left, right)};
}

}  // namespace airdos
