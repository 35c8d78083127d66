#ifndef AIRDOS_COMMON_DATASET_KITTI_SEQUENCE_H_
#define AIRDOS_COMMON_DATASET_KITTI_SEQUENCE_H_

#include <memory>
#include <string>

#include "common/dataset/stereo_sequence.h"

namespace airdos {

/// Opens a folder in the layout of KITTI odometry:
///   image_0/ image_1/ or image_l/ image_r/   left and right, rectified, PNG or JPEG
///   calib.txt    lines `P0:` and `P1:` of twelve numbers (3 x 4 projection, row major, px), other
///                names are ignored; or two bare lines of twelve numbers, left then right
///   times.txt    one capture time (s) an image. Without it those in the names, else 10 Hz, with a
///                note.
///   poses.txt    rows of 3 x 4 numbers: left camera in its world, optical axes. It need not start
///                at the identity.
/// and beside it, as in shibuya_sequence.h, alphapose_0/, alphapose_1/ and rcnnseg_image_0/.
/// The size of the image is read from the first image.
///
/// Throws InputError naming the file (and line) that cannot be used.
std::unique_ptr<StereoSequence> OpenKittiSequence(const std::string& folder);

}  // namespace airdos

#endif  // AIRDOS_COMMON_DATASET_KITTI_SEQUENCE_H_
