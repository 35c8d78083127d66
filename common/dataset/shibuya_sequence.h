#ifndef AIRDOS_COMMON_DATASET_SHIBUYA_SEQUENCE_H_
#define AIRDOS_COMMON_DATASET_SHIBUYA_SEQUENCE_H_

#include <memory>
#include <string>

#include "common/dataset/stereo_sequence.h"

namespace airdos {

/// Opens a folder in the layout of the TartanAir-Shibuya set:
///   image_0/ image_1/        left and right, rectified, JPEG or PNG, same numbers in both
///   calib.json               fx fy cx cy (px), baseline_m, width, height (px, optional). The
///                            public set has no such file: its constants (640 x 360) are asked for
///                            with SequenceOptions::calibration
///   times.txt                one capture time (s) an image. Without it those in the names, else
///                            10 Hz, with a note.
///   alphapose_0/ alphapose_1/  rows of people (keypoint_file.h); no or an empty file means nobody
///   rcnnseg_image_0/         8-bit PNG of the left image, 0 = background
///   gt_pose.txt              `t tx ty tz qx qy qz qw`, or the same without t and one row an image
/// track_id_alpha and joints_gt are never read: they are for evaluation.
///
/// The layout says that gt_pose.txt has NED axes. That is taken back (kUnknown, with a note) where
/// the poses contradict it: see ContradictsNed().
///
/// Throws InputError naming the file (and line) that cannot be used.
std::unique_ptr<StereoSequence> OpenShibuyaSequence(const std::string& folder,
                                                    const SequenceOptions& options = {});

/// True where body poses cannot be those of a camera in NED axes (x forward, y right, z down, of
/// body and world alike):
/// - the body's z axis is on average more than 60 degrees away from the world's, though a camera
///   that is carried about is upright, or
/// - the camera travels mainly (three times the rest) along its own z axis, as one in optical axes
///   does; one in NED would be in a lift.
bool ContradictsNed(const std::vector<Se3>& T_world_body);

}  // namespace airdos

#endif  // AIRDOS_COMMON_DATASET_SHIBUYA_SEQUENCE_H_
