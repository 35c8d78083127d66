#ifndef AIRDOS_COMMON_DATASET_KITTI_TRACKING_SEQUENCE_H_
#define AIRDOS_COMMON_DATASET_KITTI_TRACKING_SEQUENCE_H_

#include <memory>
#include <string>

#include "common/dataset/stereo_sequence.h"

namespace airdos {

/// Opens a sequence of the KITTI tracking benchmark, given the folder of its left images,
/// SPLIT/image_02/NNNN, where SPLIT is training or testing:
///   SPLIT/image_02/NNNN/ SPLIT/image_03/NNNN/   left and right colour images, %06d.png, 10 Hz
///   SPLIT/calib/NNNN.txt   lines P2 and P3 (3 x 4 projections of the two, px) and, for the ground
///                          truth, R_rect (3 x 3), Tr_velo_cam and Tr_imu_velo (3 x 4). The names
///                          may end with a colon; R0_rect, Tr_velo_to_cam and Tr_imu_to_velo are
///                          accepted as well.
///   SPLIT/oxts/NNNN.txt    GPS/IMU records, one per image (oxts.h)
///   SPLIT/alphapose_0/NNNN/ SPLIT/alphapose_1/NNNN/ SPLIT/rcnnseg_image_0/NNNN/   people, if any,
///                          in the files of shibuya_sequence.h
/// The ground truth is the pose of the left colour camera, optical axes, relative to that of the
/// first image:
///   T_C_I = (offset of camera 2) R_rect Tr_velo_cam Tr_imu_velo,  T_C0_C = (T_W_I0 T_C_I^-1)^-1
///   T_W_I T_C_I^-1
/// Without oxts or one of the three transforms there is no ground truth, and a note says so.
///
/// Throws InputError naming the file (and line) that cannot be used.
std::unique_ptr<StereoSequence> OpenKittiTrackingSequence(const std::string& folder);

/// Whether the folder is inside one named image_02 that has a calib folder next to it.
bool IsKittiTrackingSequence(const std::string& folder);

}  // namespace airdos

#endif  // AIRDOS_COMMON_DATASET_KITTI_TRACKING_SEQUENCE_H_
