#include "tests/support/small_sequence.h"

#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "tests/support/rendered_scene.h"
#include "tests/support/standing_person.h"

namespace airdos {
namespace {

namespace fs = std::filesystem;

SmallSequence::Row PersonAt(double u_px, double v_px) {
  SmallSequence::Row row;
  for (const auto& offset : kStanding) row.push_back({u_px + offset[0], v_px + offset[1], 0.9});
  return row;
}

/// A detector's mask: the skeleton with thick lines.
void Paint(const SmallSequence::Row& person, cv::Mat* mask) {
  constexpr std::array<std::array<int, 2>, 14> kBones = {{{0, 1},
                                                          {1, 2},
                                                          {1, 5},
                                                          {2, 3},
                                                          {3, 4},
                                                          {5, 6},
                                                          {6, 7},
                                                          {2, 8},
                                                          {5, 11},
                                                          {8, 9},
                                                          {9, 10},
                                                          {11, 12},
                                                          {12, 13},
                                                          {16, 17}}};
  const auto point = [&](int joint) {
    const auto& at = person[static_cast<std::size_t>(joint)];
    return cv::Point(static_cast<int>(at[0]), static_cast<int>(at[1]));
  };
  for (const auto& bone : kBones) cv::line(*mask, point(bone[0]), point(bone[1]), 255, 7);
}

std::string Name(std::size_t i, const std::string& ending) {
  char name[24];
  std::snprintf(name, sizeof(name), "%06d", static_cast<int>(i));
  return name + ending;
}

void WritePeople(const fs::path& path, const std::vector<SmallSequence::Row>& people) {
  std::ofstream file(path);
  for (const SmallSequence::Row& row : people) {
    for (const auto& point : row) file << point[0] << " " << point[1] << " " << point[2] << " ";
    file << "\n";
  }
}

}  // namespace

SmallSequence SmallSequence::Make() {
  SmallSequence sequence;
  sequence.camera = SmallStereoCamera();
  sequence.SetCalibration(sequence.camera);
  const RenderedScene scene(7);
  for (int i = 0; i < kNumFrames; ++i) {
    char time[24];
    std::snprintf(time, sizeof(time), "%.6f", 0.1 * i);
    sequence.times_s.push_back(time);
    sequence.T_W_C.push_back(SwayingPath(i));
    const StereoPair pair = scene.Render(sequence.camera, sequence.T_W_C.back());
    sequence.left.push_back(pair.left);
    sequence.right.push_back(pair.right);
    sequence.people_left.push_back({PersonAt(80 + i, 60), PersonAt(220 - i, 70)});
    sequence.people_right.push_back({PersonAt(70 + i, 60), PersonAt(212 - i, 70)});
    sequence.masks.push_back(cv::Mat::zeros(pair.left.size(), CV_8UC1));
    for (const Row& person : sequence.people_left.back()) Paint(person, &sequence.masks.back());
  }
  return sequence;
}

void SmallSequence::SetCalibration(const StereoCamera& said) {
  const nlohmann::json json = {{"fx", said.fx_px},
                               {"fy", said.fy_px},
                               {"cx", said.cx_px},
                               {"cy", said.cy_px},
                               {"baseline_m", said.baseline_m}};
  calib_json = json.dump();
}

void SmallSequence::Write(
    const fs::path& folder,
    const std::function<void(Eigen::Vector3d*, Eigen::Matrix3d*)>& spoil) const {
  fs::remove_all(folder);
  for (const char* name : {"image_0", "image_1", "alphapose_0", "alphapose_1", "rcnnseg_image_0"}) {
    fs::create_directories(folder / name);
  }
  std::ofstream(folder / "calib.json") << calib_json;
  std::ofstream times(folder / "times.txt");
  for (const std::string& time : times_s) times << time << "\n";
  const std::vector<int> settings = {cv::IMWRITE_JPEG_QUALITY, jpeg_quality};
  for (std::size_t i = 0; i < left.size(); ++i) {
    cv::imwrite((folder / "image_0" / Name(i, image_ending)).string(), left[i], settings);
    cv::imwrite((folder / "image_1" / Name(i, image_ending)).string(), right[i], settings);
    if (!masks[i].empty()) {
      cv::imwrite((folder / "rcnnseg_image_0" / Name(i, ".png")).string(), masks[i]);
    }
    WritePeople(folder / "alphapose_0" / Name(i, ".txt"), people_left[i]);
    WritePeople(folder / "alphapose_1" / Name(i, ".txt"), people_right[i]);
  }
  // NED: x forward, y right, z down are the optical z, x, y.
  Eigen::Matrix3d R_ned_optical;
  R_ned_optical << 0, 0, 1, 1, 0, 0, 0, 1, 0;
  std::ofstream poses(folder / "gt_pose.txt");
  poses.precision(12);
  for (std::size_t i = 0; i < T_W_C.size(); ++i) {
    Eigen::Vector3d p = R_ned_optical * T_W_C[i].translation;
    Eigen::Matrix3d R =
        R_ned_optical * T_W_C[i].rotation.toRotationMatrix() * R_ned_optical.transpose();
    if (spoil) spoil(&p, &R);
    const Eigen::Quaterniond q(R);
    poses << 0.1 * static_cast<double>(i) << " " << p.x() << " " << p.y() << " " << p.z() << " "
          << q.x() << " " << q.y() << " " << q.z() << " " << q.w() << "\n";
  }
}

}  // namespace airdos
