// Recordings in folders of any names: what belongs together, and what is left out.
#include "common/dataset/recording/folder_recording.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <opencv2/imgproc.hpp>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/rendered_scene.h"
#include "tests/unit/dataset/recording/recording_fixture.h"

namespace airdos {
namespace {

namespace fs = std::filesystem;

// ---- folders, names and numbers

TEST_F(RecordingTest, TwoFoldersOfAnyWidth) {
  for (const int i : {0, 1, 2, 10, 11}) {
    WriteLeft(Format("l/%010d.png", i), i);
    WriteRight(Format("r/frame%d.png", i), i);
  }
  FolderRecording recording(Numbered());
  EXPECT_EQ(NumbersOf(&recording), (Numbers{0, 1, 2, 10, 11}));
  EXPECT_EQ(recording.image_size(), std::make_pair(kWidth, kHeight));
  EXPECT_EQ(TimesOf(&recording), (Times{0, 50000, 100000, 500000, 550000})) << "gaps stay";
  EXPECT_EQ(recording.names(3).left, Path("l/0000000010.png"));
  EXPECT_EQ(recording.names(3).right, Path("r/frame10.png"));
}

TEST_F(RecordingTest, OneFolderWithBothByTheirNames) {
  const std::pair<const char*, const char*> kinds[] = {
      {"%06d_l.png", "%06d_r.png"},
      {"%04d_left.png", "%04d_right.png"},
      {"left%d.png", "right%d.png"},
      {"frame-left-%04d.png", "frame-right-%04d.png"},
      {"L_%d.png", "R_%d.png"}};
  int k = 0;
  for (const auto& [left, right] : kinds) {
    const std::string folder = "kind" + std::to_string(k++);
    for (int i = 8; i < 12; ++i) {
      char name[100];
      std::snprintf(name, sizeof(name), left, i);  // NOLINT: formats of the table above
      WriteLeft(folder + "/" + name, i);
      std::snprintf(name, sizeof(name), right, i);  // NOLINT
      WriteRight(folder + "/" + name, i);
    }
    FolderRecording recording({Path(folder), "", "", 20.0});
    EXPECT_EQ(NumbersOf(&recording), (Numbers{8, 9, 10, 11})) << left;
  }
}

TEST_F(RecordingTest, OneFolderWithoutSidesIsRefused) {
  WriteLeft("l/000000.png", 0);
  WriteLeft("l/000001.png", 1);
  EXPECT_TRUE(Holds(Refusal({Path("l"), "", "", 20.0}), "which images are left and which right"));
}

TEST_F(RecordingTest, OnePairNeedsNoNumbers) {
  WriteLeft("l/view_of_left.png", 3);
  WriteRight("r/other.png", 3);
  FolderRecording recording(Numbered());
  EXPECT_EQ(NumbersOf(&recording), (Numbers{3}));
}

TEST_F(RecordingTest, KittiRawAndEurocFoldersAreOneFurtherDown) {
  for (int i = 0; i < 3; ++i) {
    WriteLeft(Format("image_00/data/%010d.png", i), i);
    WriteRight(Format("image_01/data/%010d.png", i), i);
  }
  Write("image_00/timestamps.txt",
        "2011-09-26 13:02:25.964389445\n2011-09-26 13:02:26.074389445\n"
        "2011-09-27 00:00:00.000000000\n");
  FolderRecording recording({Path("image_00"), Path("image_01"), "", std::nullopt});
  EXPECT_EQ(NumbersOf(&recording), (Numbers{0, 1, 2}));
  EXPECT_EQ(TimesOf(&recording), (Times{1317042145964389, 1317042146074389, 1317081600000000}));
}

TEST_F(RecordingTest, FoldersBelowAreNamed) {
  WriteNumbered(2);
  EXPECT_TRUE(Holds(Refusal({Path(""), "", "", 20.0}), "folders with images: 'l', 'r'"));
  EXPECT_TRUE(Holds(Refusal({Path("none"), Path("r"), "", 20.0}), "is not there"));
  EXPECT_TRUE(Holds(Refusal({Path("l"), Path("l"), "", 20.0}), "for the left and for the right"));
}

// ---- images that are not as the others

TEST_F(RecordingTest, MissingAndExtraImagesAreLeftOut) {
  WriteNumbered(6);
  fs::remove(Path("l/000002.png"));
  WriteRight("r/000006.png", 6);
  WriteRight("r/overview.png", 6);
  FolderRecording recording(Numbered());
  EXPECT_EQ(NumbersOf(&recording), (Numbers{0, 1, 3, 4, 5}));
  EXPECT_EQ(recording.utime(2), 150000);
  const std::string notes = Notes(&recording);
  EXPECT_TRUE(Holds(notes, "'000002.png', '000006.png' have no left image: skipped")) << notes;
  EXPECT_TRUE(Holds(notes, "'overview.png' is not named like the other images")) << notes;
}

TEST_F(RecordingTest, FoldersOfTwoRecordingsAreRefused) {
  for (int i = 0; i < 4; ++i) {
    WriteLeft(Format("l/%06d.png", i), i);
    WriteRight(Format("r/%06d.png", 100 + i), i);
  }
  EXPECT_TRUE(Holds(Refusal(Numbered()), "not all have a partner"));
}

TEST_F(RecordingTest, TruncatedAndForeignFilesAreLeftOut) {
  WriteNumbered(5);
  fs::resize_file(Path("l/000001.png"), 60);
  Write("r/000003.png", "no picture");
  FolderRecording recording(Numbered());
  EXPECT_EQ(recording.num_pairs(), 3u);
  EXPECT_EQ(NumbersOf(&recording), (Numbers{0, 2, 4}));
  const std::string notes = Notes(&recording);
  EXPECT_TRUE(Holds(notes, "l/000001.png: is cut short")) << notes;
  EXPECT_TRUE(Holds(notes, "so are 1 more that cannot be used")) << notes;
}

TEST_F(RecordingTest, WhatIsDamagedInsideIsSkippedWhenItIsRead) {
  WriteNumbered(3);
  const cv::Mat noise = NoisePicture(kWidth, kHeight, 7);
  scratch_.WritePicture("l/000001.png", noise);
  std::string bytes = TextOf("l/000001.png");
  for (std::size_t i = 60; i < bytes.size() - 40; ++i) bytes[i] = 'x';
  Write("l/000001.png", bytes);
  FolderRecording recording(Numbered());
  ASSERT_EQ(recording.num_pairs(), 3u);
  EXPECT_TRUE(recording.Load(0));
  Notes(&recording);
  EXPECT_FALSE(recording.Load(1));
  const std::string notes = Notes(&recording);
  EXPECT_TRUE(Holds(notes, "l/000001.png") && Holds(notes, "skipped")) << notes;
  EXPECT_TRUE(recording.Load(2));
}

TEST_F(RecordingTest, ImagesOfAnotherSizeAreLeftOut) {
  WriteNumbered(5);
  scratch_.WritePicture("r/000002.png", Plain(2, false, 2 * kWidth));
  FolderRecording recording(Numbered());
  EXPECT_EQ(NumbersOf(&recording), (Numbers{0, 1, 3, 4}));
  const std::string notes = Notes(&recording);
  EXPECT_TRUE(Holds(notes, "r/000002.png' is not of the size of the others, 64x48 px")) << notes;
  for (int i = 0; i < 5; ++i) {
    scratch_.WritePicture(Format("r/%06d.png", i), Plain(i, false, 2 * kWidth));
  }
  EXPECT_TRUE(Holds(Refusal(Numbered()), "the right images have 128x48 px, the left ones 64x48"));
}

TEST_F(RecordingTest, SixteenBitImagesAreScaledByOneRange) {
  for (int i = 0; i < 3; ++i) {
    const auto write = [&](const std::string& name, bool is_left) {
      cv::Mat deep;
      Plain(i + 20, is_left).convertTo(deep, CV_16UC1, 16);
      scratch_.WritePicture(name, deep);
    };
    write(Format("l/%06d.png", i), true);
    write(Format("r/%06d.png", i), false);
  }
  FolderRecording recording(Numbered());
  EXPECT_EQ(NumbersOf(&recording), (Numbers{20, 21, 22}));
  const std::string notes = Notes(&recording);
  EXPECT_TRUE(Holds(notes, "12 significant bits: divided by 16")) << notes;
}

TEST_F(RecordingTest, OneImageOfSixteenBitsAmongOthersIsUsed) {
  WriteNumbered(4);
  cv::Mat deep;
  Plain(2, false).convertTo(deep, CV_16UC1, 256);
  deep.at<std::uint16_t>(0, 0) = 65535;  // a sensor that uses all bits
  scratch_.WritePicture("r/000002.png", deep);
  FolderRecording recording(Numbered());
  EXPECT_EQ(NumbersOf(&recording), (Numbers{0, 1, 2, 3}));
  const std::string notes = Notes(&recording);
  EXPECT_TRUE(Holds(notes, "r/000002.png' is of 16 bits, the others of 8: grey values may differ"))
      << notes;
  EXPECT_EQ(std::count(notes.begin(), notes.end(), '\n'), 1) << notes;
}

TEST_F(RecordingTest, ColourAndGreyMixedAreUsedInGrey) {
  WriteNumbered(4);
  cv::Mat colour;
  cv::cvtColor(Plain(2, false), colour, cv::COLOR_GRAY2BGR);
  scratch_.WritePicture("r/000002.png", colour);
  FolderRecording recording(Numbered());
  const std::string notes = Notes(&recording);
  EXPECT_TRUE(Holds(notes, "r/000002.png' is in colour, the others grey")) << notes;
  const auto pair = recording.Load(2);
  ASSERT_TRUE(pair);
  EXPECT_EQ(pair->left.type(), CV_8UC1);
  EXPECT_EQ(pair->right.type(), CV_8UC1);
  EXPECT_EQ(NumbersOf(&recording), (Numbers{0, 1, 2, 3}));
}

}  // namespace
}  // namespace airdos
