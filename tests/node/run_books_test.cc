// What is said before and after a run: errors and warnings of a quick check, and where the poses
// came from.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string>
#include <vector>

#include "common/dataset/stereo_sequence.h"
#include "common/util/error.h"
#include "processes/node/check/input_check.h"
#include "processes/node/log/event_log.h"
#include "processes/node/message/channels.h"
#include "processes/node/message/codec.h"
#include "processes/node/run_tally.h"
#include "processes/stereo_player/dataset_source.h"
#include "tests/support/small_sequence.h"

namespace airdos {
namespace {

namespace fs = std::filesystem;

class CheckBeforeRunTest : public testing::Test {
 protected:
  CheckBeforeRunTest() : folder_(testing::TempDir() + "airdos_run_" + std::to_string(getpid())) {
    fs::create_directories(folder_);
    SmallSequence::Make().Write(Data());
  }
  ~CheckBeforeRunTest() override { fs::remove_all(folder_); }
  std::string Data() const { return folder_ + "/data"; }
  std::string Log() const { return folder_ + "/in.lcm"; }

  /// What the player makes of the data, without what comes on `left_out`.
  void WriteLog(const std::vector<std::string>& left_out = {}) const {
    DatasetSource source(Data(), 0, 1000, 5, {}, "");
    EventLogWriter log(Log());
    for (auto frame = source.NextFrame(); !frame.empty(); frame = source.NextFrame()) {
      for (const Envelope& m : frame) {
        if (std::find(left_out.begin(), left_out.end(), m.channel) != left_out.end()) continue;
        log.Append(0, m.channel, m.payload.data(), m.payload.size());
      }
    }
  }
  /// Warnings, a line each, or "THROWN: " and the error.
  static std::string Check(const std::string& path, const std::string& calibration = "") {
    std::string said;
    try {
      CheckBeforeRun(path, calibration, [&](const std::string& line) { said += line + "\n"; });
    } catch (const InputError& error) {
      return "THROWN: " + std::string(error.what());
    }
    return said;
  }
  std::string folder_;
};

TEST_F(CheckBeforeRunTest, ASoundInputIsNotSpokenOf) {
  WriteLog();
  EXPECT_EQ(Check(Log()), "");
  EXPECT_EQ(Check(Data()), "");
}

TEST_F(CheckBeforeRunTest, AWarningNamesItsPlaceAndTheRunGoesOn) {
  WriteLog({channel::kPersonMask});
  EXPECT_EQ(Check(Log()),
            "warning: " + Log() + ": PERSON_MASK: no message, for 14 of CAMERA_LEFT\n");
}

TEST_F(CheckBeforeRunTest, TheFirstErrorIsSaidAndHowManyMoreThereAre) {
  WriteLog({channel::kCalibration});
  const std::string end = "; 'airdos-check " + Log() + "' says more; --no-check continues anyway";
  EXPECT_EQ(Check(Log()), "THROWN: " + Log() +
                              ": no usable CALIBRATION: nothing can be measured; publish it once a "
                              "second" +
                              end);
  WriteLog({channel::kCalibration, channel::kCameraRight});
  const std::string two = Check(Log());
  EXPECT_EQ(two.find("THROWN: " + Log() + ": CAMERA_RIGHT: no message, for 14 of CAMERA_LEFT; "),
            0u)
      << two;
  EXPECT_NE(two.find(" (and 1 more errors)" + end), std::string::npos) << two;
}

// Of a log that a power cut ended every event that is whole is played.
TEST_F(CheckBeforeRunTest, DamageIsAWarning) {
  WriteLog();
  fs::resize_file(Log(), fs::file_size(Log()) - 10);
  const std::string said = Check(Log());
  EXPECT_EQ(said.find("warning: " + Log() + ": "), 0u) << said;
  EXPECT_NE(said.find("bytes are damaged, about 1 events lost\n"), std::string::npos) << said;
}

// The source says itself what it takes for granted.
TEST_F(CheckBeforeRunTest, WhatIsTakenForGrantedIsNotSaidTwice) {
  fs::remove(Data() + "/times.txt");
  EXPECT_EQ(Check(Data()), "");
}

TEST_F(CheckBeforeRunTest, TheCalibrationThatIsAskedForIsUsed) {
  fs::remove(Data() + "/calib.json");
  const std::string without = Check(Data());
  EXPECT_EQ(without.find("THROWN: "), 0u) << without;
  EXPECT_NE(without.find("calib.json: is not there"), std::string::npos) << without;
  // It is there, and of another size.
  const std::string with = Check(Data(), kPublicCalibration);
  EXPECT_NE(with.find("with 320 x 192 px is not that of the public data set (640 x 360)"),
            std::string::npos)
      << with;
}

// ---- Where the poses came from ----

class RunTallyBooksTest : public testing::Test {
 protected:
  void Features(std::int64_t seq, int num_features, std::int64_t session = 5) {
    static_features_t message = {};
    message.seq = seq;
    message.session = session;
    message.num_features = num_features;
    tally_.Take(message);
  }
  static state_estimate_t Estimate(std::int64_t seq, int num_static = 0, std::int64_t session = 5) {
    state_estimate_t message = {};
    message.seq = seq;
    message.session = session;
    message.status = state_estimate_t::STATUS_CONVERGED;
    message.trusted = state_estimate_t::TRUSTED_WITHOUT_PEOPLE;
    message.num_static_observations = num_static;
    return message;
  }
  RunTally tally_;
};

TEST_F(RunTallyBooksTest, FeaturesAreThoseOfTheSameFrameAndSession) {
  Features(3, 7);
  tally_.Take(Estimate(3, 0, 6));
  EXPECT_EQ(tally_.Count().num_predicted, 1);
  tally_.Take(Estimate(3));
  EXPECT_EQ(tally_.Count().num_from_images, 1);
  tally_.Take(Estimate(4, 9));
  EXPECT_EQ(tally_.Count().num_from_images, 2) << "a log may have no features";
  Features(5, 8);
  EXPECT_EQ(tally_.Count().num_static_features, 15);
}

// A thousand frames wait for their estimates; beyond that the oldest is forgotten, and it alone.
TEST_F(RunTallyBooksTest, AThousandFramesWait) {
  for (std::int64_t seq = 0; seq <= 1000; ++seq) Features(seq, 1);
  tally_.Take(Estimate(0));
  EXPECT_EQ(tally_.Count().num_predicted, 1);
  for (std::int64_t seq = 1; seq <= 1000; ++seq) tally_.Take(Estimate(seq));
  EXPECT_EQ(tally_.Count().num_from_images, 1000);
}

TEST_F(RunTallyBooksTest, APoseHasAPlaceAndADirection) {
  for (int i = 0; i < 4; ++i) {
    state_estimate_t estimate = Estimate(i, 9);
    estimate.orientation_W_C[i] = std::numeric_limits<double>::infinity();
    tally_.Take(estimate);
  }
  for (int i = 0; i < 3; ++i) {
    state_estimate_t estimate = Estimate(4 + i, 9);
    estimate.position_W_C[i] = std::numeric_limits<double>::quiet_NaN();
    tally_.Take(estimate);
  }
  EXPECT_EQ(tally_.Count().num_without_pose, 7);
  EXPECT_EQ(WhyInVain(tally_.Count()).find("none of 7 frames has a pose"), 0u);
}

TEST_F(RunTallyBooksTest, ARunIsInVainOnlyWithoutAnyLandmark) {
  RunTally::Counts counts;
  counts.num_frames = counts.num_predicted = 4;
  EXPECT_EQ(WhyInVain(counts).find("no static landmark was seen in 4 frames"), 0u);
  counts.num_static_features = 1;
  EXPECT_EQ(WhyInVain(counts), "") << "seen, if hardly";
  counts.num_static_features = 0;
  counts.num_predicted = 3;
  counts.num_from_images = 1;
  EXPECT_EQ(WhyInVain(counts), "") << "a log may have no features";
}

}  // namespace
}  // namespace airdos
