#ifndef AIRDOS_COMMON_CALIBRATION_CAMERA_MATRIX_H_
#define AIRDOS_COMMON_CALIBRATION_CAMERA_MATRIX_H_

#include <Eigen/Core>
#include <optional>
#include <string>
#include <utility>

#include "common/calibration/stereo_rig.h"

namespace airdos {

// What the matrices and sizes in a calibration file say. `where` begins the InputError that is
// thrown where they cannot be what they should.

/// Width and height, px: whole numbers above 0.
std::pair<int, int> ToImageSize(double width, double height, const std::string& where);

/// fx, fy, cx, cy of K = (fx 0 cx; 0 fy cy; 0 0 1); no lens yet. Throws where K is another kind of
/// matrix: written column by column, all zeros (not calibrated), or skewed.
CameraIntrinsics ToIntrinsics(const Eigen::Matrix3d& K, const std::string& where);

/// P = (fx 0 cx tx; 0 fy cy 0; 0 0 1 0) of a rectified camera whose centre is at -tx / fx.
using ProjectionMatrix = Eigen::Matrix<double, 3, 4, Eigen::RowMajor>;

/// 12 numbers, row by row. Throws unless the focal lengths are above 0.
ProjectionMatrix ToProjection(const std::vector<double>& numbers, const std::string& where);

/// How far the right camera stands right of the left one, in the file's unit.
double BaselineOf(const ProjectionMatrix& left, const ProjectionMatrix& right);

/// The pair that two rectified cameras are, for images of `size` (px). Nothing if they differ in
/// more than their place along the row: such images cannot be used as they are.
std::optional<StereoCamera> RectifiedPair(const ProjectionMatrix& left,
                                          const ProjectionMatrix& right, std::pair<int, int> size);

}  // namespace airdos

#endif  // AIRDOS_COMMON_CALIBRATION_CAMERA_MATRIX_H_
