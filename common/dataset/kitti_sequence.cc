#include "common/dataset/kitti_sequence.h"

#include <filesystem>

#include "common/dataset/folder_sequence.h"
#include "common/dataset/kitti_calibration.h"
#include "common/dataset/sequence_files.h"
#include "common/util/error.h"
#include "common/util/text_file.h"

namespace airdos {
namespace {

namespace fs = std::filesystem;

std::pair<KittiProjection, KittiProjection> ReadProjections(const std::string& path) {
  std::optional<KittiProjection> left;
  std::optional<KittiProjection> right;
  for (const TextLine& line : ReadTextLines(path)) {
    const bool is_named = line.words[0].back() == ':';
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
    throw InputError(path + ": must hold the lines P0: and P1:, or two lines of 12 numbers");
  }
  return {*left, *right};
}

}  // namespace

std::unique_ptr<StereoSequence> OpenKittiSequence(const std::string& folder) {
  FolderSequence::Contents contents;
  contents.folder = folder;
  const bool has_letters = fs::is_directory(folder + "/image_l");
  contents.left_folder = has_letters ? "image_l" : "image_0";
  contents.right_folder = has_letters ? "image_r" : "image_1";
  FillImagesAndTimes(&contents);
  const std::string calibration_path = folder + "/calib.txt";
  const auto [left, right] = ReadProjections(calibration_path);
  contents.camera = MakeStereoCamera(
      calibration_path, left, right,
      ReadImageSize(folder + "/" + contents.left_folder + "/" + contents.left_names[0]));

  const std::string poses_path = folder + "/poses.txt";
  if (fs::exists(poses_path)) {
    const std::vector<Se3> poses = ReadKittiPoses(poses_path);
    const std::size_t num_images = contents.left_names.size();
    if (poses.size() != num_images) {
      contents.notes.push_back(poses_path + ": holds " + std::to_string(poses.size()) +
                               " poses for " + std::to_string(num_images) + " images");
    }
    contents.ground_truth.assign(poses.begin(), poses.end());
    contents.ground_truth.resize(num_images);
    contents.axes = TrajectoryAxes::kOptical;
  }
  return std::make_unique<FolderSequence>(std::move(contents));
}

}  // namespace airdos
