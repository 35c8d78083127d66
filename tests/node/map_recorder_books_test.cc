// What the recorder keeps book of: times, sessions and their folders, what a full disk or another
// program left of a map.
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "common/util/error.h"
#include "processes/map_recorder/map_recorder_node.h"

namespace airdos {
namespace {

namespace fs = std::filesystem;

class MapRecorderBooksTest : public ::testing::Test {
 protected:
  MapRecorderBooksTest() {
    const auto* info = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = testing::TempDir() + "airdos_recorder_books_" + std::to_string(getpid()) + "_" +
              info->name();
    fs::remove_all(folder_);
  }
  ~MapRecorderBooksTest() override { fs::remove_all(folder_); }

  MapRecorderOptions Options(const std::string& name = "a", int chunk_frames = 2) const {
    MapRecorderOptions options;
    options.directory = folder_ + "/" + name;
    options.chunk_frames = chunk_frames;
    options.export_at_end = false;
    return options;
  }
  template <class Message>
  static void Send(const char* channel, const Message& message, Node* node) {
    const std::vector<std::uint8_t> bytes = Encode(message);
    node->Receive(channel, bytes.data(), bytes.size());
    while (node->Step()) {
    }
  }
  static void SendFrame(std::int64_t seq, std::int64_t session, std::int64_t utime, Node* node) {
    state_estimate_t state = {};
    state.seq = seq;
    state.session = session;
    state.utime = utime;
    state.status = state_estimate_t::STATUS_CONVERGED;
    state.trusted = state_estimate_t::TRUSTED_WITHOUT_PEOPLE;
    state.position_W_C[0] = 0.5 * static_cast<double>(seq);
    for (double* orientation : {state.orientation_W_C, state.orientation_with_people_W_C,
                                state.orientation_without_people_W_C})
      orientation[0] = 1;
    Send(channel::kStateEstimate, state, node);
    map_update_t update = {};
    update.seq = seq;
    update.session = session;
    update.utime = utime;
    update.num_parts = 1;
    Send(channel::kMapUpdate, update, node);
  }
  /// 100 ms apart.
  static void SendFrames(std::int64_t first, std::int64_t last, std::int64_t session, Node* node) {
    for (std::int64_t seq = first; seq <= last; ++seq) SendFrame(seq, session, 100000 * seq, node);
  }
  static void CompleteAll(Node* node) {
    while (node->CompleteOldest()) {
    }
  }
  std::string Path(const std::string& name) const { return folder_ + "/" + name; }
  FourDMap Read(const std::string& name) const {
    MapFileSummary summary;
    return ReadFourDMap(Path(name), &summary);
  }
  /// A recorder in folder "a" that is killed after it got these sessions' frames 0 to `last`.
  void RunAndKill(const std::vector<std::int64_t>& sessions, std::int64_t last) const {
    {
      MapRecorderNode killed(Options());
      for (const std::int64_t session : sessions) SendFrames(0, last, session, &killed);
      fs::copy(Path("a"), Path("left"), fs::copy_options::recursive);
      for (const auto& entry : fs::recursive_directory_iterator(Path("left"))) {
        if (!entry.is_regular_file()) continue;
        const fs::path original = fs::path(Path("a")) / fs::relative(entry, Path("left"));
        fs::last_write_time(entry, fs::last_write_time(original));  // as the folder's list has it
      }
    }
    fs::remove_all(Path("a"));
    fs::rename(Path("left"), Path("a"));
  }

  std::string folder_;
};

TEST_F(MapRecorderBooksTest, TimesThatDoNotGoOnAreSaidOnceASession) {
  MapRecorderNode node(Options());
  const auto said = [&node] {
    std::string text;
    for (const std::string& line : node.TakeWarnings()) text += line + "\n";
    return text;
  };
  SendFrame(0, 1, 7000, &node);
  SendFrame(1, 1, 7001, &node);
  EXPECT_EQ(said(), "");
  SendFrame(2, 1, 7001, &node);
  EXPECT_EQ(said(),
            "times go back: image 2 is not later than image 1 (utime 7001 and 7001); the map "
            "contains such poses, the trajectory files omit them\n");
  SendFrame(3, 1, 5, &node);
  EXPECT_EQ(said(), "");
  SendFrame(0, 2, 3000, &node);
  EXPECT_EQ(said(), "") << "the next session has a clock of its own";
  SendFrame(1, 2, 2000, &node);
  EXPECT_EQ(said().substr(0, 70),
            "times go back: image 1 is not later than image 0 (utime 2000 and 3000)");
  CompleteAll(&node);
  EXPECT_NO_THROW(node.Finish());
}

TEST_F(MapRecorderBooksTest, EachSessionIsCountedByItself) {
  MapRecorderNode node(Options());
  SendFrames(0, 4, 1, &node);
  SendFrames(0, 2, 2, &node);
  CompleteAll(&node);
  EXPECT_NO_THROW(node.Finish()) << "as many live poses as were recorded, in each";
  EXPECT_EQ(Read("a/map.airdos").frames.size(), 5u);
  EXPECT_EQ(Read("a/session_2/map.airdos").frames.size(), 3u);
  EXPECT_EQ(Read("a/session_2/map.airdos").frames.at({2}).live->translation.x(), 1);
}

TEST_F(MapRecorderBooksTest, BehindASessionThatIsGoneOnWithTheNextGetsTheNextFolder) {
  RunAndKill({1, 2}, 5);
  MapRecorderNode node(Options());
  SendFrames(6, 7, 2, &node);
  SendFrames(0, 3, 3, &node);
  CompleteAll(&node);
  EXPECT_NO_THROW(node.Finish());
  EXPECT_EQ(Read("a/map.airdos").session, 1);
  EXPECT_EQ(Read("a/session_2/map.airdos").session, 2);
  EXPECT_EQ(Read("a/session_2/map.airdos").frames.size(), 8u);
  EXPECT_EQ(Read("a/session_3/map.airdos").session, 3);
}

TEST_F(MapRecorderBooksTest, MapsThatWereCutAreAllKept) {
  for (int run = 1; run <= 3; ++run) {
    RunAndKill({run}, 1 + 2 * run);  // 4, 6, 8 frames
    MapRecorderNode node(Options());
    SendFrames(0, 0, 9, &node);
    CompleteAll(&node);
    node.Finish();
  }
  EXPECT_EQ(Read("a/map.airdos.unfinished_1").frames.size(), 4u);
  EXPECT_EQ(Read("a/map.airdos.unfinished_2").frames.size(), 6u);
  EXPECT_EQ(Read("a/map.airdos.unfinished_3").frames.size(), 8u);
}

// The one in work is the oldest of all.
TEST_F(MapRecorderBooksTest, ManySessionsAheadDoNotCostTheCalibrationOfTheOneInWork) {
  MapRecorderNode node(Options());
  stereo_calibration_t message = {};
  for (std::int64_t session = 1; session <= 150; ++session) {
    message.session = session;
    FromStereoCamera({640, 360, 500.0 + static_cast<double>(session), 501, 320, 180, 0.25},
                     &message);
    Send(channel::kCalibration, message, &node);
    if (session == 1) SendFrames(0, 1, 1, &node);
  }
  node.Finish();
  ASSERT_TRUE(Read("a/map.airdos").camera);
  EXPECT_EQ(Read("a/map.airdos").camera->fx_px, 501);
}

// The disk is full when the fourth chunk comes: the three before survive, and it is said once.
TEST_F(MapRecorderBooksTest, AFullDiskKeepsTheFirstChunks) {
  std::signal(SIGXFSZ, SIG_IGN);  // then write() fails as on a full disk
  rlimit before = {};
  getrlimit(RLIMIT_FSIZE, &before);
  MapRecorderNode node(Options());
  SendFrames(0, 5, 1, &node);
  const std::uintmax_t size = fs::file_size(Path("a/map.airdos"));
  const rlimit limit{static_cast<rlim_t>(size) + 20, before.rlim_max};
  setrlimit(RLIMIT_FSIZE, &limit);
  int num_said = 0;
  for (std::int64_t seq = 6; seq < 20; ++seq) {
    try {
      SendFrames(seq, seq, 1, &node);
    } catch (const InputError& error) {
      ++num_said;
      EXPECT_EQ(seq, 7);
      EXPECT_EQ(error.what(), Path("a/map.airdos") + ": cannot be written: File too large");
    }
  }
  setrlimit(RLIMIT_FSIZE, &before);
  EXPECT_EQ(num_said, 1);
  try {
    node.Finish();
    ADD_FAILURE() << "it is not complete";
  } catch (const InputError& error) {
    EXPECT_EQ(error.what(), "the recording is not complete: " + Path("a/map.airdos") +
                                ": cannot be written: File too large");
  }
  EXPECT_EQ(fs::file_size(Path("a/map.airdos")), size);
  const FourDMap map = Read("a/map.airdos");
  ASSERT_EQ(map.frames.size(), 6u);
  for (std::int64_t seq = 0; seq < 6; ++seq) {
    EXPECT_EQ(map.frames.at({seq}).live->translation.x(), 0.5 * static_cast<double>(seq));
    EXPECT_EQ(map.frames.at({seq}).utime, 100000 * seq);
  }
}

TEST_F(MapRecorderBooksTest, GroundTruthThatIsInTheMapMakesRoomForMore) {
  MapRecorderOptions options = Options();
  options.max_ground_truth = 2;
  MapRecorderNode node(options);
  const auto is_taken = [&node](std::int64_t seq, std::int64_t session) {
    const std::int64_t num_before = node.channels().at(channel::kGroundTruth).num_rejected;
    pose_t pose = {};
    pose.seq = seq;
    pose.session = session;
    pose.utime = 100000 * seq;
    pose.orientation[0] = 1;
    pose.axes = pose_t::AXES_OPTICAL;
    Send(channel::kGroundTruth, pose, &node);
    return node.channels().at(channel::kGroundTruth).num_rejected == num_before;
  };
  EXPECT_TRUE(is_taken(0, 1));
  EXPECT_TRUE(is_taken(1, 1));
  EXPECT_FALSE(is_taken(2, 1));
  SendFrame(MapRecorderNode::kGroundTruthLag + 1, 1, 1, &node);  // that of image 0 is written
  EXPECT_TRUE(is_taken(2, 1));
  EXPECT_FALSE(is_taken(3, 1));
  SendFrame(0, 2, 0, &node);  // another session: what is left of the first one is written
  SendFrame(1, 2, 1, &node);
  CompleteAll(&node);
  EXPECT_TRUE(is_taken(0, 2));
  EXPECT_TRUE(is_taken(1, 2));
  EXPECT_FALSE(is_taken(2, 2));
}

// Another program writes a whole chunk where the map will end: each chunk is good, the map is not.
TEST_F(MapRecorderBooksTest, WhatWasAddedBehindTheEndIsNoticed) {
  {
    MapRecorderNode same(Options("same"));
    SendFrames(0, 3, 1, &same);
    same.Finish();
  }
  const auto end = static_cast<std::streamoff>(fs::file_size(Path("same/map.airdos")));
  {
    MapFileWriter other(Path("other"));
    other.Append(MapDelta().ToChunk());
  }
  std::ifstream file(Path("other"), std::ios::binary);
  const std::string chunk = std::string(std::istreambuf_iterator<char>(file), {}).substr(12);

  MapRecorderNode node(Options());
  SendFrames(0, 3, 1, &node);
  std::fstream map(Path("a/map.airdos"), std::ios::in | std::ios::out | std::ios::binary);
  map.seekp(end);
  map << chunk;
  map.close();
  try {
    node.Finish();
    ADD_FAILURE();
  } catch (const InputError& error) {
    EXPECT_EQ(error.what(), Path("a/map.airdos") + ": " +
                                std::to_string(static_cast<std::size_t>(end) + chunk.size()) +
                                " bytes of it can be read, " + std::to_string(end) +
                                " were written; did something else write into it? Record again");
  }
}

}  // namespace
}  // namespace airdos
