#ifndef AIRDOS_COMMON_DATASET_KITTI_SEQUENCE_H_
#define AIRDOS_COMMON_DATASET_KITTI_SEQUENCE_H_

#include <memory>
#include <string>

#include "common/dataset/stereo_sequence.h"

namespace airdos {

/// Opens a folder in the layout of KITTI odometry:
///   image_0/ image_1/ or image_l/ image_r/   left and right, rectified, PNG or JPEG
///   calib.txt    lines `P0:` and `P1:` with twelve numbers each (3 x 4 projection, row-major, px);
///                other names are ignored. Or two bare lines of twelve numbers, left then right.
///   times.txt    one capture time (s) per image. If missing, the times in the names, otherwise
///                10 Hz, with a note.
///   poses.txt    rows of 3 x 4 numbers: left camera in its world, optical axes. The first pose
///                need not be the identity.
/// and, as in shibuya_sequence.h, alphapose_0/, alphapose_1/ and rcnnseg_image_0/.
/// The image size is read from the first image.
///
/// Throws InputError naming the file (and line) that cannot be used.
std::unique_ptr<StereoSequence> OpenKittiSequence(const std::string& folder);

}  // namespace airdos

#endif  // AIRDOS_COMMON_DATASET_KITTI_SEQUENCE_H_
