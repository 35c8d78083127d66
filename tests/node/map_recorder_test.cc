#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "common/util/error.h"
#include "processes/map_recorder/map_recorder_node.h"
#include "processes/node/log/log_source.h"
#include "processes/node/message/header.h"

namespace airdos {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t kSession = 42;

template <class Message>
Message Make(std::int64_t seq, std::int64_t session = kSession) {
  return MessageOf<Message>({1000000 + 100000 * seq, seq, session});
}

void SetIdentity(double orientation[4]) {
  orientation[0] = 1;
  orientation[1] = orientation[2] = orientation[3] = 0;
}

Envelope State(std::int64_t seq, std::int64_t session = kSession) {
  auto message = Make<state_estimate_t>(seq, session);
  message.status = state_estimate_t::STATUS_CONVERGED;
  message.trusted = state_estimate_t::TRUSTED_WITHOUT_PEOPLE;
  message.position_W_C[0] = static_cast<double>(seq);
  SetIdentity(message.orientation_W_C);
  SetIdentity(message.orientation_without_people_W_C);
  SetIdentity(message.orientation_with_people_W_C);
  return {channel::kStateEstimate, Encode(message)};
}

/// Moves the frame before by 0.25 m, has landmark `seq` and moves landmark 0, removes landmark
/// `seq` - 5, and sees person 3.
Envelope Update(std::int64_t seq, int part = 0, int num_parts = 1,
                std::int64_t session = kSession) {
  auto message = Make<map_update_t>(seq, session);
  message.part = part;
  message.num_parts = num_parts;
  if (seq > 0) {
    frame_pose_t pose = {};
    pose.seq = seq - 1;
    pose.utime = message.utime - 100000;
    pose.position_W_C[0] = static_cast<double>(seq) - 0.75 + part;
    SetIdentity(pose.orientation_W_C);
    message.frames.push_back(pose);
  }
  message.num_frames = static_cast<std::int32_t>(message.frames.size());
  message.landmark_id = {0, seq};
  message.x_W_m = {static_cast<double>(seq), 10.0 + static_cast<double>(seq)};
  message.y_W_m = {0, 1};
  message.z_W_m = {5, 6};
  message.sigma_m = {0.1f, 0.2f};
  message.num_observations = {static_cast<int>(seq) + 1, 1};
  message.num_landmarks = 2;
  if (seq >= 5) message.removed_landmark_id = {seq - 4};
  message.num_removed = static_cast<std::int32_t>(message.removed_landmark_id.size());
  human_state_t human = {};
  human.track_id = 3;
  human.seq = seq;
  human.utime = message.utime;
  human.joint_id = {1, 8, 11};
  human.x_W_m = {0, 0.1f, -0.1f};
  human.y_W_m = {0, 0.5f, 0.5f};
  human.z_W_m = {4, 4, 4};
  human.x_W_measured_m = human.y_W_measured_m = human.z_W_measured_m = {0, 0, 0};
  human.num_joints = 3;
  human.segment_id = {4};
  human.length_m = {0.2f};
  human.num_segments = 1;
  message.humans = {human};
  message.num_humans = 1;
  return {channel::kMapUpdate, Encode(message)};
}

Envelope Truth(std::int64_t seq, std::int64_t session = kSession) {
  auto message = Make<pose_t>(seq, session);
  message.axes = pose_t::AXES_NED;
  message.position[1] = static_cast<double>(seq);
  SetIdentity(message.orientation);
  return {channel::kGroundTruth, Encode(message)};
}

Envelope Calibration(std::int64_t seq) {
  auto message = Make<stereo_calibration_t>(seq);
  message.width = 640;
  message.height = 360;
  message.fx_px = message.fy_px = 700;
  message.cx_px = 320;
  message.cy_px = 180;
  message.baseline_m = 0.25;
  return {channel::kCalibration, Encode(message)};
}

std::string BytesOf(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

class MapRecorderTest : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = (fs::temp_directory_path() / ("airdos_map_recorder_test_" + std::to_string(getpid())))
                  .string();
    fs::remove_all(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  MapRecorderOptions Options(const std::string& name) const {
    MapRecorderOptions options;
    options.directory = folder_ + "/" + name;
    options.chunk_frames = 4;
    return options;
  }
  static void Feed(const std::vector<Envelope>& messages, Node* node) {
    for (const Envelope& message : messages) {
      node->Receive(message.channel, message.payload.data(), message.payload.size());
      while (node->Step()) {
      }
    }
  }
  static void CompleteAll(Node* node) {
    while (node->CompleteOldest()) {
    }
  }
  /// What a recorder that works in the folder would leave behind if it was killed now.
  void KillNow(const std::string& name, const std::string& left_behind) const {
    const fs::path from = fs::path(folder_) / name;
    const fs::path to = fs::path(folder_) / left_behind;
    fs::remove_all(to);
    fs::copy(from, to, fs::copy_options::recursive);
    for (const auto& entry : fs::recursive_directory_iterator(to)) {
      if (!entry.is_regular_file()) continue;
      fs::last_write_time(entry, fs::last_write_time(from / fs::relative(entry, to)));
    }
  }
  static FourDMap Read(const std::string& directory) {
    MapFileSummary summary;
    return ReadFourDMap(directory + "/map.airdos", &summary);
  }
  std::string folder_;
};

std::vector<Envelope> Recording(int num_frames) {
  std::vector<Envelope> messages = {Calibration(0)};
  for (int seq = 0; seq < num_frames; ++seq) {
    messages.push_back(Truth(seq));
    messages.push_back(State(seq));
    messages.push_back(Update(seq));
  }
  return messages;
}

TEST_F(MapRecorderTest, RecordsWhatTheOptimizerSays) {
  const MapRecorderOptions options = Options("a");
  MapRecorderNode node(options);
  Feed(Recording(10), &node);
  EXPECT_EQ(node.frames().num_done, 10);
  EXPECT_EQ(node.frames().num_incomplete, 0);
  node.Finish();
  EXPECT_TRUE(node.TakeOutput().empty());

  const FourDMap map = Read(options.directory);
  EXPECT_TRUE(map.is_closed);
  EXPECT_EQ(map.session, kSession);
  EXPECT_EQ(map.camera->fx_px, 700);
  EXPECT_EQ(map.ground_truth_axes, static_cast<int>(pose_t::AXES_NED));
  ASSERT_EQ(map.frames.size(), 10u);
  for (const auto& [id, frame] : map.frames) {
    EXPECT_EQ(frame.utime, 1000000 + 100000 * id.value);
    EXPECT_EQ(frame.live->translation.x(), static_cast<double>(id.value));
    EXPECT_EQ(frame.ground_truth->translation.y(), static_cast<double>(id.value));
    EXPECT_EQ(frame.refined.has_value(), id.value < 9);
    if (frame.refined) {
      EXPECT_EQ(frame.refined->translation.x(), static_cast<double>(id.value) + 0.25);
    }
  }
  std::vector<std::int64_t> ids;
  for (const auto& [id, landmark] : map.landmarks) ids.push_back(id.value);
  EXPECT_EQ(ids, (std::vector<std::int64_t>{0, 6, 7, 8, 9}));
  EXPECT_EQ(map.landmarks.at({0}).p_W.x(), 9);
  EXPECT_EQ(map.landmarks.at({0}).num_observations, 10);
  EXPECT_EQ(map.landmarks.at({9}).p_W, Eigen::Vector3f(19, 1, 6));
  EXPECT_EQ(map.humans.size(), 10u);
  EXPECT_EQ(map.humans.at({{7}, {3}}).joints.at(8).p_W, Eigen::Vector3f(0.1f, 0.5f, 4));
  for (const char* name : {"trajectory.tum", "trajectory_live.tum", "trajectory.kitti", "map.ply",
                           "people.jsonl", "people/3.tum", "ground_truth.tum"}) {
    EXPECT_TRUE(fs::exists(options.directory + "/" + name)) << name;
  }
}

TEST_F(MapRecorderTest, TheFileDoesNotDependOnHowChannelsInterleave) {
  {
    MapRecorderNode node(Options("a"));
    Feed(Recording(10), &node);
  }
  std::vector<Envelope> by_channel = Recording(10);
  std::stable_sort(by_channel.begin(), by_channel.end(),
                   [](const Envelope& a, const Envelope& b) { return a.channel > b.channel; });
  {
    MapRecorderNode node(Options("b"));
    Feed(by_channel, &node);
  }
  const std::string a = BytesOf(folder_ + "/a/map.airdos");
  EXPECT_FALSE(a.empty());
  EXPECT_EQ(a, BytesOf(folder_ + "/b/map.airdos"));
  // And it is the right one: of Recording(10) each frame, and landmarks 0 and 6 to 9.
  const FourDMap map = Read(folder_ + "/b");
  ASSERT_EQ(map.frames.size(), 10u);
  EXPECT_EQ(map.frames.at({8}).live->translation.x(), 8);
  EXPECT_EQ(map.frames.at({8}).refined->translation.x(), 8.25);
  EXPECT_EQ(map.frames.at({9}).ground_truth->translation.y(), 9);
  EXPECT_EQ(map.landmarks.size(), 5u);
  EXPECT_EQ(map.landmarks.at({0}).num_observations, 10);
  EXPECT_EQ(map.landmarks.at({9}).p_W.x(), 19);
  EXPECT_EQ(map.humans.size(), 10u);
}

TEST_F(MapRecorderTest, PartsOfAnUpdateAreTakenInOrder) {
  MapRecorderNode node(Options("a"));
  Feed({State(0), Update(0), State(1), Update(1, 1, 2)}, &node);
  EXPECT_EQ(node.frames().num_done, 1);
  Feed({Update(1, 0, 2)}, &node);
  EXPECT_EQ(node.frames().num_done, 2);
  node.Finish();
  EXPECT_EQ(Read(folder_ + "/a").frames.at({0}).refined->translation.x(), 1.25);  // of part 1
}

TEST_F(MapRecorderTest, WhatAKillLeavesIsReadable) {
  MapRecorderNode node(Options("a"));
  Feed(Recording(10), &node);
  const FourDMap map = Read(folder_ + "/a");  // the node still runs: as after a kill
  EXPECT_FALSE(map.is_closed);
  EXPECT_EQ(map.frames.size(), 8u);  // two chunks of four
  EXPECT_EQ(map.humans.size(), 8u);
}

TEST_F(MapRecorderTest, WritesOldGroundTruthWhileItRuns) {
  const std::int64_t num_old = 100;
  const auto num_frames = static_cast<int>(MapRecorderNode::kGroundTruthLag + num_old);
  const auto count = [&] {
    std::int64_t num = 0;
    for (const auto& [id, frame] : Read(folder_ + "/map").frames) {
      if (!frame.ground_truth) continue;
      EXPECT_EQ(frame.ground_truth->translation.y(), static_cast<double>(id.value));
      ++num;
    }
    return num;
  };
  MapRecorderNode node(Options("map"));
  Feed(Recording(num_frames), &node);
  EXPECT_EQ(count(), num_old - 1);  // else memory would grow with the run's length
  node.Finish();
  EXPECT_EQ(count(), num_frames);
}

TEST_F(MapRecorderTest, KeepsAMapThatWasNotClosed) {
  {
    MapRecorderNode node(Options("a"));
    Feed(Recording(10), &node);
    KillNow("a", "b");
  }
  for (int run = 0; run < 2; ++run) {  // the second finds a closed map and replaces it
    MapRecorderNode node(Options("b"));
    Feed(Recording(3), &node);
  }
  EXPECT_EQ(Read(folder_ + "/b").frames.size(), 3u);
  MapFileSummary summary;
  EXPECT_EQ(ReadFourDMap(folder_ + "/b/map.airdos.unfinished_1", &summary).frames.size(), 8u);
  EXPECT_FALSE(fs::exists(folder_ + "/b/map.airdos.unfinished_2"));
}

TEST_F(MapRecorderTest, GoesOnWithTheMapOfARecorderThatWasKilled) {
  const std::vector<Envelope> all = Recording(30);
  const auto of = [&](std::int64_t first, std::int64_t last) {
    std::vector<Envelope> some;
    for (const Envelope& message : all) {
      const auto header = PeekHeader(message.payload.data(), message.payload.size());
      const bool is_early_truth = message.channel == channel::kGroundTruth && header->seq < first;
      const bool is_calibration = message.channel == channel::kCalibration;
      if (header->seq >= first && header->seq <= last && !is_early_truth &&
          (first == 0 || !is_calibration)) {
        some.push_back(message);
      }
    }
    return some;
  };
  const std::string map_path = folder_ + "/b/map.airdos";
  {
    MapRecorderNode killed(Options("a"));
    Feed(of(0, 13), &killed);  // three chunks of four, two frames in the open one
    KillNow("a", "b");
  }
  std::ofstream(map_path, std::ios::app) << "half a chunk";
  {
    MapRecorderNode node(Options("b"));
    Feed(of(16, 29), &node);
    CompleteAll(&node);
    node.Finish();
  }
  const FourDMap map = Read(folder_ + "/b");
  EXPECT_TRUE(map.is_closed);
  EXPECT_TRUE(map.camera) << "heard by the one that was killed";
  EXPECT_EQ(map.ground_truth_axes, +pose_t::AXES_NED);
  for (std::int64_t seq = 0; seq < 30; ++seq) {
    const bool is_known = map.frames.count({seq}) > 0;
    const bool is_lost = seq >= 12 && seq < 16;
    EXPECT_EQ(is_known && map.frames.at({seq}).live.has_value(), !is_lost) << seq;
    if (seq < 10 || seq >= 16) {
      EXPECT_TRUE(is_known && map.frames.at({seq}).ground_truth) << seq;
    }
  }
  EXPECT_FALSE(fs::exists(map_path + ".open"));
  EXPECT_FALSE(fs::exists(map_path + ".unfinished_1"));
}

TEST_F(MapRecorderTest, AnotherSessionGoesToItsOwnFolder) {
  {
    MapRecorderNode node(Options("a"));
    Feed(Recording(3), &node);
    Feed({State(0, 43), Update(0, 0, 1, 43), Truth(0, 43)}, &node);
    CompleteAll(&node);
  }
  EXPECT_EQ(Read(folder_ + "/a").session, kSession);
  EXPECT_EQ(Read(folder_ + "/a").frames.size(), 3u);
  const FourDMap second = Read(folder_ + "/a/session_2");
  EXPECT_EQ(second.session, 43);
  EXPECT_EQ(second.frames.size(), 1u);
  EXPECT_TRUE(second.frames.at({0}).ground_truth);
}

// Killed in the second session: whoever goes on with it finds it, and whoever does not leaves both
// maps alone.
TEST_F(MapRecorderTest, AKillInTheSecondSessionCostsNoMapOfTheFirst) {
  const std::string first = folder_ + "/c/map.airdos";
  const std::string second = folder_ + "/c/session_2/map.airdos";
  const auto session_43 = [](std::int64_t first_seq, std::int64_t last_seq) {
    std::vector<Envelope> messages;
    for (std::int64_t seq = first_seq; seq <= last_seq; ++seq) {
      messages.push_back(State(seq, 43));
      messages.push_back(Update(seq, 0, 1, 43));
    }
    return messages;
  };
  {
    MapRecorderNode killed(Options("a"));
    Feed(Recording(3), &killed);
    Feed(session_43(0, 9), &killed);
    KillNow("a", "b");
    KillNow("a", "c");
  }
  {
    MapRecorderNode node(Options("b"));
    Feed(session_43(10, 11), &node);
  }
  EXPECT_EQ(Read(folder_ + "/b").session, kSession);
  EXPECT_EQ(Read(folder_ + "/b/session_2").frames.rbegin()->first.value, 11);

  for (int run = 0; run < 2; ++run) {  // the second finds nothing cut short, and replaces
    MapRecorderNode node(Options("c"));
    Feed({State(0, 44), Update(0, 0, 1, 44)}, &node);
    CompleteAll(&node);
  }
  MapFileSummary summary;
  EXPECT_EQ(ReadFourDMap(first + ".closed_1", &summary).frames.size(), 3u);
  EXPECT_EQ(ReadFourDMap(second + ".unfinished_1", &summary).session, 43);
  EXPECT_EQ(Read(folder_ + "/c").session, 44);
  EXPECT_FALSE(fs::exists(first + ".closed_2"));
  EXPECT_FALSE(fs::exists(second));
}

// Each has a folder, and whoever invents sessions must not fill the disk with them.
TEST_F(MapRecorderTest, SessionsBeyondTheBoundAreNotRecorded) {
  MapRecorderOptions options = Options("a");
  options.export_at_end = false;
  MapRecorderNode node(options);
  int num_refused = 0;
  for (std::int64_t session = 1; session <= MapRecorderNode::kMaxSessions + 2; ++session) {
    const Envelope state = State(0, session);
    node.Receive(state.channel, state.payload.data(), state.payload.size());
    try {
      node.CompleteOldest();
    } catch (const InputError& error) {
      ++num_refused;
      EXPECT_NE(std::string(error.what()).find("is not recorded"), std::string::npos);
    }
  }
  node.Finish();
  EXPECT_EQ(num_refused, 2);
  EXPECT_TRUE(fs::exists(folder_ + "/a/session_1000"));
  EXPECT_FALSE(fs::exists(folder_ + "/a/session_1001"));
}

TEST_F(MapRecorderTest, AFrameWithoutItsUpdateIsKept) {
  {
    MapRecorderNode node(Options("a"));
    Feed({State(0), State(1)}, &node);
    CompleteAll(&node);
    EXPECT_EQ(node.frames().num_incomplete, 2);
  }
  EXPECT_EQ(Read(folder_ + "/a").frames.size(), 2u);
}

TEST_F(MapRecorderTest, AFrameWithoutAPoseIsNoFrame) {
  state_estimate_t unknown;
  const Envelope state = State(1);
  ASSERT_TRUE(Decode(state.payload.data(), state.payload.size(), &unknown));
  unknown.status = state_estimate_t::STATUS_INVALID;
  {
    MapRecorderNode node(Options("a"));
    Feed({State(0), {channel::kStateEstimate, Encode(unknown)}, State(2)}, &node);
    CompleteAll(&node);
  }
  EXPECT_EQ(Read(folder_ + "/a").frames.size(), 2u);
}

TEST_F(MapRecorderTest, BadBytesAreCounted) {
  MapRecorderNode node(Options("a"));
  Envelope broken = State(0);
  broken.payload.resize(30);
  Feed({broken}, &node);
  EXPECT_EQ(node.channels().at(channel::kStateEstimate).num_rejected, 1);
  node.Finish();
  EXPECT_FALSE(fs::exists(folder_ + "/a/map.airdos"));
}

TEST_F(MapRecorderTest, SaysThatTheFolderCannotBeMade) {
  fs::create_directories(folder_);
  std::ofstream(folder_ + "/file") << "";
  EXPECT_THROW(MapRecorderNode(Options("file")), InputError);
  EXPECT_THROW(MapRecorderNode(Options("file/below")), InputError);
}

TEST_F(MapRecorderTest, ReadsItsConfiguration) {
  ConfigReader config =
      ConfigReader::FromFile(AIRDOS_SOURCE_DIR "/launch_scripts/config/map_recorder.yaml");
  config.Override("output.directory=" + folder_ + "/a");
  config.Override("output.chunk_frames=3");
  const std::unique_ptr<Node> node = MakeMapRecorderNode(&config);
  config.Finish();
  Feed(Recording(5), node.get());
  EXPECT_EQ(Read(folder_ + "/a").frames.size(), 3u) << "one chunk, and the next one is open";
}

}  // namespace
}  // namespace airdos
