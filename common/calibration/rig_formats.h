#ifndef AIRDOS_COMMON_CALIBRATION_RIG_FORMATS_H_
#define AIRDOS_COMMON_CALIBRATION_RIG_FORMATS_H_

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/calibration/stereo_rig.h"

namespace airdos {

// Readers of the files that calibration tools write, one a format. They say what stands in the
// file and how it is to be understood; whether that makes sense is judged by ReadStereoRig()
// (calibration_file.h). Each throws InputError naming file, key and value.

/// A file that was read whole.
struct CalibrationText {
  std::string path;
  std::string text;
};

/// What some files leave open.
struct FormatOptions {
  /// The size by which one of several resolutions in a file is chosen; 0 = not known.
  std::pair<int, int> chosen_size() const {
    return calibrated_size.first != 0 ? calibrated_size : image_size;
  }

  std::optional<LensModel> lens;            ///< where four coefficients may be either model's
  std::pair<int, int> image_size = {0, 0};  ///< of the user's images, px; 0 = not known
  /// Of the images that were calibrated, px, where the user says it; 0 = the file says it, or else
  /// they are the user's images.
  std::pair<int, int> calibrated_size = {0, 0};
  std::pair<int, int> kitti_cameras = {0, 1};
};

/// Kalibr's camchain.yaml and camchain-imucam.yaml, also as open_vins keeps them: the first camera
/// of the file becomes `left`. Pose by T_cn_cnm1, or through the IMU by T_cam_imu or T_imu_cam.
bool IsKalibr(const CalibrationText& file);
StereoRig ReadKalibr(const CalibrationText& file);

/// ROS camera_info, a file a camera (camera_calibration_parsers): camera_matrix,
/// distortion_coefficients, rectification_matrix, projection_matrix.
bool IsRosCameraInfo(const CalibrationText& file);
StereoRig ReadRosPair(const CalibrationText& left, const CalibrationText& right);

/// EuRoC's sensor.yaml, a file a camera: T_BS is the pose of the camera in the body.
bool IsEurocSensor(const CalibrationText& file);
StereoRig ReadEurocPair(const CalibrationText& left, const CalibrationText& right);

/// OpenCV's FileStorage in YAML: M1 D1 M2 D2 R T (also K1, cameraMatrix1, …) of
/// cv::stereoCalibrate, in one file or two (intrinsics.yml, extrinsics.yml).
bool IsOpencvStereo(const std::vector<CalibrationText>& files);
StereoRig ReadOpencvStereo(const std::vector<CalibrationText>& files, const FormatOptions& options);

/// Settings of ORB-SLAM2 and 3: rectified (Camera.bf alone), to be rectified (LEFT.*, RIGHT.*), or
/// two cameras (Camera1.*, Camera2.*, Stereo.T_c1_c2; Tlr of version 0.4).
bool IsOrbSlam(const CalibrationText& file);
StereoRig ReadOrbSlam(const CalibrationText& file);

/// KITTI: calib.txt of odometry and tracking (P0: …, rectified), calib_cam_to_cam.txt of raw
/// (P_rect_00: …; the images' size tells whether they are rectified).
bool IsKitti(const CalibrationText& file);
StereoRig ReadKitti(const CalibrationText& file, const FormatOptions& options);

/// A ZED camera's factory file SN….conf; the section is chosen by the images' width.
bool IsZed(const CalibrationText& file);
StereoRig ReadZed(const CalibrationText& file, const FormatOptions& options);

/// Our own calib.json: fx fy cx cy baseline_m of a rectified pair.
bool IsCalibJson(const CalibrationText& file);

}  // namespace airdos

#endif  // AIRDOS_COMMON_CALIBRATION_RIG_FORMATS_H_
