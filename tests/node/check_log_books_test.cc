// What a check says of a log, finding by finding: counts, first places and sizes by value.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <opencv2/imgcodecs.hpp>
#include <string>
#include <utility>
#include <vector>

#include "airdos/image_t.hpp"
#include "airdos/pose_t.hpp"
#include "airdos/stereo_calibration_t.hpp"
#include "processes/node/check/check_log.h"
#include "processes/node/check/check_log_survey.h"
#include "processes/node/check/check_log_times.h"
#include "processes/node/log/event_log.h"
#include "processes/node/log/log_source.h"
#include "processes/node/message/channels.h"
#include "processes/node/message/codec.h"
#include "processes/node/message/conversions.h"
#include "processes/stereo_player/dataset_source.h"
#include "tests/support/small_sequence.h"

namespace airdos {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t kSession = 4;

/// "error CAMERA_LEFT 3: TEXT", a line each, of the findings of one kind; paths are left out.
std::string Said(const FindingList& findings, const std::string& kind, const std::string& path) {
  std::string text;
  for (const Finding& finding : findings.findings()) {
    if (finding.kind != kind) continue;
    std::string where = finding.where.substr(std::min(finding.where.size(), path.size()));
    if (where.substr(0, 2) == ": ") where = where.substr(2) + ": ";
    text += std::string(NameOf(finding.severity)) + " " + where + finding.what + "\n";
  }
  return text;
}

class LogSurveyTest : public testing::Test {
 protected:
  LogSurveyTest()
      : path_(testing::TempDir() + "airdos_check_books_" + std::to_string(getpid())), log_(path_) {}
  ~LogSurveyTest() override { fs::remove(path_); }

  template <class Message>
  void Add(const char* channel, const Message& message) {
    const std::vector<std::uint8_t> bytes = Encode(message);
    log_.Append(0, channel, bytes.data(), bytes.size());
  }
  /// Gray pixels; the capture times are 100 ms apart.
  static image_t Image(std::int64_t seq, std::int64_t session, int width = 16, int height = 12) {
    image_t message = {};
    message.seq = seq;
    message.session = session;
    message.utime = 1000000 * session + 100000 * seq;
    message.encoding = image_t::ENCODING_RAW_GRAY8;
    message.width = width;
    message.height = height;
    message.num_bytes = width * height;
    message.data.assign(static_cast<std::size_t>(width * height), 90);
    return message;
  }
  void AddImages(const char* channel, const std::vector<std::int64_t>& seqs,
                 std::int64_t session = kSession) {
    for (const std::int64_t seq : seqs) Add(channel, Image(seq, session));
  }
  void AddCalibration(std::int64_t seq, double fx_px = 20) {
    stereo_calibration_t message = {};
    message.seq = seq;
    message.session = kSession;
    FromStereoCamera({16, 12, fx_px, 21, 8, 6, 0.2}, &message);
    Add(channel::kCalibration, message);
  }
  std::string Report(const std::string& kind) {
    FindingList findings;
    LogSurvey(path_).Report(&findings);
    return Said(findings, kind, path_);
  }

  std::string path_;
  EventLogWriter log_;
};

TEST_F(LogSurveyTest, GapsAreCountedByNumbersAndByPlaces) {
  AddImages(channel::kCameraLeft, {0, 1, 3});
  AddImages(channel::kCameraRight, {0, 1, 4, 5, 9});
  EXPECT_EQ(Report("log.gap"),
            "warning CAMERA_LEFT 3: 1 numbers are missing before it\n"
            "warning CAMERA_RIGHT 4: 2 numbers are missing before it; in all 5 in 2 places\n");
}

TEST_F(LogSurveyTest, WhatGoesBackIsToldFromASessionThatStartsAgain) {
  AddImages(channel::kCameraLeft, {5, 6, 7}, 1);
  AddImages(channel::kCameraLeft, {8, 9, 10, 8}, 2);
  AddImages(channel::kCameraRight, {3, 5, 4, 7, 6}, 1);
  EXPECT_EQ(Report("log.order"),
            "error CAMERA_LEFT 8: comes after number 10: its session starts again, but a session "
            "is processed only once; whatever is played or started again must take a new session "
            "(airdos-stereo-player --session)\n"
            "error CAMERA_RIGHT 4: comes after number 5; so 2 of 5 messages\n");
}

TEST_F(LogSurveyTest, RepetitionsAreCountedFromTheFirstOn) {
  AddImages(channel::kCameraLeft, {0, 1, 1, 2, 3, 3, 3});
  AddImages(channel::kCameraRight, {0, 1, 2, 2});
  EXPECT_EQ(Report("log.repeated"),
            "warning CAMERA_LEFT 1: comes twice; so 3 of 7 messages\n"
            "warning CAMERA_RIGHT 2: comes twice\n");
}

TEST_F(LogSurveyTest, EachSessionHasItsImages) {
  AddImages(channel::kCameraLeft, {7, 5, 6}, 4);
  AddImages(channel::kCameraLeft, {0, 1}, 3);
  const std::string text =
      "2 sessions, each a separate run: 4 with 3 images (5 to 7), 3 with 2 "
      "images (0 to 1)";
  EXPECT_EQ(Report("log.sessions"), "warning " + text + "; pictures of the first are checked\n");
  for (const std::int64_t session : {9, 8, 7, 6})
    AddImages(channel::kCameraLeft, {session}, session);
  EXPECT_EQ(Report("log.sessions"),
            "warning 6 sessions, each a separate run: 4 with 3 images (5 to 7), 3 with 2 images "
            "(0 to 1), 9 with 1 images (9 to 9), 8 with 1 images (8 to 8), 7 with 1 images (7 to "
            "7), …; pictures of the first are checked\n");
}

TEST_F(LogSurveyTest, TheFramesAreThoseOfTheFirstSessionEachOnce) {
  AddImages(channel::kCameraLeft, {7, 5, 5, 6}, 4);
  AddImages(channel::kCameraLeft, {7, 8}, 3);
  for (const auto& [seq, session] : std::vector<std::pair<int, int>>{{5, 4}, {7, 3}, {4, 5}}) {
    pose_t truth = {};
    truth.seq = seq;
    truth.session = session;
    truth.axes = pose_t::AXES_NED;
    truth.position[0] = 10 * session + seq;
    truth.orientation[0] = 1;
    Add(channel::kGroundTruth, truth);
  }
  const LogSurvey survey(path_);
  EXPECT_EQ(survey.frames(), (std::vector<LogSurvey::FrameKey>{{4, 7}, {4, 5}, {4, 6}}));
  EXPECT_EQ(survey.utimes(), (std::vector<std::int64_t>{4700000, 4500000, 4600000}));
  ASSERT_EQ(survey.ground_truth().size(), 3u);
  EXPECT_FALSE(survey.ground_truth()[0]);
  ASSERT_TRUE(survey.ground_truth()[1]);
  EXPECT_EQ(survey.ground_truth()[1]->translation.x(), 45);
  EXPECT_FALSE(survey.ground_truth()[2]);
  EXPECT_EQ(survey.ground_truth_axes(), TrajectoryAxes::kNed);
}

TEST_F(LogSurveyTest, CalibrationsThatComeLateOrChangeAreCounted) {
  AddImages(channel::kCameraLeft, {0, 1, 2});
  AddCalibration(2);
  AddImages(channel::kCameraLeft, {3});
  AddCalibration(3);
  EXPECT_EQ(Report("log.calibration"), "warning 3 images come before the first CALIBRATION\n");
  AddCalibration(4, 20.5);
  AddCalibration(5);
  AddCalibration(6, 20.5);
  EXPECT_EQ(
      Report("log.calibration"),
      "warning 3 images come before the first CALIBRATION\n"
      "warning CALIBRATION 4: differs from the first one; only the first of a session applies; "
      "so 2 of 5 messages\n");
}

// Ground truth is nothing that a log must have.
TEST_F(LogSurveyTest, ChannelsWithoutAMessageAreNamed) {
  AddCalibration(0);
  AddImages(channel::kCameraLeft, {0, 1, 2});
  AddImages(channel::kCameraRight, {0, 1, 2});
  FindingList findings;
  LogSurvey(path_).Report(&findings);
  EXPECT_EQ(findings.count(Severity::kWarning), 3);
  EXPECT_EQ(Said(findings, "log.count", path_),
            "warning PERSON_KEYPOINTS_LEFT: no message, for 3 of CAMERA_LEFT\n"
            "warning PERSON_KEYPOINTS_RIGHT: no message, for 3 of CAMERA_LEFT\n"
            "warning PERSON_MASK: no message, for 3 of CAMERA_LEFT\n");
}

TEST_F(LogSurveyTest, TheLargestMessageIsNamed) {
  AddCalibration(0);
  Add(channel::kCameraLeft, Image(0, kSession, 400, 350));  // 136.7 kB of pixels
  Add(channel::kCameraLeft, Image(1, kSession, 400, 340));  // 132.8
  Add(channel::kCameraLeft, Image(2, kSession, 400, 300));  // 117.2
  EXPECT_EQ(Report("log.size"),
            "warning CAMERA_LEFT: 2 messages are larger than 128 kB (up to 136 kB): receivers with "
            "default buffers lose them\n");
}

TEST_F(LogSurveyTest, WithoutACalibrationTheFirstImageHasTheRightSize) {
  Add(channel::kCameraLeft, Image(0, kSession, 16, 12));
  Add(channel::kCameraLeft, Image(1, kSession, 12, 16));
  Add(channel::kCameraLeft, Image(2, kSession, 16, 12));
  Add(channel::kCameraLeft, Image(3, kSession, 12, 16));
  EXPECT_EQ(Report("images.size"),
            "error CAMERA_LEFT 1: is of 12 x 16 px, the first one is of 16 x 12 px: width and "
            "height are exchanged; so 2 of 4 messages\n");
}

TEST_F(LogSurveyTest, ASizeOfTheSameShapeIsAnotherResolution) {
  AddCalibration(0);
  Add(channel::kCameraLeft, Image(0, kSession, 32, 24));
  Add(channel::kCameraLeft, Image(1, kSession, 32, 23));
  EXPECT_EQ(Report("images.size"),
            "error CAMERA_LEFT 1: is of 32 x 23 px, CALIBRATION is for 16 x 12 px; so 1 of 2 "
            "messages\n"
            "error CAMERA_LEFT 0: is of 32 x 24 px, CALIBRATION is for 16 x 12 px: another "
            "resolution; publish the calibration of the images as they are; so 1 of 2 messages\n");
}

// A hostile log has a new size in each message: ten are told apart, and go on being counted.
TEST_F(LogSurveyTest, TenSizesAreToldApart) {
  AddCalibration(0);
  for (int k = 0; k < 12; ++k) Add(channel::kCameraLeft, Image(k, kSession, 20 + k, 12));
  Add(channel::kCameraLeft, Image(12, kSession, 20, 12));
  FindingList findings;
  LogSurvey(path_).Report(&findings);
  EXPECT_EQ(Said(findings, "images.size", path_),
            "error CAMERA_LEFT 0: is of 20 x 12 px, CALIBRATION is for 16 x 12 px; so 2 of 13 "
            "messages\n"
            "error CAMERA_LEFT 1: is of 21 x 12 px, CALIBRATION is for 16 x 12 px; so 1 of 13 "
            "messages\n"
            "error CAMERA_LEFT 2: is of 22 x 12 px, CALIBRATION is for 16 x 12 px; so 1 of 13 "
            "messages\n");
  EXPECT_EQ(findings.count(Severity::kError), 10 + 1) << "the sizes, and no right image";
}

TEST_F(LogSurveyTest, TheFirstFileThatContradictsItsMessageIsNamed) {
  AddCalibration(0);
  AddImages(channel::kCameraLeft, {0});
  for (const int width : {20, 30}) {
    image_t message = Image(width / 10, kSession);
    message.encoding = image_t::ENCODING_PNG;
    cv::imencode(".png", cv::Mat(10, width, CV_8UC1, cv::Scalar(90)), message.data);
    message.num_bytes = static_cast<std::int32_t>(message.data.size());
    Add(channel::kCameraLeft, message);
  }
  EXPECT_EQ(Report("images.file"),
            "error CAMERA_LEFT 2: the message says 16 x 12 px, the file in it has 20 x 10 px; so "
            "2 of 3 messages\n");
}

// ---- Times ----

std::string TimesSaid(const std::vector<std::int64_t>& utimes) {
  FindingList findings;
  CheckLogTimes(utimes, "W", &findings);
  std::string text;
  for (const Finding& finding : findings.findings())
    text += finding.kind + ": " + finding.what + "\n";
  return text;
}

TEST(CheckLogTimesTest, ClocksThatStandStillOrGoBackAreSaidWithTheirPlace) {
  EXPECT_EQ(
      TimesSaid({0, 100000, 200000, 200000, 300000}),
      "times.order: 1 of 5 images have the same capture time as the previous one; the first is "
      "at place 4 in the log's order\n");
  EXPECT_EQ(
      TimesSaid({0, 100000, 50000, 150000, 250000, 240000}),
      "times.order: 2 of 6 images have an earlier capture time than the previous one; the first "
      "is at place 3 in the log's order\n");
  EXPECT_EQ(TimesSaid({7}), "");
}

TEST(CheckLogTimesTest, TheUnitIsTheOneThatMakesACamera) {
  const auto times = [](std::int64_t step) {
    std::vector<std::int64_t> utimes;
    for (std::int64_t k = 0; k < 8; ++k) utimes.push_back(1000 + step * k);
    return utimes;
  };
  EXPECT_EQ(TimesSaid(times(100000)).find("times.unit"), std::string::npos);
  EXPECT_EQ(TimesSaid(times(1900000)).find("times.unit"), std::string::npos) << "a slow one";
  const std::pair<std::int64_t, std::string> units[] = {{100000000, "ns"}, {33, "ms"}, {1, "s"}};
  for (const auto& [step, unit] : units) {
    EXPECT_EQ(
        TimesSaid(times(step)).find("times.unit: utime is in us, but these are " + unit + ":"), 0u)
        << unit << " " << TimesSaid(times(step));
  }
  // Ten images a second, stamped with whole seconds.
  std::vector<std::int64_t> seconds;
  for (std::int64_t k = 0; k < 40; ++k) seconds.push_back(1700000000 + k / 10);
  EXPECT_EQ(TimesSaid(seconds).find("times.unit: utime is in us, but these are s:"), 0u)
      << TimesSaid(seconds);
}

// ---- The pictures ----

class CheckLogBooksTest : public testing::Test {
 protected:
  CheckLogBooksTest()
      : folder_(testing::TempDir() + "airdos_check_pictures_" + std::to_string(getpid())) {
    SmallSequence::Make().Write(folder_ + "/data");
    DatasetSource source(folder_ + "/data", 0, 1000, 5, {}, "");
    for (auto frame = source.NextFrame(); !frame.empty(); frame = source.NextFrame())
      messages_.insert(messages_.end(), frame.begin(), frame.end());
  }
  ~CheckLogBooksTest() override { fs::remove_all(folder_); }
  /// "[KIND] WHAT", a line each, of errors and warnings.
  std::string Check() const {
    const std::string path = folder_ + "/in.lcm";
    {
      EventLogWriter log(path);
      for (const Envelope& m : messages_)
        log.Append(0, m.channel, m.payload.data(), m.payload.size());
    }
    CheckOptions options;
    options.max_frames = 14;
    options.odometry_frames = 0;
    FindingList findings;
    CheckLog(path, options, &findings);
    std::string text;
    for (const Finding& finding : findings.findings()) {
      if (finding.severity != Severity::kNote)
        text += "[" + finding.kind + "] " + finding.what + "\n";
    }
    return text;
  }
  std::string folder_;
  std::vector<Envelope> messages_;
};

// The second session's pictures have the numbers of the first one's, and are those of a camera
// whose images were exchanged: nobody looks at them.
TEST_F(CheckLogBooksTest, PicturesAreThoseOfTheFirstSession) {
  const std::vector<Envelope> first = messages_;
  for (Envelope message : first) {
    Header header = *PeekHeader(message.payload.data(), message.payload.size());
    header.session = 6;
    header.utime += 60000000;
    WriteHeader(header, message.payload.data(), message.payload.size());
    if (message.channel == channel::kCameraLeft) {
      message.channel = channel::kCameraRight;
    } else if (message.channel == channel::kCameraRight) {
      message.channel = channel::kCameraLeft;
    }
    messages_.push_back(message);
  }
  EXPECT_EQ(Check(),
            "[log.sessions] 2 sessions, each a separate run: 5 with 14 images (0 to 13), 6 with "
            "14 images (0 to 13); pictures of the first are checked\n");
}

// Said once, by whoever looks at sizes; what contradicts itself is not looked into.
TEST_F(CheckLogBooksTest, AMessageThatContradictsItsFileIsNamedOnce) {
  for (Envelope& envelope : messages_) {
    if (envelope.channel != channel::kCameraRight) continue;
    image_t message;
    ASSERT_TRUE(Decode(envelope.payload.data(), envelope.payload.size(), &message));
    message.width += 8;
    envelope.payload = Encode(message);
  }
  EXPECT_EQ(Check(),
            "[images.file] the message says 328 x 192 px, the file in it has 320 x 192 px; so 14 "
            "of 14 messages\n");
}

}  // namespace
}  // namespace airdos
