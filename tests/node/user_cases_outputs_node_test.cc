#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <string>
#include <vector>

#include "airdos/pose_t.hpp"
#include "airdos/state_estimate_t.hpp"
#include "common/map/four_d_map.h"
#include "processes/map_recorder/map_recorder_node.h"
#include "processes/node/log/event_log.h"
#include "processes/node/message/channels.h"
#include "processes/node/message/codec.h"
#include "processes/tools/replay/replay_setup.h"
#include "tests/support/folder_test.h"
#include "tests/support/input_errors.h"

// What the map recorder and a replay do with the folder that they are given.

namespace airdos {
namespace {

namespace fs = std::filesystem;

class UserCases : public FolderTest {
 protected:
  UserCases() : FolderTest("user_cases_node") {}

  MapRecorderOptions Options(bool force = false) const {
    MapRecorderOptions options;
    options.directory = Path("run");
    options.chunk_frames = 2;
    options.rules.force = force;
    return options;
  }
  static void Take(const Envelope& message, Node* node) {
    node->Receive(message.channel, message.payload.data(), message.payload.size());
    while (node->Step()) {
    }
  }
  template <class Message>
  static Message Make(std::int64_t seq, std::int64_t session) {
    return MessageOf<Message>({1000000 + 100000 * seq, seq, session});
  }
  static void Feed(int num_frames, bool has_truth, std::int64_t session, Node* node) {
    for (std::int64_t seq = 0; seq < num_frames; ++seq) {
      auto state = Make<state_estimate_t>(seq, session);
      state.status = state_estimate_t::STATUS_CONVERGED;
      state.trusted = state_estimate_t::TRUSTED_WITHOUT_PEOPLE;
      state.orientation_W_C[0] = state.orientation_with_people_W_C[0] =
          state.orientation_without_people_W_C[0] = 1;
      auto truth = Make<pose_t>(seq, session);
      truth.axes = pose_t::AXES_NED;
      truth.orientation[0] = 1;
      if (has_truth) Take({channel::kGroundTruth, Encode(truth)}, node);
      Take({channel::kStateEstimate, Encode(state)}, node);
    }
    while (node->CompleteOldest()) {
    }
  }
  void Record(int num_frames, bool has_truth, bool force = false) const {
    MapRecorderNode node(Options(force));
    Feed(num_frames, has_truth, 7, &node);
    node.Finish();
  }
};

TEST_F(UserCases, CaseC11NothingOfALongerRunStandsBesideAShorterOne) {
  {
    MapRecorderNode node(Options());
    Feed(5, true, 7, &node);
    Feed(3, true, 8, &node);
    node.Finish();
  }
  EXPECT_TRUE(fs::exists(Path("run/ground_truth.tum")));
  EXPECT_TRUE(fs::exists(Path("run/session_2/ground_truth.tum")));
  testing::internal::CaptureStderr();
  Record(2, false);
  const std::string said = testing::internal::GetCapturedStderr();
  EXPECT_TRUE(Holds(said, "run/map.airdos: replaces the map of session 7, 5 frames")) << said;
  EXPECT_TRUE(Holds(said, "replaces the map of session 8, 3 frames")) << said;
  EXPECT_TRUE(Holds(said, "replaces the results of an earlier run: ")) << said;
  EXPECT_FALSE(fs::exists(Path("run/ground_truth.tum")));
  EXPECT_FALSE(fs::exists(Path("run/session_2")));
  MapFileSummary summary;
  EXPECT_EQ(ReadFourDMap(Path("run/map.airdos"), &summary).frames.size(), 2u);
}

TEST_F(UserCases, CaseC11ARunWithoutAFrameLeavesTheResultsBefore) {
  Record(3, true);
  { MapRecorderNode node(Options()); }
  EXPECT_TRUE(fs::exists(Path("run/map.airdos")));
  EXPECT_TRUE(fs::exists(Path("run/ground_truth.tum")));
}

TEST_F(UserCases, CaseC03FilesOfTheUserAreLeftAlone) {
  Write("run/people/thesis.txt", "mine");
  Write("run/session_2/notes.txt", "mine");
  for (int run = 0; run < 2; ++run) {
    MapRecorderNode node(Options());
    Feed(3, true, 7, &node);
    Feed(3, true, 8, &node);
    node.Finish();
  }
  Record(2, false);
  EXPECT_EQ(TextOf("run/people/thesis.txt"), "mine");
  EXPECT_EQ(TextOf("run/session_2/notes.txt"), "mine");
  EXPECT_FALSE(fs::exists(Path("run/session_2/map.airdos")));
}

TEST_F(UserCases, CaseC03AFileOfTheUserInTheWayIsNamedBeforeTheFirstFrame) {
  for (const char* name : {"map.airdos", "trajectory.tum", "people/3.tum", "session_2/map.ply"}) {
    Write(std::string("run/") + name, "mine");
    const std::string message = ErrorOf([&] { MapRecorderNode node(Options()); });
    EXPECT_TRUE(Holds(message, std::string("run/") + name)) << message;
    EXPECT_TRUE(Holds(message, "--force replaces it")) << message;
    EXPECT_EQ(TextOf(std::string("run/") + name), "mine");
    EXPECT_FALSE(fs::exists(Path("run/.airdos_results")));
    fs::remove_all(Path("run"));
  }
  Write("run/trajectory.tum", "mine");
  Record(2, false, true);
  EXPECT_TRUE(Holds(TextOf("run/trajectory.tum"), "1.100000 "));
}

TEST_F(UserCases, CaseC09TwoRecordersInOneFolder) {
  MapRecorderNode first(Options());
  Feed(3, true, 7, &first);
  EXPECT_TRUE(Holds(ErrorOf([&] { MapRecorderNode second(Options(true)); }),
                    "another run is writing here"));
  first.Finish();
  MapFileSummary summary;
  EXPECT_EQ(ReadFourDMap(Path("run/map.airdos"), &summary).frames.size(), 3u);
}

TEST_F(UserCases, CaseC09TheMapIsHeldAgainstWhatWasRecorded) {
  MapRecorderNode node(Options());
  Feed(6, false, 7, &node);
  {
    // Another program's chunks in the place of ours.
    MapFileWriter writer(Path("run/map.airdos"));
    writer.Append(HeadChunk(7, "somebody else"));
  }
  const std::string message = ErrorOf([&] { node.Finish(); });
  EXPECT_TRUE(Holds(message, "run/map.airdos: ")) << message;
  EXPECT_TRUE(Holds(message, "were written")) << message;
}

TEST_F(UserCases, CaseC09TwoWritersOfOneLog) {
  EventLogWriter first(Path("out.lcm"));
  first.Append(1, "A", "x", 1);
  EXPECT_TRUE(Holds(ErrorOf([&] { EventLogWriter second(Path("out.lcm")); }),
                    "another program is writing it"));
  EXPECT_GT(fs::file_size(Path("out.lcm")), 0u);
}

TEST_F(UserCases, CaseC07ARecorderMustBeToldWhere) {
  EXPECT_TRUE(Holds(ErrorOf([&] { MapRecorderNode node{MapRecorderOptions()}; }), "--run-dir"));
}

class ReplayCases : public UserCases {
 protected:
  ReplayCases() { setup_.config_dir = std::string(AIRDOS_SOURCE_DIR) + "/launch_scripts/config"; }
  ReplaySetup setup_;
};

TEST_F(ReplayCases, CaseC07WithoutARunFolderNoMapIsRecorded) {
  EXPECT_EQ(MakeReplayNodes(setup_).size(), 3u);
  // Neither where the configuration of an earlier run names that run's folder.
  fs::copy(setup_.config_dir, Path("config"));
  Write("config/map_recorder.yaml",
        "output:\n  directory: " + Path("run") + "\n  chunk_frames: 10\n  export_at_end: true\n");
  SetConfig(Path("config"), &setup_);
  EXPECT_EQ(MakeReplayNodes(setup_).size(), 3u);
  EXPECT_FALSE(fs::exists(Path("run")));
  setup_.overrides = {"map_recorder:output.directory=" + Path("run")};
  EXPECT_EQ(MakeReplayNodes(setup_).size(), 4u);
}

TEST_F(ReplayCases, CaseC09ARefusedReplayWritesNothing) {
  setup_.run_dir = Path("run");
  const ReplayNodes first = PrepareReplay(setup_);
  Write("run/frontend.yaml", "of the first");
  ReplaySetup second = setup_;
  second.people = "off";
  second.outputs = {Path("run/out.lcm"), Path("timing.json")};
  EXPECT_TRUE(Holds(ErrorOf([&] { PrepareReplay(second); }), "another run is writing here"));
  EXPECT_EQ(TextOf("run/frontend.yaml"), "of the first");
  EXPECT_FALSE(fs::exists(Path("run/out.lcm")));
}

TEST_F(ReplayCases, CaseC01AConfigurationThatIsReadIsAnInput) {
  fs::copy(setup_.config_dir, Path("config"));
  SetConfig(Path("config"), &setup_);
  setup_.run_dir = Path("config");
  setup_.rules.force = true;
  EXPECT_TRUE(Holds(ErrorOf([&] { PrepareReplay(setup_); }), "frontend.yaml: is an input"));
  EXPECT_FALSE(fs::exists(Path("config/.airdos_results")));
}

TEST_F(ReplayCases, CaseC01TheLogIsNoPlaceForTheOutput) {
  Write("in.lcm", "events");
  for (const char* run_dir : {"", "run", "."}) {
    setup_.run_dir = *run_dir == '\0' ? "" : Path(run_dir);
    setup_.rules = {{Path("in.lcm")}, true};
    setup_.outputs = {Path("in.lcm")};
    EXPECT_TRUE(Holds(ErrorOf([&] { PrepareReplay(setup_); }), "is an input")) << run_dir;
    setup_.outputs = {Path("a"), Path("./a")};
    EXPECT_TRUE(Holds(ErrorOf([&] { PrepareReplay(setup_); }), "twice")) << run_dir;
  }
  EXPECT_EQ(TextOf("in.lcm"), "events");
}

TEST_F(ReplayCases, AssignmentsNeedNoProcessWhereOneAloneHasTheKey) {
  setup_.run_dir = Path("run");
  setup_.overrides = {"output.chunk_frames=3", "human-tracker:tracking.nothing=1"};
  EXPECT_TRUE(Holds(ErrorOf([&] { PrepareReplay(setup_); }), "tracking.nothing"));
  setup_.overrides = {"output.chunk_frames=3"};
  PrepareReplay(setup_);
  EXPECT_TRUE(Holds(TextOf("run/map_recorder.yaml"), "output.chunk_frames: 3\n"));
  setup_.overrides = {"output.chunk_frame=3"};
  EXPECT_TRUE(Holds(ErrorOf([&] { PrepareReplay(setup_); }), "did you mean 'output.chunk_frames'"));
  setup_.overrides = {"optimzer:people.mode=on"};
  EXPECT_TRUE(Holds(ErrorOf([&] { PrepareReplay(setup_); }), "did you mean 'optimizer'"));
  setup_.overrides = {"stereo_player:image.max_image_bytes=3000"};
  EXPECT_TRUE(Holds(ErrorOf([&] { PrepareReplay(setup_); }), "not part of a replay"));
}

TEST_F(ReplayCases, OneFileOfAConfigurationIsKnownByItsName) {
  fs::copy(setup_.config_dir + "/map_recorder.yaml", Path("map_recorder.yaml"));
  SetConfig(Path("map_recorder.yaml"), &setup_);
  setup_.run_dir = Path("run");
  EXPECT_EQ(MakeReplayNodes(setup_).size(), 4u);
  Write("mine.yaml", "");
  EXPECT_TRUE(Holds(ErrorOf([&] { SetConfig(Path("mine.yaml"), &setup_); }),
                    "which process it belongs to"));
}

}  // namespace
}  // namespace airdos
