#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>

#include "common/check/check_folder.h"
#include "common/dataset/keypoint_file.h"
#include "common/dataset/oxts.h"
#include "common/dataset/sequence_files.h"
#include "common/dataset/stereo_sequence.h"
#include "common/dataset/times_file.h"
#include "common/util/error.h"
#include "common/util/json_file.h"
#include "processes/stereo_player/stereo_player.h"
#include "tests/fuzz/fuzz_input.h"

namespace airdos {
namespace {

namespace fs = std::filesystem;

struct Layout {
  std::string opened;  // folder inside the data set that is opened
  std::vector<std::pair<std::string, std::string>> files;  // good contents, replaced by the input
};

std::string SmallPng() {
  static const std::string file = [] {
    FuzzBytes bytes;
    cv::imencode(".png", cv::Mat(12, 16, CV_8UC1, cv::Scalar(77)), bytes);
    return std::string(bytes.begin(), bytes.end());
  }();
  return file;
}

std::string Person() {
  std::string line;
  for (int joint = 0; joint < 18; ++joint) line += "3.5 4.5 0.9 ";
  return line + "\n";
}

constexpr char kTwoPoses[] = "1 0 0 0 0 1 0 0 0 0 1 0\n1 0 0 1 0 1 0 0 0 0 1 2\n";
constexpr char kTwoTimes[] = "0.0\n0.1\n";

Layout Shibuya() {
  return {"",
          {{"image_0/000000.png", SmallPng()},
           {"image_1/000000.png", SmallPng()},
           {"image_0/000001.png", SmallPng()},
           {"image_1/000001.png", SmallPng()},
           {"times.txt", kTwoTimes},
           {"calib.json", R"({"fx":20,"fy":20,"cx":8,"cy":6,"baseline_m":0.2,"width":16})"},
           {"alphapose_0/000000.txt", Person()},
           {"alphapose_1/000000.txt", Person() + Person()},
           {"rcnnseg_image_0/000000.png", SmallPng()},
           {"gt_pose.txt", "0 1 2 3 0 0 0 1\n0.1 1 2 3 0 0 1 0\n"}}};
}

Layout KittiOdometry() {
  return {"",
          {{"image_0/000000.png", SmallPng()},
           {"image_1/000000.png", SmallPng()},
           {"image_0/000001.png", SmallPng()},
           {"image_1/000001.png", SmallPng()},
           {"times.txt", kTwoTimes},
           {"calib.txt", "P0: 20 0 8 0 0 20 6 0 0 0 1 0\nP1: 20 0 8 -4 0 20 6 0 0 0 1 0\n"},
           {"poses.txt", kTwoPoses}}};
}

Layout KittiTracking() {
  std::string oxts = "49.0 8.4 112.8 0.03 0.01 -0.6";
  for (int i = 0; i < 24; ++i) oxts += " 0";
  return {"image_02/0000",
          {{"image_02/0000/000000.png", SmallPng()},
           {"image_03/0000/000000.png", SmallPng()},
           {"calib/0000.txt",
            "P2: 20 0 8 0 0 20 6 0 0 0 1 0\nP3: 20 0 8 -4 0 20 6 0 0 0 1 0\n"
            "R_rect 1 0 0 0 1 0 0 0 1\nTr_velo_cam 1 0 0 0 0 1 0 0 0 0 1 0\n"
            "Tr_imu_velo 1 0 0 0 0 1 0 0 0 0 1 0\n"},
           {"oxts/0000.txt", oxts + "\n"},
           {"alphapose_0/0000/000000.txt", Person()}}};
}

constexpr char kSensor[] =
    "%YAML:1.0\nT_BS:\n  cols: 4\n  rows: 4\n  data: [0, 0, 1, 0, -1, 0, 0, 0, 0, -1, 0, 0, 0, 0, "
    "0, 1]\n"
    "resolution: [16, 12]\ncamera_model: pinhole\nintrinsics: [20, 20, 8, 6]\n"
    "distortion_model: radial-tangential\ndistortion_coefficients: [-0.1, 0.01, 0, 0]\n";

Layout Euroc() {
  std::string right_sensor = kSensor;
  right_sensor.replace(right_sensor.find("-1, 0, 0, 0,"), 12, "-1, 0, 0, -0.2,");
  const std::string first = "1403636579763555584";
  const std::string second = "1403636579813555584";
  return {"",
          {{"mav0/cam0/data/" + first + ".png", SmallPng()},
           {"mav0/cam1/data/" + first + ".png", SmallPng()},
           {"mav0/cam0/data/" + second + ".png", SmallPng()},
           {"mav0/cam1/data/" + second + ".png", SmallPng()},
           {"mav0/cam0/data.csv", "#timestamp [ns],filename\n" + first + "," + first + ".png\n" +
                                      second + "," + second + ".png\r\n"},
           {"mav0/cam0/sensor.yaml", kSensor},
           {"mav0/cam1/sensor.yaml", right_sensor},
           {"mav0/state_groundtruth_estimate0/data.csv",
            "#timestamp, p_RS_R_x [m]\n1403636579763555584,0,1,2,1,0,0,0,0.5\n"
            "1403636579803555584,0.5,1,2,0.6,0,0.8,0,0.5\n1403636579823555584,1,1,2,1,0,0,0\n"}}};
}

void Play(const std::string& folder) {
  try {
    const std::unique_ptr<StereoSequence> sequence = OpenStereoSequence(folder);
    sequence->notes();
    StereoPlayer player(sequence.get(), 1, ImagePackerOptions());
    for (std::size_t i = 0; i < sequence->num_frames(); ++i) {
      try {
        player.Load(i);
      } catch (const InputError&) {  // of this frame's files
      }
    }
  } catch (const InputError&) {
  }
}

/// As airdos-check does it.
void Check(const std::string& folder) {
  FindingList findings;
  try {
    CheckOptions options;
    options.max_frames = 2;
    options.odometry_frames = 2;
    CheckFolder(folder, options, &findings);
  } catch (const InputError&) {
  }
  JsonText(findings.ToJson(folder));
}

/// The input replaces files of a good data set: number, length, content.
void RunLayout(const Layout& layout, FuzzInput input, void (*use)(const std::string&) = Play) {
  const std::string folder = FuzzFolder::Path() + "/data";
  std::vector<std::pair<std::string, std::string>> files = layout.files;
  while (!input.empty()) {
    auto& [name, content] = files[input.U8() % files.size()];
    const FuzzBytes bytes = input.Block();
    content.assign(bytes.begin(), bytes.end());
  }
  for (const auto& [name, content] : files) {
    fs::create_directories(fs::path(folder + "/" + name).parent_path());
    FuzzFolder::Write("data/" + name, content.data(), content.size());
  }
  use(folder + "/" + layout.opened);
  fs::remove_all(folder);
}

/// Each file as it is, one after the other.
std::vector<FuzzBytes> SeedsOf(const Layout& layout) {
  std::vector<FuzzBytes> seeds;
  for (std::size_t i = 0; i < layout.files.size(); ++i) {
    FuzzOutput seed;
    seed.U8(static_cast<int>(i));
    seed.Block(layout.files[i].second);
    seeds.push_back(seed.Take());
  }
  return seeds;
}

void RunShibuya(const std::uint8_t* data, std::size_t size) {
  RunLayout(Shibuya(), FuzzInput(data, size));
}
std::vector<FuzzBytes> ShibuyaSeeds() { return SeedsOf(Shibuya()); }

void RunKittiOdometry(const std::uint8_t* data, std::size_t size) {
  RunLayout(KittiOdometry(), FuzzInput(data, size));
}
std::vector<FuzzBytes> KittiOdometrySeeds() { return SeedsOf(KittiOdometry()); }

void RunKittiTracking(const std::uint8_t* data, std::size_t size) {
  RunLayout(KittiTracking(), FuzzInput(data, size));
}
std::vector<FuzzBytes> KittiTrackingSeeds() { return SeedsOf(KittiTracking()); }

void RunEuroc(const std::uint8_t* data, std::size_t size) {
  RunLayout(Euroc(), FuzzInput(data, size));
}
std::vector<FuzzBytes> EurocSeeds() { return SeedsOf(Euroc()); }

void RunCheckFolder(const std::uint8_t* data, std::size_t size) {
  RunLayout(Shibuya(), FuzzInput(data, size), Check);
}

/// The text files of all layouts, without the folder around them, which takes time to make.
void RunTextFiles(const std::uint8_t* data, std::size_t size) {
  const std::string path = FuzzFolder::Write("text.txt", data, size);
  const auto attempt = [&path](const auto& read) {
    try {
      read(path);
    } catch (const InputError&) {
    }
  };
  attempt(ReadTimes);
  attempt(ReadKeypoints);
  attempt(ReadKittiPoses);
  attempt(ReadOxts);
}

std::vector<FuzzBytes> TextSeeds() {
  std::vector<FuzzBytes> seeds;
  const std::string oxts = KittiTracking().files[3].second;
  for (const std::string& text : {std::string(kTwoTimes), Person(), std::string(kTwoPoses), oxts,
                                  std::string("1.5e-3\n+2.25E1\n# comment\n")}) {
    seeds.emplace_back(text.begin(), text.end());
  }
  return seeds;
}

}  // namespace

std::vector<FuzzTarget> DatasetTargets() {
  return {{"shibuya", RunShibuya, ShibuyaSeeds, 4096},
          {"kitti_odometry", RunKittiOdometry, KittiOdometrySeeds, 4096},
          {"kitti_tracking", RunKittiTracking, KittiTrackingSeeds, 4096},
          {"euroc", RunEuroc, EurocSeeds, 4096},
          {"check_folder", RunCheckFolder, ShibuyaSeeds, 4096},
          {"text_files", RunTextFiles, TextSeeds, 4096}};
}

std::vector<FuzzTarget> FuzzTargets() {
  std::vector<FuzzTarget> all;
  for (const auto& group :
       {NodeTargets(), MessageTargets(), FileTargets(), DatasetTargets(), PictureTargets(),
        RecordingTargets(), KeypointTargets(), EvaluationTargets(), CalibrationTargets()})
    all.insert(all.end(), group.begin(), group.end());
  return all;
}

}  // namespace airdos
