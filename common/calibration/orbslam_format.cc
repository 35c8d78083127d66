#include <tuple>

#include "common/calibration/calibration_yaml.h"
#include "common/calibration/camera_matrix.h"
#include "common/calibration/rig_formats.h"
#include "common/calibration/rigid_matrix.h"
#include "common/util/error.h"

namespace airdos {
namespace {

std::pair<int, int> ReadSize(const CalibrationYaml& yaml, const std::string& prefix) {
  return ToImageSize(yaml.Number(prefix + "width"), yaml.Number(prefix + "height"),
                     yaml.Where(prefix + "width"));
}

/// fx, fy, cx, cy below a prefix ("Camera.", "Camera1.").
CameraIntrinsics ReadPinhole(const CalibrationYaml& yaml, const std::string& prefix) {
  CameraIntrinsics camera;
  if (yaml.Has("Camera.width") || yaml.Has("Camera.height")) {
    std::tie(camera.width, camera.height) = ReadSize(yaml, "Camera.");
  }
  camera.fx_px = yaml.Number(prefix + "fx");
  camera.fy_px = yaml.Number(prefix + "fy");
  camera.cx_px = yaml.Number(prefix + "cx");
  camera.cy_px = yaml.Number(prefix + "cy");
  return camera;
}

/// Its lens by the coefficients that stand below the prefix.
void ReadLens(const CalibrationYaml& yaml, const std::string& prefix, bool is_fisheye,
              CameraIntrinsics* camera) {
  const std::vector<std::string> names =
      is_fisheye ? std::vector<std::string>{"k1", "k2", "k3", "k4"}
                 : std::vector<std::string>{"k1", "k2", "p1", "p2", "k3"};
  for (const std::string& name : names) {
    if (name == "k3" && !is_fisheye && !yaml.Has(prefix + name)) continue;
    camera->distortion.push_back(yaml.Number(prefix + name));
  }
  camera->lens = is_fisheye ? LensModel::kFisheye : LensModel::kRadialTangential;
}

double BaselineFrom(const CalibrationYaml& yaml, double fx_px) {
  if (yaml.Has("Stereo.b")) return yaml.Number("Stereo.b");
  return yaml.Number("Camera.bf") / fx_px;
}

/// A rectified pair: nothing is left to do.
StereoRig ReadRectified(const CalibrationYaml& yaml, const std::string& prefix) {
  StereoRig rig;
  rig.left = rig.right = ReadPinhole(yaml, prefix);
  const double baseline_m = BaselineFrom(yaml, rig.left.fx_px);
  rig.T_L_R.translation = Eigen::Vector3d(baseline_m, 0, 0);
  rig.rectified = StereoCamera{rig.left.width, rig.left.height, rig.left.fx_px, rig.left.fy_px,
                               rig.left.cx_px, rig.left.cy_px,  baseline_m};
  rig.are_images_rectified = true;
  for (const char* key : {"k1", "k2", "p1", "p2"}) {
    const std::string name = prefix + key;
    if (yaml.Has(name) && yaml.Number(name) != 0) {
      rig.notes.push_back(
          "'" + name +
          "' is not 0, yet ORB-SLAM takes stereo images of such a file as rectified; so do we");
      break;
    }
  }
  return rig;
}

/// LEFT.* and RIGHT.*: K, D, R, P of images that are not rectified yet.
StereoRig ReadUnrectified(const CalibrationYaml& yaml) {
  struct Side {
    CameraIntrinsics camera;
    Eigen::Matrix3d R;
    ProjectionMatrix P;
  };
  const auto read = [&](const std::string& prefix) {
    Side side;
    side.camera = ToIntrinsics(yaml.Matrix3(prefix + "K"), yaml.Where(prefix + "K"));
    std::tie(side.camera.width, side.camera.height) = ReadSize(yaml, prefix);
    side.camera.lens = LensModel::kRadialTangential;
    side.camera.distortion = yaml.Numbers(prefix + "D");
    side.R = ToRotation(yaml.Matrix3(prefix + "R"), yaml.Where(prefix + "R"));
    side.P = ToProjection(yaml.Numbers(prefix + "P"), yaml.Where(prefix + "P"));
    return side;
  };
  const Side left = read("LEFT.");
  const Side right = read("RIGHT.");
  StereoRig rig;
  rig.left = left.camera;
  rig.right = right.camera;
  rig.T_L_R = RelativePose(left.R, right.R, BaselineOf(left.P, right.P));
  rig.rectified = RectifiedPair(left.P, right.P, {rig.left.width, rig.left.height});
  return rig;
}

/// Two cameras and the pose of the second in the first.
StereoRig ReadTwoCameras(const CalibrationYaml& yaml, const std::string& first,
                         const std::string& pose_key) {
  const bool is_fisheye = yaml.Has("Camera.type") && yaml.Text("Camera.type") == "KannalaBrandt8";
  StereoRig rig;
  rig.left = ReadPinhole(yaml, first);
  rig.right = ReadPinhole(yaml, "Camera2.");
  ReadLens(yaml, first, is_fisheye, &rig.left);
  ReadLens(yaml, "Camera2.", is_fisheye, &rig.right);
  rig.T_L_R = ToSe3(yaml.Transform(pose_key), yaml.Where(pose_key));
  return rig;
}

}  // namespace

bool IsOrbSlam(const CalibrationText& file) {
  return file.text.find("Camera.fx:") != std::string::npos ||
         file.text.find("Camera1.fx:") != std::string::npos;
}

StereoRig ReadOrbSlam(const CalibrationText& file) {
  const CalibrationYaml yaml = CalibrationYaml::Parse(file.text, file.path);
  const std::string first = yaml.Has("Camera1.fx") ? "Camera1." : "Camera.";
  StereoRig rig;
  if (yaml.Has("LEFT.K")) {
    rig = ReadUnrectified(yaml);
  } else if (yaml.Has("Camera2.fx") && yaml.Has("Stereo.T_c1_c2")) {
    rig = ReadTwoCameras(yaml, first, "Stereo.T_c1_c2");
  } else if (yaml.Has("Camera2.fx") && yaml.Has("Tlr")) {
    rig = ReadTwoCameras(yaml, first, "Tlr");
  } else if (yaml.Has("Camera.bf") || yaml.Has("Stereo.b")) {
    rig = ReadRectified(yaml, first);
  } else {
    throw InputError(file.path +
                     ": these are ORB-SLAM settings of a single camera: neither Camera.bf, "
                     "Stereo.b nor Stereo.T_c1_c2 is there");
  }
  rig.format = "ORB-SLAM settings";
  return rig;
}

}  // namespace airdos
