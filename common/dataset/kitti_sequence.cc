#include "common/dataset/kitti_sequence.h"

#include <cmath>
#include <filesystem>
#include <set>

#include "common/dataset/folder_sequence.h"
#include "common/dataset/kitti_calibration.h"
#include "common/dataset/sequence_files.h"
#include "common/util/error.h"
#include "common/util/text_file.h"

namespace airdos {
namespace {

namespace fs = std::filesystem;

/// Explains a file without P0 and P1.
std::string ExplainLines(const std::set<std::string>& names) {
  if (names.count("P_rect_00:") != 0) {
    return "; P_rect_00 and P_rect_01 are there (calib_cam_to_cam.txt of KITTI raw): make it with "
           "sed -n 's/^P_rect_0\\([01]\\):/P\\1:/p' calib_cam_to_cam.txt > calib.txt";
  }
  if (names.count("P_rect_02:") != 0) {
    return "; P_rect_02 and P_rect_03 are there, of the colour cameras of KITTI raw";
  }
  if (names.count("P2:") != 0 && names.count("P3:") != 0) {
    return "; P2 and P3 are there, of KITTI's colour cameras: where the images are theirs "
           "(image_2, image_3), rename these lines P0: and P1:";
  }
  return "";
}

std::pair<KittiProjection, KittiProjection> ReadProjections(const std::string& path) {
  std::optional<KittiProjection> left;
  std::optional<KittiProjection> right;
  std::set<std::string> names;
  for (const TextLine& line : ReadTextLines(path)) {
    const bool is_named = line.words[0].back() == ':';
    if (is_named) names.insert(line.words[0]);
    if (is_named && line.words[0] == "P0:") left = ParseProjection(path, line, 1);
    if (is_named && line.words[0] == "P1:") right = ParseProjection(path, line, 1);
    if (is_named) continue;
    if (left && right) {
      throw InputError(path + ":" + std::to_string(line.number) +
                       ": a third line without a name such as P2:");
    }
    (left ? right : left) = ParseProjection(path, line, 0);
  }
  if (!left || !right) {
    throw InputError(path + ": must hold the lines P0: and P1:, or two lines of 12 numbers" +
                     ExplainLines(names));
  }
  return {*left, *right};
}

/// In KITTI, P0 and P1 have no offset apart from the right camera's along the row.
void NoteColourCameras(const std::string& path, const KittiProjection& left,
                       const KittiProjection& right, std::vector<std::string>* notes) {
  constexpr double kNothing = 1e-9;
  const bool has_offset = std::abs(left.p[3]) > kNothing;
  const bool is_shifted = std::abs(left.p[7]) > kNothing || std::abs(left.p[11]) > kNothing ||
                          std::abs(right.p[7]) > kNothing || std::abs(right.p[11]) > kNothing;
  if (!has_offset && !is_shifted) return;
  const KittiProjection& where = has_offset ? left : right;
  notes->push_back(path + ":" + std::to_string(where.line) +
                   ": a camera that lies off the first one, as KITTI's colour cameras P2 and P3 "
                   "do: are the images theirs?");
}

void CheckImageFolders(const std::string& folder, const FolderSequence::Contents& contents) {
  if (fs::is_directory(folder + "/" + contents.left_folder) &&
      fs::is_directory(folder + "/" + contents.right_folder)) {
    return;
  }
  std::string remedy;
  if (fs::is_directory(folder + "/image_2") && fs::is_directory(folder + "/image_3")) {
    remedy =
        "; image_2 and image_3 are (KITTI's colour images): rename them image_0 and image_1, "
        "and P2: and P3: in calib.txt P0: and P1:";
  } else if (fs::is_directory(folder + "/image_00/data")) {
    remedy =
        "; image_00/data is (KITTI raw): make image_0 and image_1 from image_00/data and "
        "image_01/data";
  }
  throw InputError(folder + ": has a calib.txt, but " + contents.left_folder + " and " +
                   contents.right_folder + " are not both there" + remedy);
}

}  // namespace

std::unique_ptr<StereoSequence> OpenKittiSequence(const std::string& folder) {
  FolderSequence::Contents contents;
  contents.folder = folder;
  const bool has_letters = fs::is_directory(folder + "/image_l");
  contents.left_folder = has_letters ? "image_l" : "image_0";
  contents.right_folder = has_letters ? "image_r" : "image_1";
  CheckImageFolders(folder, contents);
  FillImagesAndTimes(&contents);
  const std::string calibration_path = folder + "/calib.txt";
  const auto [left, right] = ReadProjections(calibration_path);
  contents.camera =
      MakeStereoCamera(calibration_path, left, right,
                       ReadImageSize(contents.left.folder + "/" + contents.left.files[0]));

  NoteColourCameras(calibration_path, left, right, &contents.notes);

  const std::string poses_path = folder + "/poses.txt";
  if (fs::exists(poses_path)) {
    FillPosesByRow(poses_path, "poses", ReadKittiPoses(poses_path), &contents);
    contents.axes = TrajectoryAxes::kOptical;
  }
  return std::make_unique<FolderSequence>(std::move(contents));
}

}  // namespace airdos
