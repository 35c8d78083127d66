#include "common/dataset/kitti_tracking_sequence.h"

#include <Eigen/LU>
#include <algorithm>
#include <filesystem>
#include <map>
#include <optional>
#include <utility>

#include "common/dataset/folder_sequence.h"
#include "common/dataset/kitti_calibration.h"
#include "common/dataset/oxts.h"
#include "common/dataset/sequence_files.h"
#include "common/util/error.h"

namespace airdos {
namespace {

namespace fs = std::filesystem;

/// The folder without a trailing slash, which would count as a path component.
fs::path Plain(const std::string& folder) {
  const fs::path path = fs::absolute(folder).lexically_normal();
  return path.has_filename() ? path : path.parent_path();
}

/// The lines of a calibration file, by name.
class CalibrationFile {
 public:
  explicit CalibrationFile(std::string path) : path_(std::move(path)) {
    for (TextLine& line : ReadTextLines(path_)) {
      std::string name = line.words[0];
      if (name.back() == ':') name.pop_back();
      lines_[name] = std::move(line);
    }
  }

  KittiProjection Projection(const std::string& name) const {
    const auto line = lines_.find(name);
    if (line == lines_.end()) throw InputError(path_ + ": has no line " + name);
    return ParseProjection(path_, line->second, 1);
  }

  /// A 3 x 3 or 3 x 4 rigid motion under one of two names; nothing if neither is there.
  std::optional<Se3> Motion(const std::string& name, const std::string& other_name) const {
    auto found = lines_.find(name);
    if (found == lines_.end()) found = lines_.find(other_name);
    if (found == lines_.end()) return std::nullopt;
    const TextLine& line = found->second;
    const std::vector<double> m = ParseNumbers(path_, line, 1);
    const std::string where = path_ + ":" + std::to_string(line.number);
    if (m.size() != 9 && m.size() != 12) {
      throw InputError(where + ": must hold 9 or 12 numbers, holds " + std::to_string(m.size()));
    }
    const std::size_t columns = m.size() / 3;
    Eigen::Matrix3d R;
    Se3 motion;
    for (std::size_t row = 0; row < 3; ++row) {
      for (std::size_t column = 0; column < 3; ++column) {
        R(static_cast<Eigen::Index>(row), static_cast<Eigen::Index>(column)) =
            m[columns * row + column];
      }
      if (columns == 4) motion.translation[static_cast<Eigen::Index>(row)] = m[4 * row + 3];
    }
    constexpr double kRoundingOfFiles = 1e-2;
    if (!(R * R.transpose()).isIdentity(kRoundingOfFiles) || R.determinant() < 0) {
      throw InputError(where + ": is not a rotation");
    }
    motion.rotation = Eigen::Quaterniond(R).normalized();
    return motion;
  }

  const std::string& path() const { return path_; }

 private:
  std::string path_;
  std::map<std::string, TextLine> lines_;
};

/// T_C_I as in the header; nothing if a transform is missing.
std::optional<Se3> ImuInCamera(const CalibrationFile& calibration, const KittiProjection& left) {
  const std::optional<Se3> R_rect = calibration.Motion("R_rect", "R0_rect");
  const std::optional<Se3> T_cam_velo = calibration.Motion("Tr_velo_cam", "Tr_velo_to_cam");
  const std::optional<Se3> T_velo_imu = calibration.Motion("Tr_imu_velo", "Tr_imu_to_velo");
  if (!R_rect || !T_cam_velo || !T_velo_imu) return std::nullopt;
  // P = K [I | t]: a point p in the rectified camera 0 is at p + t in this camera.
  const std::vector<double>& p = left.p;
  Se3 T_C_rect;
  T_C_rect.translation = {(p[3] - p[2] * p[11]) / p[0], (p[7] - p[6] * p[11]) / p[5], p[11]};
  return T_C_rect * *R_rect * *T_cam_velo * *T_velo_imu;
}

void FillGroundTruth(const CalibrationFile& calibration, const KittiProjection& left,
                     const std::string& oxts_path, FolderSequence::Contents* contents) {
  if (!fs::exists(oxts_path)) {
    contents->notes.push_back(oxts_path + " is not there: no ground truth");
    return;
  }
  const std::optional<Se3> T_C_I = ImuInCamera(calibration, left);
  if (!T_C_I) {
    contents->notes.push_back(calibration.path() +
                              ": no R_rect, Tr_velo_cam or Tr_imu_velo: no ground truth");
    return;
  }
  const std::vector<Se3> T_W_I = ReadOxts(oxts_path);
  const Se3 T_I_C = T_C_I->inverse();
  std::vector<Se3> T_C0_C;
  for (const Se3& pose : T_W_I) T_C0_C.push_back((T_W_I[0] * T_I_C).inverse() * pose * T_I_C);
  FillPosesByRow(oxts_path, "records", T_C0_C, contents);
  contents->axes = TrajectoryAxes::kOptical;
}

}  // namespace

bool IsKittiTrackingSequence(const std::string& folder) {
  const fs::path images = Plain(folder).parent_path();
  return images.filename() == "image_02" && fs::is_directory(images.parent_path() / "calib");
}

std::unique_ptr<StereoSequence> OpenKittiTrackingSequence(const std::string& folder) {
  const std::string name = Plain(folder).filename().string();
  const fs::path split = Plain(folder).parent_path().parent_path();
  FolderSequence::Contents contents;
  contents.folder = split.string();
  contents.left_folder = "image_02/" + name;
  contents.right_folder = "image_03/" + name;
  contents.people_subfolder = name;
  FillImagesAndTimes(&contents);

  const CalibrationFile calibration((split / "calib" / (name + ".txt")).string());
  const KittiProjection left = calibration.Projection("P2");
  contents.camera =
      MakeStereoCamera(calibration.path(), left, calibration.Projection("P3"),
                       ReadImageSize(contents.left.folder + "/" + contents.left.files[0]));
  FillGroundTruth(calibration, left, (split / "oxts" / (name + ".txt")).string(), &contents);
  return std::make_unique<FolderSequence>(std::move(contents));
}

}  // namespace airdos
