// What the optimizer and the sources say, field by field, in the map: all values different.
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "processes/map_recorder/map_recorder_node.h"
#include "processes/node/message/header.h"

namespace airdos {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t kSession = 42;

template <class Message>
Message Make(std::int64_t seq, std::int64_t session = kSession) {
  return MessageOf<Message>({1000000 + 100000 * seq, seq, session});
}

void Set(std::vector<double> values, double* target) {
  for (std::size_t i = 0; i < values.size(); ++i) target[i] = values[i];
}

/// The trusted pose is the one with people; the other is elsewhere.
state_estimate_t State(std::int64_t seq, std::int64_t session = kSession) {
  auto message = Make<state_estimate_t>(seq, session);
  message.status = state_estimate_t::STATUS_NOT_CONVERGED;
  message.trusted = state_estimate_t::TRUSTED_WITH_PEOPLE;
  Set({1.5, -2.5, 3.5}, message.position_W_C);
  Set({0.1, 0.5, -0.5, 0.7}, message.orientation_W_C);
  Set({9, 8, 7}, message.position_without_people_W_C);
  Set({1, 0, 0, 0}, message.orientation_without_people_W_C);
  Set({1.5, -2.5, 3.5}, message.position_with_people_W_C);
  Set({0.1, 0.5, -0.5, 0.7}, message.orientation_with_people_W_C);
  return message;
}

human_state_t Human(std::int64_t seq) {
  human_state_t human = {};
  human.track_id = 3000 + seq;
  human.seq = seq;
  human.utime = 77000 + seq;
  human.joint_id = {2, 13};
  human.x_W_m = {1, 2};
  human.y_W_m = {3, 4};
  human.z_W_m = {5, 6};
  human.x_W_measured_m = {7, 8};
  human.y_W_measured_m = {9, 10};
  human.z_W_measured_m = {11, 12};
  human.num_joints = 2;
  human.segment_id = {5, 12};
  human.length_m = {0.25F, 0.5F};
  human.num_segments = 2;
  human.part_id = {3, 8};
  human.translation_m = {{1, 2, 3}, {4, 5, 6}};
  human.rotation = {{0.1F, 0.5F, -0.5F, 0.7F}, {0.5F, -0.1F, 0.7F, 0.5F}};
  human.num_motions = 2;
  return human;
}

map_update_t Update(std::int64_t seq, std::int64_t session = kSession) {
  auto message = Make<map_update_t>(seq, session);
  message.num_parts = 1;
  return message;
}

class MapRecorderValuesTest : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto* info = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = (fs::temp_directory_path() /
               ("airdos_map_values_" + std::to_string(getpid()) + "_" + info->name()))
                  .string();
    fs::remove_all(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  MapRecorderOptions Options() const {
    MapRecorderOptions options;
    options.directory = folder_;
    options.chunk_frames = 3;
    return options;
  }
  template <class Message>
  static void Send(const std::string& channel, const Message& message, Node* node) {
    ASSERT_EQ(Validate(message), "");
    const std::vector<std::uint8_t> bytes = Encode(message);
    node->Receive(channel, bytes.data(), bytes.size());
    while (node->Step()) {
    }
  }
  static void SendFrame(std::int64_t seq, Node* node, std::int64_t session = kSession) {
    Send(channel::kStateEstimate, State(seq, session), node);
    Send(channel::kMapUpdate, Update(seq, session), node);
  }
  static void SendTruth(std::int64_t seq, Node* node, std::int8_t axes = pose_t::AXES_NED,
                        std::int64_t session = kSession) {
    auto truth = Make<pose_t>(seq, session);
    truth.axes = axes;
    Set({0.5, 1.5, static_cast<double>(seq)}, truth.position);
    Set({0.5, 0.7, -0.1, 0.5}, truth.orientation);
    Send(channel::kGroundTruth, truth, node);
  }
  static void SendCamera(std::int64_t seq, double fx_px, Node* node) {
    auto message = Make<stereo_calibration_t>(seq);
    FromStereoCamera({641, 363, fx_px, 688.25, 322.75, 177.5, 0.2375}, &message);
    Send(channel::kCalibration, message, node);
  }
  FourDMap Read(const std::string& name = "map.airdos") const {
    MapFileSummary summary;
    return ReadFourDMap(folder_ + "/" + name, &summary);
  }
  MapFileSummary Summary() const {
    MapFileSummary summary;
    ReadFourDMap(folder_ + "/map.airdos", &summary);
    return summary;
  }

  std::string folder_;
};

TEST_F(MapRecorderValuesTest, TheLivePoseIsTheTrustedOne) {
  MapRecorderNode node(Options());
  SendFrame(0, &node);
  node.Finish();
  const MapFrame frame = Read().frames.at({0});
  ASSERT_TRUE(frame.live);
  EXPECT_EQ(frame.live->translation, Eigen::Vector3d(1.5, -2.5, 3.5));
  EXPECT_LT(frame.live->rotation.angularDistance(Eigen::Quaterniond(0.1, 0.5, -0.5, 0.7)), 1e-9);
  EXPECT_EQ(frame.status, +state_estimate_t::STATUS_NOT_CONVERGED);
  EXPECT_TRUE(frame.is_trusted_with_people);
  EXPECT_EQ(frame.utime, 1000000);
  EXPECT_FALSE(frame.refined);
}

TEST_F(MapRecorderValuesTest, WhoTrustsNoPeopleSaysSoAndWhoKnowsNothingHasNoPose) {
  MapRecorderNode node(Options());
  state_estimate_t state = State(0);
  state.trusted = state_estimate_t::TRUSTED_WITHOUT_PEOPLE;
  Send(channel::kStateEstimate, state, &node);
  Send(channel::kMapUpdate, Update(0), &node);
  state = State(1);
  state.status = state_estimate_t::STATUS_INVALID;
  Send(channel::kStateEstimate, state, &node);
  Send(channel::kMapUpdate, Update(1), &node);
  node.Finish();
  const FourDMap map = Read();
  EXPECT_FALSE(map.frames.at({0}).is_trusted_with_people);
  EXPECT_EQ(map.frames.count({1}), 0u);
}

TEST_F(MapRecorderValuesTest, APersonHasEachValueInItsPlace) {
  MapRecorderNode node(Options());
  map_update_t update = Update(4);
  update.humans = {Human(2), Human(4)};  // of an older frame, too
  update.num_humans = 2;
  Send(channel::kStateEstimate, State(4), &node);
  Send(channel::kMapUpdate, update, &node);
  while (node.CompleteOldest()) {
  }
  node.Finish();
  const FourDMap map = Read();
  ASSERT_EQ(map.humans.size(), 2u);
  const MapHuman& human = map.humans.at({{2}, {3002}});
  EXPECT_EQ(human.utime, 77002);
  ASSERT_EQ(human.joints.size(), 2u);
  EXPECT_EQ(human.joints.at(2).p_W, Eigen::Vector3f(1, 3, 5));
  EXPECT_EQ(human.joints.at(2).p_W_measured, Eigen::Vector3f(7, 9, 11));
  EXPECT_EQ(human.joints.at(13).p_W, Eigen::Vector3f(2, 4, 6));
  EXPECT_EQ(human.joints.at(13).p_W_measured, Eigen::Vector3f(8, 10, 12));
  ASSERT_EQ(human.segment_lengths_m.size(), 2u);
  EXPECT_EQ(human.segment_lengths_m.at(5), 0.25F);
  EXPECT_EQ(human.segment_lengths_m.at(12), 0.5F);
  ASSERT_EQ(human.part_motions.size(), 2u);
  EXPECT_EQ(human.part_motions.at(3).t_W, Eigen::Vector3f(1, 2, 3));
  EXPECT_EQ(human.part_motions.at(3).R_W.coeffs(), Eigen::Vector4f(0.5F, -0.5F, 0.7F, 0.1F));
  EXPECT_EQ(human.part_motions.at(8).t_W, Eigen::Vector3f(4, 5, 6));
  EXPECT_EQ(human.part_motions.at(8).R_W.coeffs(), Eigen::Vector4f(-0.1F, 0.7F, 0.5F, 0.5F));
  EXPECT_EQ(map.humans.at({{4}, {3004}}).utime, 77004);
}

TEST_F(MapRecorderValuesTest, RefinedPosesAndLandmarksHaveEachValueInItsPlace) {
  MapRecorderNode node(Options());
  map_update_t update = Update(4);
  frame_pose_t pose = {};
  pose.seq = 2;
  pose.utime = 123456;
  Set({4.5, 5.5, -6.5}, pose.position_W_C);
  Set({0.5, 0.1, 0.7, -0.5}, pose.orientation_W_C);
  update.frames = {pose};
  update.num_frames = 1;
  update.landmark_id = {11, 12, 13};
  update.x_W_m = {1, 2, 3};
  update.y_W_m = {4, 5, 6};
  update.z_W_m = {7, 8, 9};
  update.sigma_m = {0.25F, 0.5F, 0.75F};
  update.num_observations = {21, 22, 23};
  update.num_landmarks = 3;
  Send(channel::kStateEstimate, State(4), &node);
  Send(channel::kMapUpdate, update, &node);
  while (node.CompleteOldest()) {
  }
  update = Update(5);
  update.removed_landmark_id = {12};
  update.num_removed = 1;
  Send(channel::kStateEstimate, State(5), &node);
  Send(channel::kMapUpdate, update, &node);
  node.Finish();
  const FourDMap map = Read();
  const MapFrame& frame = map.frames.at({2});
  EXPECT_EQ(frame.utime, 123456);
  ASSERT_TRUE(frame.refined);
  EXPECT_FALSE(frame.live);
  EXPECT_EQ(frame.refined->translation, Eigen::Vector3d(4.5, 5.5, -6.5));
  EXPECT_LT(frame.refined->rotation.angularDistance(Eigen::Quaterniond(0.5, 0.1, 0.7, -0.5)), 1e-9);
  ASSERT_EQ(map.landmarks.size(), 2u);
  EXPECT_EQ(map.landmarks.at({11}).p_W, Eigen::Vector3f(1, 4, 7));
  EXPECT_EQ(map.landmarks.at({11}).sigma_m, 0.25F);
  EXPECT_EQ(map.landmarks.at({11}).num_observations, 21);
  EXPECT_EQ(map.landmarks.at({13}).p_W, Eigen::Vector3f(3, 6, 9));
  EXPECT_EQ(map.landmarks.at({13}).sigma_m, 0.75F);
  EXPECT_EQ(map.landmarks.at({13}).num_observations, 23);
}

TEST_F(MapRecorderValuesTest, TheCameraIsTheEarliestAndTheTruthHasItsAxes) {
  MapRecorderNode node(Options());
  SendCamera(5, 750, &node);
  SendCamera(2, 701.5, &node);  // of an earlier image, though it came later
  SendCamera(9, 760, &node);
  SendFrame(0, &node);
  SendTruth(0, &node, pose_t::AXES_OPTICAL);
  SendTruth(1, &node, pose_t::AXES_OPTICAL);
  SendTruth(1, &node, pose_t::AXES_OPTICAL);
  EXPECT_EQ(node.channels().at(channel::kGroundTruth).num_duplicate, 1);
  node.Finish();
  const FourDMap map = Read();
  ASSERT_TRUE(map.camera);
  EXPECT_TRUE(*map.camera == (StereoCamera{641, 363, 701.5, 688.25, 322.75, 177.5, 0.2375}));
  EXPECT_EQ(map.ground_truth_axes, +pose_t::AXES_OPTICAL);
  const MapFrame& frame = map.frames.at({1});  // which the optimizer never spoke of
  ASSERT_TRUE(frame.ground_truth);
  EXPECT_EQ(frame.utime, 1100000);
  EXPECT_EQ(frame.ground_truth->translation, Eigen::Vector3d(0.5, 1.5, 1));
  EXPECT_LT(frame.ground_truth->rotation.angularDistance(Eigen::Quaterniond(0.5, 0.7, -0.1, 0.5)),
            1e-9);
}

TEST_F(MapRecorderValuesTest, AChunkHasAsManyFramesAsTheOptionsSay) {
  MapRecorderNode node(Options());
  for (int seq = 0; seq < 2; ++seq) {
    SendFrame(seq, &node);
    EXPECT_EQ(Summary().num_chunks, 1) << "the head";
  }
  SendFrame(2, &node);
  EXPECT_EQ(Summary().num_chunks, 2);
  EXPECT_EQ(Read().frames.size(), 3u);
}

// 8 MB of landmarks (28 bytes each) are 300,000: they do not wait for the last frame of a chunk.
TEST_F(MapRecorderValuesTest, ALargeChunkIsWrittenBeforeItsLastFrame) {
  MapRecorderOptions options = Options();
  options.chunk_frames = 1000;
  MapRecorderNode node(options);
  std::int64_t id = 0;
  for (int seq = 0; seq < 20; ++seq) {
    map_update_t update = Update(seq);
    for (int i = 0; i < 19000; ++i) {
      update.landmark_id.push_back(id++);
      update.x_W_m.push_back(1);
      update.y_W_m.push_back(2);
      update.z_W_m.push_back(3);
      update.sigma_m.push_back(0.5F);
      update.num_observations.push_back(2);
    }
    update.num_landmarks = 19000;
    Send(channel::kStateEstimate, State(seq), &node);
    Send(channel::kMapUpdate, update, &node);
  }
  EXPECT_EQ(Summary().num_chunks, 2);
  EXPECT_GT(Read().landmarks.size(), 299000u);
  node.Finish();
  EXPECT_EQ(Read().landmarks.size(), 380000u);
}

TEST_F(MapRecorderValuesTest, TruthWaitsForItsLagAndIsNotedBesideTheMap) {
  MapRecorderNode node(Options());
  SendFrame(0, &node);
  for (int seq = 0; seq < 9; ++seq) SendTruth(seq, &node);
  EXPECT_EQ(Read("map.airdos.open").frames.size(), 0u);
  SendTruth(9, &node);  // as many as are noted at once
  ASSERT_EQ(Read("map.airdos.open").frames.size(), 10u);
  EXPECT_EQ(Read("map.airdos.open").frames.at({7}).ground_truth->translation.z(), 7);
  EXPECT_EQ(Read("map.airdos.open").session, kSession);
  EXPECT_EQ(Read("map.airdos.open").ground_truth_axes, +pose_t::AXES_NED);
  for (int seq = 1; seq < 6; ++seq) SendFrame(seq, &node);
  for (const auto& [id, frame] : Read().frames) EXPECT_FALSE(frame.ground_truth) << id.value;
  node.Finish();
  EXPECT_FALSE(fs::exists(folder_ + "/map.airdos.open"));
  for (std::int64_t seq = 0; seq < 10; ++seq) EXPECT_TRUE(Read().frames.at({seq}).ground_truth);
}

TEST_F(MapRecorderValuesTest, ExportsOnlyWhereItIsTold) {
  for (const bool exports : {false, true}) {
    MapRecorderOptions options = Options();
    options.directory = folder_ + (exports ? "/with" : "/without");
    options.export_at_end = exports;
    MapRecorderNode node(options);
    SendFrame(0, &node);
    node.Finish();
    EXPECT_EQ(fs::exists(options.directory + "/trajectory.tum"), exports);
  }
}

TEST_F(MapRecorderValuesTest, EachKeyOfTheConfigurationIsInForce) {
  ConfigReader config =
      ConfigReader::FromFile(AIRDOS_SOURCE_DIR "/launch_scripts/config/map_recorder.yaml");
  config.Override("output.directory=" + folder_);
  config.Override("output.chunk_frames=2");
  config.Override("output.export_at_end=false");
  const std::unique_ptr<Node> node = MakeMapRecorderNode(&config);
  config.Finish();
  for (int seq = 0; seq < 4; ++seq) SendFrame(seq, node.get());
  EXPECT_EQ(Summary().num_chunks, 3) << "the head and twice two frames";
  node->Finish();
  EXPECT_FALSE(fs::exists(folder_ + "/trajectory.tum"));
}

// What lies beside the map of a recorder that was killed counts only if it is of the same session;
// a map that has the next frame already is not gone on with.
TEST_F(MapRecorderValuesTest, GoesOnOnlyWithWhatIsOfItsSessionAndEarlier) {
  // As a recorder that is killed leaves its folder: copied before it ends, times of change and all.
  const auto leave_unfinished = [&] {
    const fs::path kept = folder_ + "_kept";
    {
      MapRecorderNode node(Options());
      for (int seq = 0; seq < 3; ++seq) SendFrame(seq, &node);
      fs::copy(folder_, kept, fs::copy_options::recursive);
      for (const auto& file : fs::directory_iterator(kept))
        fs::last_write_time(file, fs::last_write_time(fs::path(folder_) / file.path().filename()));
    }
    fs::remove_all(folder_);
    fs::rename(kept, folder_);
  };
  leave_unfinished();
  {
    MapFileWriter notes(folder_ + "/map.airdos.open");
    notes.Append(HeadChunk(kSession + 1, ""));
    MapDelta changes;
    MapFrame frame;
    frame.utime = 5;
    frame.ground_truth = Se3();
    changes.SetFrame({1}, frame);
    notes.Append(changes.ToChunk());
  }
  {
    MapRecorderNode node(Options());
    SendFrame(3, &node);
    while (node.CompleteOldest()) {
    }
    node.Finish();
    EXPECT_EQ(Read().frames.size(), 4u);
    EXPECT_FALSE(Read().frames.at({1}).ground_truth);
  }
  leave_unfinished();
  MapRecorderNode node(Options());
  SendFrame(2, &node);  // it is in the map already
  while (node.CompleteOldest()) {
  }
  node.Finish();
  EXPECT_EQ(Read().frames.size(), 1u);
  EXPECT_TRUE(fs::exists(folder_ + "/map.airdos.unfinished_1"));
}

}  // namespace
}  // namespace airdos
