#include "processes/tools/simulate/simulated_log.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "airdos/human_observations_t.hpp"
#include "airdos/pose_t.hpp"
#include "airdos/state_estimate_t.hpp"
#include "airdos/static_features_t.hpp"
#include "common/simulation/settings.h"
#include "processes/node/log/event_log.h"
#include "processes/node/message/channels.h"
#include "processes/node/message/codec.h"
#include "processes/node/message/conversions.h"
#include "processes/node/message/validate.h"
#include "processes/tools/replay/replay_setup.h"

namespace airdos {
namespace {

TEST(SimulatedLogTest, EveryMessageIsValidAndEveryFrameComplete) {
  for (const char* setting : {"group1", "walkers8"}) {
    const SimulatedSequence sequence = Simulate(SettingByName(setting, 4));
    const auto frames = SimulatedMessages(sequence, 7);
    ASSERT_EQ(frames.size(), sequence.frames.size());
    int num_calibrations = 0;
    for (std::size_t k = 0; k < frames.size(); ++k) {
      int num_features = 0, num_humans = 0, num_truths = 0;
      for (const Envelope& envelope : frames[k]) {
        const auto* data = envelope.payload.data();
        const std::size_t size = envelope.payload.size();
        if (envelope.channel == channel::kCalibration) ++num_calibrations;
        if (envelope.channel == channel::kStaticFeatures) {
          static_features_t message = {};
          ASSERT_TRUE(Decode(data, size, &message));
          EXPECT_EQ(Validate(message), "");
          EXPECT_EQ(message.seq, static_cast<std::int64_t>(k));
          EXPECT_EQ(message.num_features, sequence.options.static_per_frame);
          ++num_features;
        } else if (envelope.channel == channel::kHumanObservations) {
          human_observations_t message = {};
          ASSERT_TRUE(Decode(data, size, &message));
          EXPECT_EQ(Validate(message), "");
          ++num_humans;
        } else if (envelope.channel == channel::kGroundTruth) {
          pose_t message = {};
          ASSERT_TRUE(Decode(data, size, &message));
          EXPECT_LT(Boxminus(ToSe3(message.position, message.orientation), sequence.frames[k].T_W_C)
                        .norm(),
                    1e-9);
          ++num_truths;
        }
      }
      EXPECT_EQ(num_features, 1);
      EXPECT_EQ(num_humans, 1);
      EXPECT_EQ(num_truths, 1);
    }
    const double duration_s = sequence.frames.back().time_s;
    EXPECT_EQ(num_calibrations, 1 + static_cast<int>(duration_s + 1e-6)) << setting;
  }
}

TEST(SimulatedLogTest, TheOptimizerRunsOnIt) {
  const std::string folder = testing::TempDir() + "airdos_simulated_log/";
  std::filesystem::create_directories(folder);
  SimulationOptions simulation = SettingByName("walkers30", 5);
  simulation.num_frames = 15;
  const SimulatedSequence sequence = Simulate(simulation);
  WriteSimulatedLog(sequence, folder + "simulated.lcm");

  ReplaySetup setup;
  setup.config_dir = AIRDOS_SOURCE_DIR "/launch_scripts/config";
  setup.run_dir = folder + "run";
  setup.people = "on";
  setup.from_features = true;
  std::string first_digests;
  for (const bool is_first : {true, false}) {
    const auto source = OpenFrameSource(folder + "simulated.lcm", 0, 1000, LogInputs::kFeatures);
    ReplayOptions options;
    options.out_path = folder + "out.lcm";
    const ReplayResult result = Replay(source.get(), MakeReplayNodes(setup), options);
    EXPECT_EQ(result.num_frames, simulation.num_frames);
    EXPECT_EQ(result.num_posed, simulation.num_frames);
    EXPECT_TRUE(result.remarks.empty()) << result.remarks.front();
    if (is_first) first_digests = FormatDigests(result.digests);
    EXPECT_EQ(FormatDigests(result.digests), first_digests);
  }
  EventLogReader log(folder + "out.lcm");
  int num_estimates = 0;
  while (const std::optional<LogEvent> event = log.Next()) {
    if (event->channel != channel::kStateEstimate) continue;
    state_estimate_t estimate{};
    ASSERT_TRUE(Decode(event->payload.data(), event->payload.size(), &estimate));
    const Se3 T_W_C = ToSe3(estimate.position_W_C, estimate.orientation_W_C);
    const SimulatedFrame& frame = sequence.frames[static_cast<std::size_t>(estimate.seq)];
    // The start values stray by 5 cm per axis and frame; 1 px of noise leaves a few cm.
    EXPECT_LT((T_W_C.translation - frame.T_W_C.translation).norm(), 0.15) << estimate.seq;
    EXPECT_GT(estimate.num_people + (estimate.seq < 3 ? 1 : 0), 0);
    ++num_estimates;
  }
  EXPECT_EQ(num_estimates, simulation.num_frames);
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace airdos
