// What users' data sets look like: names, times, poses, cameras, keypoints and folders.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <functional>
#include <opencv2/imgcodecs.hpp>
#include <sstream>

#include "airdos/person_keypoints_t.hpp"
#include "common/check/check_camera.h"
#include "common/check/check_folder.h"
#include "common/dataset/file_name.h"
#include "common/dataset/image_names.h"
#include "common/dataset/image_rows.h"
#include "common/dataset/stereo_sequence.h"
#include "common/util/error.h"
#include "processes/node/message/channels.h"
#include "processes/node/message/keypoint_messages.h"
#include "processes/stereo_player/dataset_source.h"
#include "processes/stereo_player/stereo_player.h"

namespace airdos {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t kEurocNs = 1403636579763555584;

std::string Numbered(int number) {
  char name[24];
  std::snprintf(name, sizeof(name), "%06d", number);
  return name;
}

/// A data set of small blank images, in a folder that lives as long as the test.
class UserCases : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("airdos_user_cases_readers_" + std::to_string(getpid()));
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::string Path(const std::string& name) const { return (folder_ / name).string(); }
  void Write(const std::string& name, const std::string& text) const {
    fs::create_directories((folder_ / name).parent_path());
    std::ofstream(folder_ / name) << text;
  }
  void WriteLines(const std::string& name, int count,
                  const std::function<std::string(int)>& line) const {
    std::string text;
    for (int i = 0; i < count; ++i) text += line(i) + "\n";
    Write(name, text);
  }
  void WriteImage(const std::string& name, int width = 64, int height = 36) const {
    fs::create_directories((folder_ / name).parent_path());
    cv::imwrite(Path(name), cv::Mat(height, width, CV_8UC1, cv::Scalar(90)));
  }
  void WritePair(const std::string& stem) const {
    WriteImage("image_0/" + stem + ".png");
    WriteImage("image_1/" + stem + ".png");
  }
  void WriteCalibration(double cx = 32, double cy = 18, double baseline_m = 0.25,
                        double fx = 80) const {
    std::ostringstream text;
    text << "{\"fx\": " << fx << ", \"fy\": " << fx << ", \"cx\": " << cx << ", \"cy\": " << cy
         << ", \"baseline_m\": " << baseline_m << "}";
    Write("calib.json", text.str());
  }
  /// A sound data set of images 000000 ..
  void WriteSequence(int count) const {
    for (int i = 0; i < count; ++i) WritePair(Numbered(i));
    WriteCalibration();
    WriteLines("times.txt", count, [](int i) { return std::to_string(0.1 * i); });
  }
  std::unique_ptr<StereoSequence> Open(const std::string& name = "",
                                       const SequenceOptions& options = {}) const {
    return OpenStereoSequence((folder_ / name).string(), options);
  }
  std::string Refusal(const std::string& name = "") const {
    try {
      Open(name);
    } catch (const InputError& error) {
      return error.what();
    }
    return "no error";
  }
  void ExpectRefusal(const std::vector<std::string>& parts) const {
    const std::string text = Refusal();
    for (const std::string& part : parts) {
      EXPECT_NE(text.find(part), std::string::npos) << part << "\nin: " << text;
    }
    EXPECT_EQ(text.find('\n'), std::string::npos) << text;
  }
  static void ExpectNote(const StereoSequence& sequence, const std::string& part) {
    const std::vector<std::string> notes = sequence.notes();
    EXPECT_TRUE(
        std::any_of(notes.begin(), notes.end(),
                    [&](const std::string& note) { return note.find(part) != std::string::npos; }))
        << part << (notes.empty() ? " (no note)" : "\nfirst note: " + notes[0]);
  }
  static std::string Stem(const StereoSequence& sequence, std::size_t i) {
    return fs::path(sequence.files(i).left_image).stem().string();
  }
  /// The findings of airdos-check about this folder, a line each.
  std::string Check() const {
    FindingList findings;
    CheckOptions options;
    options.odometry_frames = 0;
    CheckFolder(folder_.string(), options, &findings);
    std::ostringstream text;
    findings.Print(folder_.string(), &text);
    return text.str();
  }
  void ExpectFinding(const std::string& place, const std::string& severity,
                     const std::string& part) const {
    const std::string text = Check();
    std::istringstream lines(text);
    bool is_found = false;
    for (std::string line; std::getline(lines, line);) {
      is_found = is_found || (line.find(place) != std::string::npos &&
                              line.find(": " + severity + ": ") != std::string::npos &&
                              line.find(part) != std::string::npos);
    }
    EXPECT_TRUE(is_found) << place << " " << severity << " " << part << "\nin: " << text;
  }

  fs::path folder_;
};

// ---- names of images

TEST_F(UserCases, Case41NumbersWithoutZerosAreInNaturalOrder) {
  for (int i = 1; i <= 12; ++i) WritePair("frame" + std::to_string(i));
  WriteCalibration();
  const auto sequence = Open();
  ASSERT_EQ(sequence->num_frames(), 12u);
  for (std::size_t i = 0; i < 12; ++i) {
    EXPECT_EQ(Stem(*sequence, i), "frame" + std::to_string(i + 1));
  }
}

TEST_F(UserCases, Case41NamesWithASecondNumberOrWithout) {
  const auto order_of = [&](const std::vector<std::string>& stems) {
    fs::remove_all(folder_ / "image_0");
    for (const std::string& stem : stems) WriteImage("image_0/" + stem + ".png");
    return ListImages(Path("image_0"));
  };
  ImageNames names = order_of({"000010_10", "000002_10", "000001_10"});
  EXPECT_EQ(names.keys, (std::vector<std::string>{"1", "2", "10"}));
  names = order_of({"cam0_9", "cam0_10", "cam0_11"});
  EXPECT_EQ(names.numbers, (std::vector<std::uint64_t>{9, 10, 11}));
  names = order_of({"f3_t0.5", "f1_t0.9", "f2_t0.1"});
  EXPECT_EQ(names.keys, (std::vector<std::string>{"1", "2", "3"}));
  // Dates: the order of all numbers, though the seconds begin anew.
  names = order_of({"13-02-59", "13-03-01", "13-02-57", "13-03-03"});
  EXPECT_EQ(names.keys, (std::vector<std::string>{"13-02-57", "13-02-59", "13-03-01", "13-03-03"}));
  EXPECT_TRUE(names.numbers.empty());
  names = order_of({"b", "a", "c"});
  EXPECT_EQ(names.files, (std::vector<std::string>{"a.png", "b.png", "c.png"}));
  ASSERT_EQ(names.notes.size(), 1u);
  EXPECT_NE(names.notes[0].find("in alphabetical order"), std::string::npos);
  EXPECT_THROW(order_of({"a1", "b2", "c3"}), InputError) << "no common form";
  EXPECT_THROW(order_of({"a1", "a2", "b1", "b2"}), InputError) << "two series";
}

TEST_F(UserCases, Case41bLeftAndRightMayHaveOtherWordsInTheirNames) {
  for (int i = 1; i <= 11; ++i) {
    WriteImage("image_0/left" + std::to_string(i) + ".png");
    WriteImage("image_1/right" + std::to_string(i) + ".jpg");
    Write("alphapose_0/" + Numbered(i) + ".txt", "");
  }
  WriteCalibration();
  const auto sequence = Open();
  EXPECT_EQ(sequence->files(10).left_image, Path("image_0/left11.png"));
  EXPECT_EQ(sequence->files(10).right_image, Path("image_1/right11.jpg"));
  EXPECT_EQ(sequence->files(10).keypoints_left, Path("alphapose_0/000011.txt")) << "by number";
  EXPECT_EQ(sequence->files(10).person_mask, Path("rcnnseg_image_0/left11.png"));
}

TEST_F(UserCases, Case41PairsThatDoNotMatchAreNamed) {
  WriteSequence(5);
  fs::remove(folder_ / "image_1/000002.png");
  ExpectRefusal({"image_1: holds 4 images", "holds 5", "only on the left: '000002.png'"});
  fs::remove(folder_ / "image_0/000003.png");
  ExpectRefusal({"only on the left: '000002.png'", "only on the right: '000003.png'"});
}

TEST_F(UserCases, Case59bPreviewsAreNamedAndNotTaken) {
  WriteSequence(5);
  WritePair("overview");
  Write("image_0/._000001.png", "a hidden file of macOS");
  const auto sequence = Open();
  EXPECT_EQ(sequence->num_frames(), 5u);
  ExpectNote(*sequence, "'._000001.png', 'overview.png' are not named like the other images");
  ExpectFinding("image_1", "warning", "'overview.png' is not named like");
}

TEST_F(UserCases, Case59cAnd59eCopiesAreNamedAndNotTaken) {
  WriteSequence(9);
  WriteImage("image_0/000003 (1).png");
  WriteImage("image_1/000003 (copy).png");
  const auto sequence = Open();
  ASSERT_EQ(sequence->num_frames(), 9u);
  EXPECT_EQ(Stem(*sequence, 4), "000004");
  ExpectNote(*sequence, "'000003 (1).png'");
  ExpectNote(*sequence, "'000003 (copy).png'");
  fs::remove(folder_ / "times.txt");
  EXPECT_EQ(Open()->utime(8), 800000) << "no copy shifts the times";
}

TEST_F(UserCases, Case59TwoFilesOfOneImageAreRefused) {
  WriteSequence(5);
  WriteImage("image_0/000003.jpg");
  ExpectRefusal({"image_0: two files for the same image", "'000003.jpg' and '000003.png'"});
  fs::remove(folder_ / "image_0/000003.jpg");
  WriteImage("image_0/3.png");
  ExpectRefusal({"'000003.png' and '3.png'"});
}

TEST_F(UserCases, Case59OtherKindsOfImagesAreNamed) {
  for (int i = 0; i < 3; ++i) {
    Write("image_0/" + Numbered(i) + ".pgm", "P5");
    WriteImage("image_1/" + Numbered(i) + ".png");
  }
  WriteCalibration();
  ExpectRefusal({"image_0: holds no .png or .jpg image", "3 .pgm files"});
}

// ---- rows of times and poses

TEST_F(UserCases, Case42RowsBelongToNumbersWhereTheFirstImagesAreMissing) {
  WriteSequence(12);
  WriteLines("gt_pose.txt", 12, [](int i) { return std::to_string(i) + " 0 0 0 0 0 1"; });
  for (int i = 0; i < 5; ++i) {
    for (const char* name : {"image_0/", "image_1/"}) {
      fs::remove(folder_ / (name + Numbered(i) + ".png"));
    }
  }
  const auto sequence = Open();
  EXPECT_EQ(sequence->utime(0), 500000);
  EXPECT_EQ(sequence->ground_truth(0)->translation.x(), 5);
  ExpectNote(*sequence,
             "times.txt: holds 12 times for 7 images: by the numbers in the names, row "
             "6 is that of '000005.png'");
}

TEST_F(UserCases, Case43RowsBelongToNumbersWhereOneImageIsMissing) {
  WriteSequence(12);
  for (const char* name : {"image_0/", "image_1/"}) {
    fs::remove(folder_ / (name + Numbered(5) + ".png"));
  }
  const auto sequence = Open();
  EXPECT_EQ(sequence->utime(4), 400000);
  EXPECT_EQ(sequence->utime(5), 600000);
  fs::remove(folder_ / "times.txt");
  EXPECT_EQ(Open()->utime(5), 600000) << "times that are assumed have the gap, too";
  WriteLines("times.txt", 11, [](int i) { return std::to_string(0.1 * i); });
  ExpectNote(*Open(), "gaps in their numbers (5 is missing)");
  WriteLines("times.txt", 10, [](int i) { return std::to_string(0.1 * i); });
  ExpectRefusal({"times.txt: holds 10 times for 11 images", "'000011.png'"});
}

TEST(UserCasesRows, Case42NumbersFromOneAndNumbersThatFitNothing) {
  ImageNames images;
  images.folder = "image_0";
  const auto rows_of = [&](const std::vector<std::uint64_t>& numbers, std::size_t num_rows) {
    images.numbers = numbers;
    images.files.clear();
    images.keys.clear();
    for (const std::uint64_t number : numbers) {
      images.files.push_back(std::to_string(number) + ".png");
      images.keys.push_back(std::to_string(number));
    }
    std::vector<std::string> notes;
    return RowsOfImages("times.txt", "times", num_rows, images, &notes);
  };
  using Rows = std::vector<std::size_t>;
  EXPECT_EQ(rows_of({1, 2, 4, 5}, 5), (Rows{0, 1, 3, 4})) << "from 1";
  EXPECT_EQ(rows_of({1, 2, 4}, 5), (Rows{1, 2, 4})) << "from 0";
  EXPECT_EQ(rows_of({0, 1, 2}, 5), (Rows{0, 1, 2}));
  EXPECT_EQ(rows_of({7, 8, 9}, 3), (Rows{0, 1, 2})) << "as many rows as images";
  EXPECT_THROW(rows_of({7, 8, 9}, 5), InputError);
  EXPECT_THROW(rows_of({0, 1, 2}, 2), InputError);
}

TEST_F(UserCases, CaseR2PosesByRowOfKittiAreOfTheNumbers) {
  WriteSequence(4);
  Write("calib.txt", "80 0 32 0 0 80 18 0 0 0 1 0\n80 0 32 -20 0 80 18 0 0 0 1 0\n");
  WriteLines("poses.txt", 4,
             [](int i) { return "1 0 0 " + std::to_string(i) + " 0 1 0 0 0 0 1 0"; });
  for (const char* name : {"image_0/000000.png", "image_1/000000.png"}) fs::remove(folder_ / name);
  EXPECT_EQ(Open()->ground_truth(0)->translation.x(), 1);
  WriteLines("poses.txt", 2, [](int) { return "1 0 0 0 0 1 0 0 0 0 1 0"; });
  ExpectRefusal({"poses.txt: holds 2 poses for 3 images"});
}

// ---- times

TEST_F(UserCases, Case63OtherUnitsOfTimesAreNamed) {
  WriteSequence(6);
  const auto write = [&](std::int64_t first, std::int64_t step) {
    WriteLines("times.txt", 6, [&](int i) { return std::to_string(first + i * step); });
  };
  write(kEurocNs, 50000000);
  ExpectRefusal({"times.txt: the times are in ns", "expected in s"});
  write(0, 50000000);
  ExpectRefusal({"the times are in ns"});
  write(kEurocNs / 1000000, 50);
  ExpectRefusal({"the times are in ms"});
  write(0, 33);
  ExpectRefusal({"the times are in ms"});
}

TEST_F(UserCases, Case63bMicrosecondsAreNamed) {
  WriteSequence(6);
  WriteLines("times.txt", 6, [](int i) { return std::to_string(kEurocNs / 1000 + i * 50000); });
  ExpectRefusal({"times.txt: the times are in us", "expected in s"});
}

TEST_F(UserCases, Case63TimesThatRepeatAreSaid) {
  WriteSequence(6);
  WriteLines("times.txt", 6, [](int) { return "1403636579"; });
  ExpectRefusal({"times.txt: all 6 times are '1403636579'"});
  WriteLines("times.txt", 6, [](int i) { return std::to_string(1403636579 + i / 3); });
  ExpectRefusal({"times.txt:2: time '1403636579' does not come after the previous one",
                 "4 of 6 repeat: written with too few digits?"});
}

TEST_F(UserCases, Case64LinesOfEurocAndOthersAreNamed) {
  WriteSequence(3);
  Write("times.txt", "#timestamp [ns],filename\n" + std::to_string(kEurocNs) + ",1.png\n");
  ExpectRefusal({"times.txt:2: must hold one time in s", "EuRoC's data.csv"});
  Write("times.txt", "timestamp [ns],filename\n1,1.png\n");
  ExpectRefusal({"times.txt:1: ", "a heading"});
  Write("times.txt", "0.0 rgb/0.0.png\n0.1 rgb/0.1.png\n0.2 rgb/0.2.png\n");
  ExpectRefusal({"times.txt:1: ", "a time and a file name"});
  Write("times.txt", "0 0.0\n1 0.1\n2 0.2\n");
  ExpectRefusal({"times.txt:1: ", "two columns"});
  Write("times.txt", "0,0\n0,1\n0,2\n");
  ExpectRefusal({"times.txt:1: ", "decimal comma"});
}

TEST_F(UserCases, Case64cDatesAreNamed) {
  WriteSequence(3);
  Write("times.txt", "2011-09-26 13:02:25.964389445\n2011-09-26 13:02:26.064\n");
  ExpectRefusal({"times.txt:1: must hold one time in s", "is a date"});
}

TEST_F(UserCases, Case64dByteOrderMarkAndWindowsLines) {
  WriteSequence(3);
  Write("times.txt",
        "\xEF\xBB\xBF"
        "5.0\r\n5.1\r\n5.2\r\n");
  EXPECT_EQ(Open()->utime(0), 5000000);
  EXPECT_EQ(Open()->utime(2), 5200000);
}

TEST_F(UserCases, Case65GroundTruthOfEurocIsNamed) {
  WriteSequence(3);
  Write("gt_pose.txt",
        "#timestamp, p_x\n1403636580838555648,4.6,-1.7,0.8,0.5,-0.1,-0.8,-0.1,0,0\n");
  ExpectRefusal({"gt_pose.txt:2: ", "EuRoC's state_groundtruth (ns, position, q_w first)"});
  Write("gt_pose.txt", "1403636580838555648 4.6 -1.7 0.8 1 0 0 0\n");
  ExpectRefusal({"gt_pose.txt:1: the times are in ns", "q_w first"});
  Write("gt_pose.txt", "1403636580.8 4.6 -1.7 0.8 0 0 0 1\n");
  ExpectNote(*Open(), "gt_pose.txt: 0 of 3 images have a pose: its times, 1403636580.800 ..");
}

TEST_F(UserCases, Case74TimesFromNames) {
  WriteCalibration();
  std::string poses;
  for (int i = 0; i < 4; ++i) {
    const std::int64_t ns = kEurocNs + 50000000 * static_cast<std::int64_t>(i);
    WritePair(std::to_string(ns));
    char time[32];
    std::snprintf(time, sizeof(time), "%lld.%09lld", static_cast<long long>(ns / 1000000000),
                  static_cast<long long>(ns % 1000000000));
    poses += std::string(time) + " 1 2 3 0 0 0 1\n";
  }
  Write("gt_pose.txt", poses);
  const auto sequence = Open();
  EXPECT_EQ(sequence->utime(0), 1403636579763556);
  EXPECT_EQ(sequence->utime(3), 1403636579913556);
  EXPECT_TRUE(sequence->ground_truth(3));
  ExpectNote(*sequence, "times.txt is not there: the times are those in the images' names, in ns");
  ExpectFinding("times.txt", "warning", "those in the images' names");
}

TEST(UserCasesNames, Case74UnitsOfTimesInNames) {
  const auto times_of = [](const std::vector<std::string>& keys) {
    ImageNames names;
    names.keys = keys;
    names.files = keys;
    if (keys[0].find('.') == std::string::npos) {
      for (const std::string& key : keys) names.numbers.push_back(std::stoull(key));
    }
    const std::optional<NamedTimes> times = TimesFromNames(names);
    return times ? times->unit + " " + std::to_string(times->utimes[1] - times->utimes[0]) : "none";
  };
  EXPECT_EQ(times_of({"1403636579763555584", "1403636579813555584"}), "ns 50000");
  EXPECT_EQ(times_of({"1403636579763555", "1403636579813555"}), "us 50000");
  EXPECT_EQ(times_of({"1403636579763", "1403636579813"}), "ms 50000");
  EXPECT_EQ(times_of({"1403636579.763555", "1403636579.813555"}), "s 50000");
  EXPECT_EQ(times_of({"5000000000", "5033000000"}), "ns 33000") << "since the start";
  EXPECT_EQ(times_of({"0", "1"}), "none");
  EXPECT_EQ(times_of({"0", "100"}), "none") << "may be every hundredth image";
  EXPECT_EQ(times_of({"20260101", "20260102"}), "none");
}

// ---- calibration

TEST_F(UserCases, Case66cNegativeBaseline) {
  WriteSequence(2);
  WriteCalibration(32, 18, -0.25);
  ExpectRefusal({"calib.json: ", "the baseline -0.25 m is negative", "Kalibr", "0.25"});
  WriteCalibration(32, 18, -20);
  ExpectRefusal({"negative", "as fx * baseline (bf) in px m it would be 0.25 m"});
}

TEST_F(UserCases, Case66fTheMistakeInTheJsonHasAPlace) {
  WriteSequence(2);
  Write("calib.json", "{\n  \"fx\": 80, // px\n  \"fy\": 80\n}\n");
  ExpectRefusal({"calib.json:2: column 13: JSON has no comments"});
  Write("calib.json", "{\n  \"fx\": 80,\n  \"baseline_m\": 0.25,\n}\n");
  ExpectRefusal({"calib.json:4: column 1: a comma before the closing brace"});
  Write("calib.json", "%YAML:1.0\nfx: 80\n");
  ExpectRefusal({"calib.json:1: column 1: this is YAML"});
  Write("calib.json", "{\"fx\": \"80\", \"fy\": 80}");
  ExpectRefusal({"key 'fx'", "must be a number, without quotes"});
  Write("calib.json", R"({"fx": 80, "fy": 80, "cx": 32, "cy": 18, "baseline": 0.25})");
  ExpectRefusal({"key 'baseline_m' is missing; 'baseline' is there"});
  Write("calib.json", R"({"Fx": 80, "fy": 80, "cx": 32, "cy": 18, "baseline_m": 0.25})");
  ExpectRefusal({"key 'fx' is missing; 'Fx' is there"});
  Write("calib.json",
        "\xEF\xBB\xBF"
        R"({"fx":80,"fy":80,"cx":32,"cy":18,"baseline_m":0.25})");
  EXPECT_EQ(Open()->camera().fx_px, 80);
}

TEST_F(UserCases, Case66iPrincipalPointSwapped) {
  WriteSequence(2);
  WriteCalibration(18, 32);
  ExpectFinding("calib.json", "error", "cx and cy are exchanged");
  WriteCalibration(18, 38);  // 38 is below the image
  ExpectRefusal({"calib.json: ", "cx 18 cy 38"});
}

TEST_F(UserCases, Case66jCalibratedForAnotherResolution) {
  WriteSequence(2);
  WriteCalibration(16, 9);
  ExpectFinding("calib.json", "error", "half as large as these of 64 x 36 px");
  WriteCalibration(64, 36);
  ExpectRefusal({"it belongs to images twice as large"});
  WriteCalibration(48, 27);
  ExpectFinding("calib.json", "error", "1.5 times as large");
  Write("calib.json",
        R"({"fx":80,"fy":80,"cx":16,"cy":9,"baseline_m":0.2,"width":32,"height":18})");
  ExpectRefusal({"key 'width' with value '32': the first image has 64 px", "half as large"});
  Write("calib.json",
        R"({"fx":80,"fy":80,"cx":32,"cy":18,"baseline_m":0.2,"width":36,"height":64})");
  ExpectRefusal({"width and height are exchanged"});
}

TEST(UserCasesCamera, Case66jWhatIsUsualIsNotBlamed) {
  const auto findings_of = [](int width, int height, double fx, double cx, double cy, double b) {
    StereoCamera camera = {width, height, fx, fx, cx, cy, b};
    FindingList findings;
    CheckCamera(camera, "calib", &findings);
    std::string text;
    for (const Finding& finding : findings.findings()) text += finding.what + "\n";
    return text;
  };
  EXPECT_EQ(findings_of(1226, 370, 707.1, 601.9, 183.1, 0.537), "") << "KITTI odometry";
  EXPECT_EQ(findings_of(1242, 375, 721.5, 609.6, 172.9, 0.537), "") << "KITTI raw";
  EXPECT_EQ(findings_of(752, 480, 435.2, 367.4, 252.2, 0.11), "") << "EuRoC";
  EXPECT_EQ(findings_of(640, 360, 772.5, 320, 180, 0.25), "") << "TartanAir-Shibuya";
  EXPECT_NE(findings_of(640, 360, 772.5, 320, 180, 193.1).find("as fx * baseline (bf)"),
            std::string::npos);
  EXPECT_NE(findings_of(640, 360, 772.5, 320, 180, 250).find("in mm"), std::string::npos);
  EXPECT_NE(findings_of(640, 360, 1.2, 0.5, 0.5, 0.25).find("divided by the image's"),
            std::string::npos);
  EXPECT_NE(findings_of(640, 360, 3.04, 320, 180, 0.25).find("in mm, as of a lens"),
            std::string::npos);
  EXPECT_NE(findings_of(640, 360, 772.5, 320, 240, 0.25).find("cropped"), std::string::npos);
}

TEST_F(UserCases, Case67LinesOfOtherKittiFilesAreNamed) {
  WriteSequence(2);
  const std::string left = "80 0 32 0 0 80 18 0 0 0 1 0\n";
  const std::string right = "80 0 32 -20 0 80 18 0 0 0 1 0\n";
  Write("calib.txt",
        "calib_time: 09-Jan-2012 13:57:47\nP_rect_00: " + left + "P_rect_01: " + right);
  ExpectRefusal({"calib.txt: must hold the lines P0: and P1:", "P_rect_00", "sed"});
  Write("calib.txt", "P2: " + left + "P3: " + right);
  ExpectRefusal({"P2 and P3 are there"});
  Write("calib.txt", "P0: 80 0 32 44.9 0 80 18 0.2 0 0 1 0.003\nP1: " + right);
  ExpectNote(*Open(), "calib.txt:1: a camera that lies off the first one");
  Write("calib.txt", "P0: " + right + "P1: " + left);
  ExpectRefusal({"calib.txt:2: ", "negative"});
  Write("calib.txt", "P0: " + left + "P1: " + right);
  EXPECT_TRUE(Open()->notes().empty());
  fs::rename(folder_ / "image_0", folder_ / "image_2");
  fs::rename(folder_ / "image_1", folder_ / "image_3");
  ExpectRefusal({"image_0 and image_1 are not both there", "image_2 and image_3 are"});
}

TEST_F(UserCases, Case77NoCalibrationIsAnError) {
  for (int i = 0; i < 2; ++i) {
    WriteImage("image_0/" + Numbered(i) + ".png", 640, 360);
    WriteImage("image_1/" + Numbered(i) + ".png", 640, 360);
  }
  ExpectRefusal({"calib.json: is not there; write {", "tartanair-shibuya"});
  EXPECT_EQ(Open("", {kPublicCalibration})->camera().baseline_m, 0.25);
  EXPECT_THROW(DatasetSource(folder_.string(), 0, 9, 1, {}), InputError);
  EXPECT_NO_THROW(DatasetSource(folder_.string(), 0, 9, 1, {}, kPublicCalibration));
}

// ---- keypoints

std::string Row(int count, double v = 0.5) {
  std::string row;
  for (int i = 0; i < count; ++i) row += i % 3 == 2 ? "0.9 " : std::to_string(v + i) + " ";
  return row + "\n";
}

person_keypoints_t PlayedKeypoints(const StereoSequence& sequence, std::size_t index) {
  StereoPlayer player(&sequence, 1, {});
  person_keypoints_t message = {};
  for (const Envelope& envelope : player.Load(index).messages) {
    if (envelope.channel == channel::kPersonKeypointsLeft) {
      EXPECT_TRUE(Decode(envelope.payload.data(), envelope.payload.size(), &message));
    }
  }
  return message;
}

TEST_F(UserCases, Case68JsonInTheFoldersOfKeypointsIsNamed) {
  WriteSequence(3);
  for (int i = 0; i < 3; ++i) {
    Write("alphapose_0/" + Numbered(i) + "_keypoints.json", "{\"people\": []}");
  }
  ExpectFinding("alphapose_0", "error", "holds only 3 .json files");
  fs::remove_all(folder_ / "alphapose_0");
  Write("alphapose-results.json", "[]");
  ExpectFinding("alphapose-results.json", "warning", "is not read");
  for (const char* name : {"mask_0", "masks", "seg_0", "rcnnseg_0"}) {
    Write(std::string(name) + "/000000.png", "");
    ExpectFinding(name, "warning", "rename it rcnnseg_image_0");
    fs::remove_all(folder_ / name);
  }
  for (const char* name : {"keypoints_0", "openpose_0", "AlphaPose_0"}) {
    Write(std::string(name) + "/000000.txt", "");
    ExpectFinding(name, "warning", "alphapose_0, those of the right alphapose_1");
    fs::remove_all(folder_ / name);
  }
  Write("image_2/000000.png", "");
  ExpectFinding("image_2", "warning", "the images are image_0 and image_1");
  fs::remove(folder_ / "times.txt");
  Write("timestamps.txt", "");
  ExpectFinding("timestamps.txt", "warning", "times.txt");
}

TEST_F(UserCases, Case69Coco17IsRead) {
  WriteSequence(2);
  Write("alphapose_0/000001.txt", Row(51));
  const auto sequence = Open();
  person_keypoints_t message = PlayedKeypoints(*sequence, 1);
  EXPECT_EQ(message.layout, +person_keypoints_t::LAYOUT_COCO17);
  EXPECT_EQ(message.num_joints, 17);
  ASSERT_EQ(message.num_people, 1);
  EXPECT_EQ(message.u_px[0][16], 48.5F);
  EXPECT_EQ(PlayedKeypoints(*sequence, 0).layout, +person_keypoints_t::LAYOUT_COCO17)
      << "nobody, in the data set's layout";
  ExpectFinding("alphapose_0", "note", "read as COCO-17");
}

TEST_F(UserCases, Case69cHalpe26IsRead) {
  WriteSequence(2);
  Write("alphapose_0/000000.txt", Row(78) + Row(78));
  const person_keypoints_t message = PlayedKeypoints(*Open(), 0);
  EXPECT_EQ(message.layout, +person_keypoints_t::LAYOUT_HALPE26);
  EXPECT_EQ(message.num_joints, 26);
  EXPECT_EQ(message.num_people, 2);
}

TEST_F(UserCases, Case69OneLayoutADataSet) {
  WriteSequence(2);
  Write("alphapose_0/000000.txt", Row(54));
  Write("alphapose_1/000001.txt", Row(51));
  ExpectRefusal(
      {"alphapose_1/000001.txt: holds people in COCO-17", "alphapose_0/000000.txt", "COCO-18"});
  Write("alphapose_1/000001.txt", Row(54) + Row(78));
  const auto sequence = Open();
  EXPECT_THROW(sequence->Load(1), InputError);
}

TEST_F(UserCases, Case69dOtherLayoutsAreNamed) {
  WriteSequence(1);
  const auto refusal_of = [&](const std::string& text) -> std::string {
    Write("alphapose_0/000000.txt", text);
    try {
      Open()->Load(0);
    } catch (const InputError& error) {
      return error.what();
    }
    return "no error";
  };
  for (const auto& [count, name] : {std::make_pair(75, "BODY_25"),
                                    {36, "COCO-18 without confidences"},
                                    {34, "COCO-17 without confidences"},
                                    {408, "Halpe-136"},
                                    {399, "WholeBody"}}) {
    const std::string text = refusal_of(Row(count));
    EXPECT_NE(text.find(name), std::string::npos) << text;
    EXPECT_NE(text.find("000000.txt:1: "), std::string::npos) << text;
    EXPECT_NE(text.find("54 numbers (COCO-18), 51 (COCO-17) and 78 (Halpe-26)"), std::string::npos);
  }
  EXPECT_NE(refusal_of("1,2,0.5,3,4,0.5\n").find("not commas"), std::string::npos);
}

// ---- folders

TEST_F(UserCases, Case72bTheFolderOnAnotherLevelIsNamed) {
  WriteSequence(2);
  const fs::path outer = folder_ / "in";
  fs::create_directories(outer / "Standing02");
  for (const char* name : {"image_0", "image_1", "calib.json", "times.txt"}) {
    fs::rename(folder_ / name, outer / "Standing02" / name);
  }
  EXPECT_NE(Refusal("in").find("the data set is the folder below it, " + Path("in/Standing02")),
            std::string::npos);
  EXPECT_NE(Refusal().find(Path("in/Standing02")), std::string::npos) << "two levels";
  EXPECT_NE(Refusal("in/Standing02/image_0")
                .find("part of the data set " + Path("in/Standing02") + "; use that"),
            std::string::npos);
  fs::copy(outer / "Standing02", outer / "Crossing", fs::copy_options::recursive);
  EXPECT_NE(Refusal("in").find("holds 2 data sets: Crossing, Standing02"), std::string::npos)
      << Refusal("in");
}

TEST_F(UserCases, Case72bOtherLayoutsAreNamed) {
  fs::create_directories(folder_ / "euroc/mav0/cam0/data");
  fs::create_directories(folder_ / "raw/image_00/data");
  fs::create_directories(folder_ / "pair/left");
  fs::create_directories(folder_ / "pair/right");
  fs::create_directories(folder_ / "half/image_0");
  EXPECT_NE(Refusal("euroc").find("EuRoC"), std::string::npos);
  EXPECT_NE(Refusal("raw").find("KITTI raw"), std::string::npos);
  EXPECT_NE(Refusal("pair").find("left and right are the rectified images"), std::string::npos);
  EXPECT_NE(Refusal("half").find("image_1 (right images) is not there"), std::string::npos);
}

// ---- the player

TEST_F(UserCases, Case58TheFileOfAFrameIsNamed) {
  WriteSequence(2);
  Write("image_1/000001.png", "\x89PNG and no more");
  DatasetSource source(folder_.string(), 0, 9, 1, {});
  EXPECT_FALSE(source.NextFrame().empty());
  try {
    source.NextFrame();
    FAIL() << "no error";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find(Path("image_1/000001.png")), std::string::npos)
        << error.what();
  }
}

TEST_F(UserCases, Case74TheSourceSaysWhatWasAssumed) {
  WriteSequence(2);
  fs::remove(folder_ / "times.txt");
  DatasetSource source(folder_.string(), 0, 9, 1, {});
  const std::vector<std::string> notes = source.TakeNotes();
  ASSERT_EQ(notes.size(), 1u);
  EXPECT_NE(notes[0].find("0.1 s apart"), std::string::npos);
  EXPECT_TRUE(source.TakeNotes().empty());
}

}  // namespace
}  // namespace airdos
