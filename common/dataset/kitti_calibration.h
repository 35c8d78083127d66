#ifndef AIRDOS_COMMON_DATASET_KITTI_CALIBRATION_H_
#define AIRDOS_COMMON_DATASET_KITTI_CALIBRATION_H_

#include <string>
#include <utility>
#include <vector>

#include "common/geometry/stereo_camera.h"
#include "common/util/text_file.h"

namespace airdos {

/// A 3 x 4 projection matrix (px, px m), row-major, and where it was read.
struct KittiProjection {
  int line = 0;
  std::vector<double> p;
};

/// The twelve numbers of a line from word `first_word` on. Throws InputError naming the line if
/// there are not exactly twelve.
KittiProjection ParseProjection(const std::string& path, const TextLine& line,
                                std::size_t first_word);

/// The stereo camera that two projections form, for images of `size` (width, height in px). Throws
/// InputError naming the line if they do not form one.
StereoCamera MakeStereoCamera(const std::string& path, const KittiProjection& left,
                              const KittiProjection& right, std::pair<int, int> size);

}  // namespace airdos

#endif  // AIRDOS_COMMON_DATASET_KITTI_CALIBRATION_H_
