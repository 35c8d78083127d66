// Where the times of recorded images come from.
#include "common/dataset/recording/recording_times.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <utility>

#include "tests/unit/dataset/recording/recording_fixture.h"

namespace airdos {
namespace {

namespace fs = std::filesystem;

TEST_F(RecordingTest, TimesInNamesOfEachUnit) {
  const std::pair<std::string, std::string> kinds[] = {
      {"1403636579763555584", "1403636579813555584"},
      {"1403636579763556", "1403636579813556"},
      {"1403636579763", "1403636579813"},
      {"1403636579.763555", "1403636579.813555"}};
  int k = 0;
  for (const auto& [first, second] : kinds) {
    const std::string folder = "t" + std::to_string(k++);
    WriteLeft(folder + "/l/" + first + ".png", 0);
    WriteRight(folder + "/r/" + first + ".png", 0);
    WriteLeft(folder + "/l/" + second + ".png", 1);
    WriteRight(folder + "/r/" + second + ".png", 1);
    FolderRecording recording({Path(folder + "/l"), Path(folder + "/r"), "", std::nullopt});
    EXPECT_EQ(NumbersOf(&recording), (Numbers{0, 1}));
    EXPECT_NEAR(static_cast<double>(recording.utime(0)), 1403636579763556, 600) << first;
    EXPECT_EQ(recording.utime(1) - recording.utime(0), 50000) << first;
  }
}

TEST_F(RecordingTest, TimesOfEachCameraArePairedByTime) {
  for (int i = 0; i < 6; ++i) {
    if (i != 2) WriteLeft(Format("l/%ld.png", 1403636579000000000 + 50000000L * i), i);
    if (i != 4) WriteRight(Format("r/%ld.png", 1403636579003000000 + 50000000L * i), i);
  }
  FolderRecording recording({Path("l"), Path("r"), "", std::nullopt});
  EXPECT_EQ(NumbersOf(&recording), (Numbers{0, 1, 3, 5}));
  const std::string notes = Notes(&recording);
  EXPECT_TRUE(Holds(notes, "differ by up to 3 ms")) << notes;
  EXPECT_TRUE(Holds(notes, "no left image: skipped")) << notes;
}

TEST_F(RecordingTest, TimesOfAFileByNameAndByRow) {
  WriteNumbered(3);
  const auto times_of = [&](const std::string& text) {
    FolderRecording recording({Path("l"), Path("r"), Write("times.csv", text), std::nullopt});
    return TimesOf(&recording);
  };
  const Times expected = {1403636579763556, 1403636579813556, 1403636579863556};
  EXPECT_EQ(times_of("#timestamp [ns],filename\n1403636579763555584,000000.png\n"
                     "1403636579813555584,000001.png\r\n1403636579863555584,000002.png\n"),
            expected);
  EXPECT_EQ(times_of("timestamp;file\n1403636579763556; l/000000.png\n1403636579813556;"
                     "l/000001.png\n1403636579863556;l/000002.png\n"),
            expected);
  EXPECT_EQ(times_of("1403636579.763556\n1403636579.813556\n1403636579.863556\n"), expected);
  EXPECT_EQ(times_of("1.403636579763555584e+18\n1.403636579813555584E18\n"
                     "1.403636579863555584e18\n"),
            expected)
      << "as NumPy writes";
  EXPECT_EQ(times_of("0.1\n0.2\n0.3\n"), (Times{100000, 200000, 300000}));
  EXPECT_EQ(times_of("100\n200\n300\n"), (Times{100000, 200000, 300000})) << "ms";
}

TEST_F(RecordingTest, ImagesThatAFileOfTimesDoesNotNameAreLeftOut) {
  WriteNumbered(3);
  const std::string csv = Write("times.csv", "0.1 000000.png\n0.25 000002.png\n0.3 000007.png\n");
  FolderRecording recording({Path("l"), Path("r"), csv, std::nullopt});
  EXPECT_EQ(NumbersOf(&recording), (Numbers{0, 2}));
  EXPECT_EQ(TimesOf(&recording), (Times{100000, 250000}));
  const std::string notes = Notes(&recording);
  EXPECT_TRUE(Holds(notes, "times.csv: holds no time of '000001.png': skipped")) << notes;
}

TEST_F(RecordingTest, WhereSomeRowsHaveNoNameRowsCount) {
  WriteNumbered(3);
  const std::string csv = Write("times.csv", "0.1 000000.png\n0.25\n0.3 000002.png\n");
  FolderRecording recording({Path("l"), Path("r"), csv, std::nullopt});
  EXPECT_EQ(NumbersOf(&recording), (Numbers{0, 1, 2}));
  EXPECT_EQ(TimesOf(&recording), (Times{100000, 250000, 300000}));
}

TEST_F(RecordingTest, AFileOfTimesThatIsNoneIsRefused) {
  WriteNumbered(3);
  const auto refusal = [&](const std::string& text) {
    return Refusal({Path("l"), Path("r"), Write("times.txt", text), std::nullopt});
  };
  EXPECT_TRUE(Holds(refusal("0.1\n0.1\n0.2\n"), "times.txt:2: time '0.1' does not come after"));
  EXPECT_TRUE(Holds(refusal("0.1\nhello\n0.2\n"), "times.txt:2: must hold a time"));
  EXPECT_TRUE(Holds(refusal("0.1 2 3\n"), "times.txt:1: must hold a time"));
  EXPECT_TRUE(Holds(refusal(""), "holds no time"));
  EXPECT_TRUE(Holds(refusal("0.1\n0.2\n"), "holds 2 times for 3 images"));
  EXPECT_TRUE(Holds(Refusal({Path("l"), Path("r"), Path("none.txt"), std::nullopt}), "none.txt"));
}

TEST_F(RecordingTest, DatesThatAreNoneAreRefused) {
  for (const std::string date :
       {"2011-13-26 13:02:25.9", "2011-00-26 13:02:25.9", "2011-09-32 13:02:25.9",
        "2011-09-31 13:02:25.9", "2011-02-29 13:02:25.9", "2011-12-32 13:02:25.9",
        "2011-09-00 13:02:25.9", "2011-09-26 24:02:25.9", "2011-09-26 13:60:25.9",
        "2011-09-26 13:02:61.0", "2011-09-26 13:02:-1.0", "2011-09-26 13:02:", "2011-09-26 13.2"}) {
    EXPECT_TRUE(Holds(ErrorOf([&] { ReadRecordingTimes(Write("t.txt", date + "\n")); }),
                      "t.txt:1: '" + date + "' is not a date and time of day"))
        << date;
  }
  EXPECT_EQ(
      ReadRecordingTimes(Write("t.txt", "2012/02/29 00:00:00.0\n2012/03/01 00:00:00\n")).utimes,
      (Times{1330473600000000, 1330560000000000}));
}

TEST_F(RecordingTest, NumbersThatAreTimesAtTheBeginningOnlyAreNone) {
  for (const char* name : {"1403636579", "1403636580", "1403636581", "9000000000000000000"}) {
    WriteLeft(std::string("l/") + name + ".png", 0);
    WriteRight(std::string("r/") + name + ".png", 0);
  }
  EXPECT_TRUE(Holds(Refusal({Path("l"), Path("r"), "", std::nullopt}), "--rate HZ"));
}

TEST_F(RecordingTest, RowsStayWithTheirImagesWhereOneIsMissing) {
  WriteNumbered(5);
  fs::remove(Path("l/000001.png"));
  FolderRecording recording(
      {Path("l"), Path("r"), Write("times.txt", "0.0\n0.1\n0.2\n0.35\n0.4\n"), std::nullopt});
  EXPECT_EQ(NumbersOf(&recording), (Numbers{0, 2, 3, 4}));
  EXPECT_EQ(TimesOf(&recording), (Times{0, 200000, 350000, 400000}));
}

TEST_F(RecordingTest, RowsBelongToTheNumbersOfBothCameras) {
  for (int i = 1; i <= 5; ++i) {  // numbers from 1; with the left ones alone they may be from 0
    if (i != 5) WriteLeft(Format("l/%d.png", i), i);
    if (i != 2) WriteRight(Format("r/%d.png", i), i);
  }
  FolderRecording recording(
      {Path("l"), Path("r"), Write("times.txt", "0.0\n0.1\n0.2\n0.35\n0.4\n"), std::nullopt});
  EXPECT_EQ(NumbersOf(&recording), (Numbers{1, 3, 4}));
  EXPECT_EQ(TimesOf(&recording), (Times{0, 200000, 350000}));
}

TEST_F(RecordingTest, WithoutTimesARateIsNeeded) {
  WriteNumbered(3);
  EXPECT_TRUE(Holds(Refusal({Path("l"), Path("r"), "", std::nullopt}), "--rate HZ"));
  EXPECT_TRUE(Holds(Refusal({Path("l"), Path("r"), "", 0.0}), "not positive"));
}

}  // namespace
}  // namespace airdos
