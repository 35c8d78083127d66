#ifndef AIRDOS_COMMON_DATASET_SHIBUYA_SEQUENCE_H_
#define AIRDOS_COMMON_DATASET_SHIBUYA_SEQUENCE_H_

#include <memory>
#include <string>

#include "common/dataset/stereo_sequence.h"

namespace airdos {

/// Opens a folder in the layout of the TartanAir-Shibuya data set:
///   image_0/ image_1/        left and right, rectified, JPEG or PNG, same numbers in both
///   calib.json               fx fy cx cy (px), baseline_m, width, height (px, optional). The
///                            public data set has no such file; its constants (640 x 360) are
///                            selected with SequenceOptions::calibration
///   times.txt                one capture time (s) per image. If missing, the times in the names,
///                            otherwise 10 Hz, with a note.
///   alphapose_0/ alphapose_1/  rows of people (keypoint_file.h); a missing or empty file means
///                            nobody
///   rcnnseg_image_0/         8-bit PNG of the left image, 0 = background
///   gt_pose.txt              `t tx ty tz qx qy qz qw`, or without t and with one row per image
/// track_id_alpha and joints_gt are never read: they are for evaluation.
///
/// By definition of the layout, gt_pose.txt has NED axes. If the poses contradict that (see
/// ContradictsNed()), the axes are kUnknown, with a note.
///
/// Throws InputError naming the file (and line) that cannot be used.
std::unique_ptr<StereoSequence> OpenShibuyaSequence(const std::string& folder,
                                                    const SequenceOptions& options = {});

/// Whether body poses cannot be those of a camera in NED axes (x forward, y right, z down, for body
/// and world):
/// - the body's z axis is on average more than 60 degrees away from the world's, although a camera
///   that is carried around is upright, or
/// - the camera travels mainly (three times as far as otherwise) along its own z axis, as a camera
///   with optical axes does; with NED axes it would be in a lift.
bool ContradictsNed(const std::vector<Se3>& T_world_body);

}  // namespace airdos

#endif  // AIRDOS_COMMON_DATASET_SHIBUYA_SEQUENCE_H_
