#include "common/dataset/kitti_sequence.h"

#include <cmath>
#include <filesystem>

#include "common/dataset/folder_sequence.h"
#include "common/dataset/sequence_files.h"
#include "common/util/error.h"
#include "common/util/text_file.h"

namespace airdos {
namespace {

namespace fs = std::filesystem;

/// A 3 x 4 projection matrix, row major, and where it stands.
struct Projection {
  int line = 0;
  std::vector<double> p;
};

Projection ParseProjection(const std::string& path, const TextLine& line, std::size_t first_word) {
  Projection projection = {line.number, ParseNumbers(path, line, first_word)};
  if (projection.p.size() != 12) {
    throw InputError(path + ":" + std::to_string(line.number) +
                     ": must hold 12 numbers (3 x 4 projection), holds " +
                     std::to_string(projection.p.size()));
  }
  return projection;
}

std::pair<Projection, Projection> ReadProjections(const std::string& path) {
  std::optional<Projection> left;
  std::optional<Projection> right;
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

StereoCamera ReadCamera(const std::string& path, std::pair<int, int> size) {
  const auto [left, right] = ReadProjections(path);
  const std::string where = path + ":" + std::to_string(right.line);
  for (const std::size_t i : {0, 2, 5, 6}) {
    if (std::abs(left.p[i] - right.p[i]) > 1e-6 * std::abs(left.p[i])) {
      throw InputError(where + ": number " + std::to_string(i + 1) + " differs from " +
                       std::to_string(left.p[i]) + " of the left camera: not a rectified pair");
    }
  }
  StereoCamera camera;
  std::tie(camera.width, camera.height) = size;
  camera.fx_px = left.p[0];
  camera.cx_px = left.p[2];
  camera.fy_px = left.p[5];
  camera.cy_px = left.p[6];
  camera.baseline_m = (left.p[3] - right.p[3]) / left.p[0];
  if (!camera.IsValid()) {
    throw InputError(where + ": no pinhole pair for images of " + std::to_string(camera.width) +
                     " x " + std::to_string(camera.height) + " px (focal length " +
                     std::to_string(camera.fx_px) + " px, baseline " +
                     std::to_string(camera.baseline_m) + " m)");
  }
  return camera;
}

}  // namespace

std::unique_ptr<StereoSequence> OpenKittiSequence(const std::string& folder) {
  FolderSequence::Contents contents;
  contents.folder = folder;
  const bool has_letters = fs::is_directory(folder + "/image_l");
  contents.left_folder = has_letters ? "image_l" : "image_0";
  contents.right_folder = has_letters ? "image_r" : "image_1";
  FillImagesAndTimes(&contents);
  contents.camera =
      ReadCamera(folder + "/calib.txt",
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
