#include "common/check/check_folder.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <opencv2/imgproc.hpp>
#include <sstream>

#include "common/check/check_times.h"
#include "common/util/error.h"
#include "common/util/json_file.h"
#include "tests/support/small_sequence.h"

namespace airdos {
namespace {

namespace fs = std::filesystem;

/// A copy of its own for each test: copies of cv::Mat share their pixels.
SmallSequence Sound() {
  static const SmallSequence rendered = SmallSequence::Make();
  SmallSequence sequence = rendered;
  for (auto* pictures : {&sequence.left, &sequence.right, &sequence.masks}) {
    for (cv::Mat& picture : *pictures) picture = picture.clone();
  }
  return sequence;
}

class CheckFolderTest : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("airdos_check_" + std::to_string(getpid()));
  }
  void TearDown() override { fs::remove_all(folder_); }

  /// What is found in the folder as it stands.
  std::string Check(std::size_t odometry_frames = 0) {
    CheckOptions options;
    options.max_frames = 5;
    options.odometry_frames = odometry_frames;
    findings_ = FindingList();
    CheckFolder(folder_.string(), options, &findings_);
    std::ostringstream text;
    findings_.Print(folder_.string(), &text);
    return text.str();
  }
  /// There is a finding of this kind and severity that names `place`, and no error of another kind.
  void ExpectOnly(Severity severity, const std::string& kind, const std::string& place,
                  std::size_t odometry_frames = 0) {
    const std::string text = Check(odometry_frames);
    const auto& all = findings_.findings();
    EXPECT_TRUE(std::any_of(all.begin(), all.end(),
                            [&](const Finding& finding) {
                              return finding.severity == severity && finding.kind == kind &&
                                     finding.where.find(place) != std::string::npos;
                            }))
        << kind << "\n"
        << text;
    for (const Finding& finding : all) {
      EXPECT_TRUE(finding.severity != Severity::kError || finding.kind == kind) << text;
    }
    EXPECT_EQ(findings_.has_errors(), severity == Severity::kError) << text;
  }

  fs::path folder_;
  SmallSequence sequence_ = Sound();
  FindingList findings_;
};

TEST_F(CheckFolderTest, ASoundSequenceHasNothingButNotes) {
  sequence_.Write(folder_);
  const std::string text = Check(SmallSequence::kNumFrames);
  EXPECT_EQ(findings_.count(Severity::kError), 0) << text;
  EXPECT_EQ(findings_.count(Severity::kWarning), 0) << text;
  EXPECT_NE(text.find("100 % of the keypoints lie in them"), std::string::npos) << text;
  EXPECT_NE(text.find("NED, and visual odometry agrees"), std::string::npos) << text;
  EXPECT_NE(text.find("10 images per second"), std::string::npos) << text;
}

TEST_F(CheckFolderTest, WhatIsNoSequenceIsABadArgument) {
  fs::create_directories(folder_);
  EXPECT_THROW(Check(), InputError);
  fs::remove_all(folder_);
  EXPECT_THROW(Check(), InputError);
}

TEST_F(CheckFolderTest, MissingAndUnreadableFilesAreNamed) {
  sequence_.Write(folder_);
  fs::remove(folder_ / "image_1" / "000003.png");
  ExpectOnly(Severity::kError, "folder", "image_1");
  sequence_.Write(folder_);
  std::ofstream(folder_ / "image_1" / "000000.png") << "\x89PNG and no more";
  ExpectOnly(Severity::kError, "images.file", "image_1/000000.png");
  sequence_.Write(folder_);
  std::ofstream(folder_ / "alphapose_1" / "000004.txt") << "1 2 0.5 3 4 0.5\n";
  ExpectOnly(Severity::kError, "keypoints.file", "alphapose_1/000004.txt:1");
  sequence_.Write(folder_);
  fs::remove(folder_ / "rcnnseg_image_0" / "000002.png");
  ExpectOnly(Severity::kWarning, "masks.count", "rcnnseg_image_0/000002.png");
  fs::remove(folder_ / "alphapose_0" / "000007.txt");
  ExpectOnly(Severity::kWarning, "keypoints.count", "alphapose_0/000007.txt");
  sequence_.Write(folder_);
  fs::rename(folder_ / "alphapose_0" / "000007.txt", folder_ / "alphapose_0" / "7.txt");
  std::ofstream(folder_ / "alphapose_0" / "000007.txt") << "";
  ExpectOnly(Severity::kWarning, "keypoints.count", "alphapose_0");
  sequence_.T_W_C.pop_back();
  sequence_.Write(folder_);
  ExpectOnly(Severity::kWarning, "ground_truth.count", "gt_pose.txt");
}

TEST_F(CheckFolderTest, WhatTheReaderHadToAssume) {
  sequence_.times_s.push_back("1.4");  // one more than images
  sequence_.Write(folder_);
  ExpectOnly(Severity::kWarning, "folder.assumed", "times.txt");
  fs::remove(folder_ / "times.txt");
  ExpectOnly(Severity::kWarning, "folder.assumed", "times.txt");
}

TEST_F(CheckFolderTest, ImagesOfAnotherSize) {
  cv::resize(sequence_.right[0], sequence_.right[0], {160, 96});
  sequence_.Write(folder_);
  ExpectOnly(Severity::kError, "images.size", "image_1/000000.png");
  sequence_ = Sound();
  cv::resize(sequence_.masks[0], sequence_.masks[0], {160, 96});
  sequence_.Write(folder_);
  ExpectOnly(Severity::kError, "masks.size", "rcnnseg_image_0/000000.png");
}

TEST_F(CheckFolderTest, LeftAndRightExchangedOrTheSame) {
  std::swap(sequence_.left, sequence_.right);
  sequence_.Write(folder_);
  ExpectOnly(Severity::kError, "images.swapped", folder_.string());
  for (std::size_t i = 0; i < sequence_.left.size(); i += 2) {
    std::swap(sequence_.left[i], sequence_.right[i]);
  }
  sequence_.Write(folder_);
  ExpectOnly(Severity::kWarning, "images.order", folder_.string());
  sequence_.left = sequence_.right;
  sequence_.Write(folder_);
  ExpectOnly(Severity::kError, "images.identical", folder_.string());
}

TEST_F(CheckFolderTest, ImagesThatAreNotRectified) {
  for (cv::Mat& image : sequence_.right) {
    const cv::Mat moved = (cv::Mat_<double>(2, 3) << 1, 0, 0, 0, 1, 3);
    cv::warpAffine(image, image, moved, image.size(), cv::INTER_LINEAR, cv::BORDER_REPLICATE);
  }
  sequence_.Write(folder_);
  ExpectOnly(Severity::kError, "images.rectification", folder_.string());
}

TEST_F(CheckFolderTest, ImagesWithNothingToSee) {
  for (cv::Mat& image : sequence_.left) image.setTo(90);
  for (cv::Mat& image : sequence_.right) image.setTo(91);
  sequence_.Write(folder_);
  ExpectOnly(Severity::kWarning, "images.features", folder_.string());
}

TEST_F(CheckFolderTest, StrongCompression) {
  sequence_.image_ending = ".jpg";
  sequence_.jpeg_quality = 40;
  sequence_.Write(folder_);
  ExpectOnly(Severity::kWarning, "images.jpeg_quality", "image_0");
  EXPECT_NE(Check().find("JPEG quality 40 (median)"), std::string::npos) << Check();
}

TEST_F(CheckFolderTest, UnitsOfTheCamera) {
  StereoCamera said = sequence_.camera;
  said.baseline_m = 250;  // mm
  sequence_.SetCalibration(said);
  sequence_.Write(folder_);
  EXPECT_NE(Check().find("in mm instead of m it would be 0.25 m"), std::string::npos) << Check();
  EXPECT_TRUE(findings_.has_errors());
  said = sequence_.camera;
  said.fx_px = said.fy_px = 0.008;  // m, as a lens' data sheet has it
  sequence_.SetCalibration(said);
  sequence_.Write(folder_);
  EXPECT_NE(Check().find("[camera.focal_length]"), std::string::npos) << Check();
  EXPECT_NE(Check().find("[camera.depth]"), std::string::npos) << Check();
  said = sequence_.camera;
  said.cx_px = 10;
  sequence_.SetCalibration(said);
  sequence_.Write(folder_);
  ExpectOnly(Severity::kWarning, "camera.principal_point", "calib.json");
}

TEST_F(CheckFolderTest, UnitsOrderAndGapsOfTimes) {
  for (const double factor : {1e3, 1e6, 1e9}) {
    for (std::size_t i = 0; i < sequence_.times_s.size(); ++i) {
      sequence_.times_s[i] = std::to_string(0.1 * static_cast<double>(i) * factor);
    }
    sequence_.T_W_C.clear();  // whose times would not fit
    sequence_.Write(folder_);
    ExpectOnly(Severity::kError, "folder", "times.txt");  // the reader refuses it
  }
  for (std::size_t i = 0; i < sequence_.times_s.size(); ++i) {
    sequence_.times_s[i] = std::to_string(3 * i);
  }
  sequence_.Write(folder_);
  ExpectOnly(Severity::kWarning, "times.rate", "times.txt");
  sequence_ = Sound();
  sequence_.times_s.back() = "1.7";
  sequence_.T_W_C.pop_back();
  sequence_.Write(folder_);
  ExpectOnly(Severity::kWarning, "times.gap", "times.txt");
  sequence_ = Sound();
  sequence_.times_s[4] = sequence_.times_s[3];
  sequence_.Write(folder_);
  ExpectOnly(Severity::kError, "folder", "times.txt:5");
}

TEST(CheckTimesTest, UnitByTheInterval) {
  for (const auto& [unit, period_us] :
       {std::make_pair("ms", 100000000LL), {"us", 100000000000LL}, {"ns", 100000000000000LL}}) {
    FindingList findings;
    CheckTimes({0, period_us, 2 * period_us}, "LOG", &findings);
    ASSERT_EQ(findings.findings().size(), 1u);
    EXPECT_NE(findings.findings()[0].what.find(std::string("in ") + unit), std::string::npos);
  }
}

TEST(CheckTimesTest, AllTheSameAreSaidOnce) {
  FindingList findings;
  CheckTimes({5, 5, 5, 5}, "LOG", &findings);
  ASSERT_EQ(findings.count(Severity::kError), 1);
  EXPECT_EQ(findings.findings()[0].what, "all 4 images have one time, 5 us");
}

TEST(CheckTimesTest, RepeatedAndDecreasing) {
  FindingList findings;
  CheckTimes({0, 100000, 100000, 200000, 150000, 300000}, "LOG", &findings);
  EXPECT_EQ(findings.count(Severity::kError), 2);
  EXPECT_EQ(findings.findings()[0].kind, "times.order");
}

TEST_F(CheckFolderTest, InvertedMasks) {
  for (cv::Mat& mask : sequence_.masks) mask = 255 - mask;
  sequence_.Write(folder_);
  ExpectOnly(Severity::kError, "masks.polarity", folder_.string());
  for (auto* people : {&sequence_.people_left, &sequence_.people_right}) {
    for (auto& rows : *people) rows.clear();
  }
  sequence_.Write(folder_);
  ExpectOnly(Severity::kError, "masks.coverage", folder_.string());
}

TEST_F(CheckFolderTest, MasksThatDoNotFitTheKeypoints) {
  for (cv::Mat& mask : sequence_.masks) mask.setTo(0);
  sequence_.Write(folder_);
  ExpectOnly(Severity::kError, "masks.empty", folder_.string());
  for (cv::Mat& mask : sequence_.masks) cv::circle(mask, {160, 20}, 20, 255, cv::FILLED);
  sequence_.Write(folder_);
  ExpectOnly(Severity::kWarning, "masks.keypoints", folder_.string());
  std::ofstream(folder_ / "rcnnseg_image_0" / "000000.png") << "no mask at all";
  ExpectOnly(Severity::kError, "masks.file", "rcnnseg_image_0/000000.png");
}

/// Changes every keypoint of both images.
void ForEachPoint(SmallSequence* sequence,
                  const std::function<void(std::array<double, 3>*)>& change) {
  for (auto* people : {&sequence->people_left, &sequence->people_right}) {
    for (auto& rows : *people) {
      for (auto& row : rows) {
        for (auto& point : row) change(&point);
      }
    }
  }
}

TEST_F(CheckFolderTest, KeypointsInCoco17Order) {
  // What Coco17 calls 0..16 stands at these places of COCO-18; a zero fills the row.
  constexpr std::array<int, 17> kPlace = {0, 15, 14, 17, 16, 5, 2,  6, 3,
                                          7, 4,  11, 8,  12, 9, 13, 10};
  for (auto* people : {&sequence_.people_left, &sequence_.people_right}) {
    for (auto& rows : *people) {
      for (auto& row : rows) {
        SmallSequence::Row coco17;
        for (const int place : kPlace) coco17.push_back(row[static_cast<std::size_t>(place)]);
        coco17.push_back({0, 0, 0});
        row = coco17;
      }
    }
  }
  sequence_.Write(folder_);
  ExpectOnly(Severity::kError, "keypoints.layout", "alphapose_0");
}

TEST_F(CheckFolderTest, KeypointsInAnotherOrder) {
  for (auto* people : {&sequence_.people_left, &sequence_.people_right}) {
    for (auto& rows : *people) {
      for (auto& row : rows) std::swap(row[1], row[8]);  // a hip for the neck
    }
  }
  sequence_.Write(folder_);
  ExpectOnly(Severity::kError, "keypoints.layout", "alphapose_1");
}

TEST_F(CheckFolderTest, PeopleUpsideDownOrUnseen) {
  ForEachPoint(&sequence_, [](auto* point) { (*point)[1] = 191 - (*point)[1]; });
  sequence_.Write(folder_);
  ExpectOnly(Severity::kWarning, "keypoints.layout", "alphapose_0");
  sequence_ = Sound();
  ForEachPoint(&sequence_, [](auto* point) { (*point)[2] = 0; });
  sequence_.Write(folder_);
  ExpectOnly(Severity::kWarning, "keypoints.confidence", "alphapose_0");
}

TEST_F(CheckFolderTest, KeypointsInOtherUnits) {
  ForEachPoint(&sequence_, [](auto* point) { (*point)[2] *= 100; });
  sequence_.Write(folder_);
  ExpectOnly(Severity::kError, "keypoints.confidence", "alphapose_0/000000.txt");
  sequence_ = Sound();
  ForEachPoint(&sequence_, [](auto* point) {
    (*point)[0] /= 320;
    (*point)[1] /= 192;
  });
  sequence_.Write(folder_);
  ExpectOnly(Severity::kError, "keypoints.normalised", "alphapose_0");
  sequence_ = Sound();
  ForEachPoint(&sequence_, [](auto* point) {
    (*point)[0] *= 3;
    (*point)[1] *= 3;
  });
  sequence_.Write(folder_);
  ExpectOnly(Severity::kError, "keypoints.scale", "alphapose_0");
  sequence_ = Sound();
  sequence_.people_left[5][0][4] = {900, 50, 0.9};
  sequence_.Write(folder_);
  ExpectOnly(Severity::kNote, "keypoints.outside", "alphapose_0/000005.txt");
  for (auto& rows : sequence_.people_left) rows[0][4] = {900, 50, 0.9};
  sequence_.Write(folder_);
  ExpectOnly(Severity::kWarning, "keypoints.outside", "alphapose_0/000000.txt");
}

TEST_F(CheckFolderTest, GroundTruthInOtherAxes) {
  // As if the file held optical axes turned by a half: x backward.
  sequence_.Write(folder_, [](Eigen::Vector3d* p, Eigen::Matrix3d* R) {
    const Eigen::Matrix3d turn = Eigen::Vector3d(-1, -1, 1).asDiagonal();
    *p = turn * *p;
    *R = turn * *R * turn;
  });
  ExpectOnly(Severity::kWarning, "ground_truth.axes", "gt_pose.txt", SmallSequence::kNumFrames);
}

TEST_F(CheckFolderTest, LeftHandedGroundTruth) {
  sequence_.Write(folder_, [](Eigen::Vector3d* p, Eigen::Matrix3d* R) {
    const Eigen::Matrix3d mirror = Eigen::Vector3d(1, -1, 1).asDiagonal();
    *p = mirror * *p;
    *R = mirror * *R * mirror;
  });
  ExpectOnly(Severity::kError, "ground_truth.handedness", "gt_pose.txt", SmallSequence::kNumFrames);
}

TEST_F(CheckFolderTest, GroundTruthInMillimetres) {
  sequence_.Write(folder_, [](Eigen::Vector3d* p, Eigen::Matrix3d*) { *p *= 1000; });
  ExpectOnly(Severity::kError, "ground_truth.scale", "gt_pose.txt", SmallSequence::kNumFrames);
}

TEST(FindingListTest, ManyOfAKindAreCounted) {
  FindingList findings;
  for (int i = 0; i < 10; ++i) findings.Warn("a", "f" + std::to_string(i), "x");
  findings.FailFrom("b", "file:3: is bad: very");
  std::ostringstream text;
  findings.Print("IN", &text);
  EXPECT_EQ(text.str(),
            "f0: warning: x [a]\nf1: warning: x [a]\nf2: warning: x [a]\n"
            "file:3: error: is bad: very [b]\nIN: note: 7 more like the last [a]\n"
            "IN: 1 errors, 10 warnings\n");
}

// Found by fuzzing: what a finding quotes may be any bytes.
TEST(FindingListTest, BytesOfAFileDoNoHarm) {
  FindingList findings;
  findings.Fail("a", "f", "is '\x82\x1b[2J'");
  std::ostringstream text;
  findings.Print("IN", &text);
  EXPECT_EQ(text.str(), "f: error: is '\x82?[2J' [a]\nIN: 1 errors, 0 warnings\n");
  EXPECT_NE(JsonText(findings.ToJson("IN")).find("is '\xEF\xBF\xBD?[2J'"), std::string::npos);
}

TEST(SampleEvenlyTest, HasFirstAndLast) {
  EXPECT_EQ(SampleEvenly(10, 4), (std::vector<std::size_t>{0, 3, 6, 9}));
  EXPECT_EQ(SampleEvenly(3, 20), (std::vector<std::size_t>{0, 1, 2}));
  EXPECT_TRUE(SampleEvenly(0, 5).empty());
}

}  // namespace
}  // namespace airdos
