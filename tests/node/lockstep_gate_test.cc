#include "processes/stereo_player/lockstep_gate.h"

#include <gtest/gtest.h>

#include <string>

namespace airdos {
namespace {

constexpr std::int64_t kSession = 5;

process_status_t Status(const std::string& process, std::int64_t pid,
                        std::int8_t state = process_status_t::STATE_READY) {
  process_status_t status = {};
  status.process = process;
  status.pid = pid;
  status.state = state;
  return status;
}

/// As Status(); there is a frame, but not all of its inputs.
process_status_t Waiting(const std::string& process, std::int64_t pid) {
  process_status_t status = Status(process, pid);
  status.waiting_for = "CAMERA_RIGHT";
  return status;
}

frame_done_t Done(const std::string& process, std::int64_t seq, std::int64_t session = kSession) {
  frame_done_t done = {};
  done.process = process;
  done.seq = seq;
  done.session = session;
  return done;
}

LockstepGateOptions TwoProcesses() {
  LockstepGateOptions options;
  options.wait_for = {"a", "b"};
  options.frames_in_flight = 2;
  return options;
}

std::string Notes(LockstepGate* gate) {
  std::string text;
  for (const std::string& note : gate->TakeNotes()) text += note + "\n";
  return text;
}

/// Both are ready; frames 0 and 1 are published.
LockstepGate FullGate() {
  LockstepGate gate(TwoProcesses(), 0);
  gate.OnStatus(Status("a", 1), 0);
  gate.OnStatus(Status("b", 2), 0);
  gate.OnPublished(kSession, 0, 0);
  gate.OnPublished(kSession, 1, 0);
  return gate;
}

TEST(LockstepGateTest, WaitsForNobodyIfTold) {
  LockstepGate gate(LockstepGateOptions(), 0);
  EXPECT_TRUE(gate.MayPublish(0));
  gate.OnPublished(kSession, 0, 0);
  EXPECT_TRUE(gate.IsAllDone(0));
}

TEST(LockstepGateTest, StartsWhenAllAreReady) {
  LockstepGate gate(TwoProcesses(), 0);
  gate.OnStatus(Status("a", 1), 0);
  gate.OnStatus(Status("b", 2, process_status_t::STATE_STARTING), 0);
  gate.OnStatus(Status("somebody else", 3), 0);
  EXPECT_FALSE(gate.MayPublish(0));
  gate.OnStatus(Status("b", 2), 0);
  EXPECT_TRUE(gate.MayPublish(0));
  EXPECT_FALSE(gate.TakeNewcomer()) << "nothing was published that it could have missed";
}

TEST(LockstepGateTest, KeepsFramesInFlightByTheSlowest) {
  LockstepGate gate = FullGate();
  EXPECT_FALSE(gate.MayPublish(0));
  gate.OnFrameDone(Done("a", 0), 0);
  EXPECT_FALSE(gate.MayPublish(0)) << "b has both still to do";
  gate.OnFrameDone(Done("b", 0, kSession + 1), 0);
  EXPECT_FALSE(gate.MayPublish(0)) << "of another session";
  gate.OnFrameDone(Done("b", 0), 0);
  EXPECT_TRUE(gate.MayPublish(0));
  gate.OnPublished(kSession, 2, 0);
  EXPECT_FALSE(gate.MayPublish(0));
}

TEST(LockstepGateTest, ALaterFrameDoneStandsForThoseBefore) {
  LockstepGate gate = FullGate();
  gate.OnFrameDone(Done("a", 1), 0);
  gate.OnFrameDone(Done("b", 1), 0);
  EXPECT_TRUE(gate.IsAllDone(0));
  gate.OnFrameDone(Done("b", 1), 0);  // once more
  EXPECT_TRUE(gate.IsAllDone(0));
}

TEST(LockstepGateTest, GoesOnAfterARestartAndAsksForTheCalibration) {
  LockstepGate gate = FullGate();
  gate.OnFrameDone(Done("a", 1), 0);
  EXPECT_FALSE(gate.MayPublish(1));
  gate.OnStatus(Status("b", 77), 1);
  EXPECT_TRUE(gate.MayPublish(1));
  EXPECT_EQ(Notes(&gate),
            "b was restarted (process 2, now 77): continuing, it missed 2 frames at least\n");
  EXPECT_TRUE(gate.TakeNewcomer());
  EXPECT_FALSE(gate.TakeNewcomer());
}

TEST(LockstepGateTest, NamesTheOneThatStallsAndGivesUpTheOneThatIsSilent) {
  LockstepGate gate = FullGate();
  gate.OnFrameDone(Done("a", 1), 1);
  EXPECT_FALSE(gate.MayPublish(4.9));
  EXPECT_EQ(Notes(&gate), "");
  EXPECT_FALSE(gate.MayPublish(5.1));
  EXPECT_EQ(Notes(&gate), "waiting for b to finish a frame, 2 in flight\n");
  gate.OnStatus(Status("a", 1), 9);
  EXPECT_TRUE(gate.MayPublish(10.1));
  EXPECT_EQ(Notes(&gate), "b is silent for 10 s: continuing without it\n");
  gate.OnStatus(Status("b", 3), 11);
  EXPECT_EQ(Notes(&gate), "b is there (process 3)\n");
  gate.OnPublished(kSession, 2, 11);
  gate.OnPublished(kSession, 3, 11);
  EXPECT_FALSE(gate.MayPublish(11)) << "it counts again";
}

TEST(LockstepGateTest, GivesUpOneThatLivesButFinishesNothing) {
  LockstepGate gate = FullGate();
  gate.OnFrameDone(Done("a", 1), 0);
  double now_s = 0;
  for (; now_s < 59; now_s += 1) {
    gate.OnStatus(Status("a", 1), now_s);
    gate.OnStatus(Waiting("b", 2), now_s);
    EXPECT_FALSE(gate.MayPublish(now_s));
  }
  gate.OnStatus(Status("a", 1), 61);
  gate.OnStatus(Waiting("b", 2), 61);
  EXPECT_TRUE(gate.MayPublish(61));
  EXPECT_NE(Notes(&gate).find("b has finished no frame for 60 s: continuing without it"),
            std::string::npos);
}

TEST(LockstepGateTest, GoesOnWhenAllThatIsInFlightWasLostOnTheWay) {
  LockstepGate gate = FullGate();
  gate.OnFrameDone(Done("a", 1), 0);
  for (double now_s = 1; now_s < 10; now_s += 1) {
    gate.OnStatus(Status("a", 1), now_s);
    gate.OnStatus(Status("b", 2), now_s);
    EXPECT_FALSE(gate.MayPublish(now_s)) << "it may still get them";
  }
  EXPECT_TRUE(gate.MayPublish(10.5));
  EXPECT_NE(
      Notes(&gate).find(
          "b has had no frame to process for 10 s: the 2 in transit to it are lost, continuing"),
      std::string::npos);
  gate.OnPublished(kSession, 2, 11);
  gate.OnPublished(kSession, 3, 11);
  EXPECT_FALSE(gate.MayPublish(11)) << "it still counts";
}

TEST(LockstepGateTest, AsksForTheCalibrationForAProcessThatNobodyWaitsFor) {
  LockstepGate gate(TwoProcesses(), 0);
  gate.OnStatus(Status("c", 5), 0);
  gate.OnPublished(kSession, 0, 0);
  gate.OnStatus(Status("c", 5), 1);
  EXPECT_FALSE(gate.TakeNewcomer()) << "it has heard everything";
  gate.OnStatus(Status("c", 6, process_status_t::STATE_STOPPING), 2);
  EXPECT_FALSE(gate.TakeNewcomer());
  gate.OnStatus(Status("c", 7), 3);
  EXPECT_TRUE(gate.TakeNewcomer());
  gate.OnStatus(Status("c", 7), 4);
  EXPECT_FALSE(gate.TakeNewcomer());
}

TEST(LockstepGateTest, GivesUpOneThatNeverStarts) {
  LockstepGate gate(TwoProcesses(), 100);
  gate.OnStatus(Status("a", 1), 100);
  EXPECT_FALSE(gate.MayPublish(106));
  EXPECT_EQ(Notes(&gate), "waiting for b to report READY\n");
  gate.OnStatus(Status("a", 1), 160);
  EXPECT_TRUE(gate.MayPublish(161));
}

TEST(LockstepGateTest, GivesUpOneThatStopsAtOnce) {
  LockstepGate gate = FullGate();
  gate.OnFrameDone(Done("a", 1), 1);
  gate.OnStatus(Status("b", 99, process_status_t::STATE_STOPPING), 1);
  EXPECT_FALSE(gate.MayPublish(1)) << "another process of that name";
  gate.OnStatus(Status("b", 2, process_status_t::STATE_STOPPING), 1);
  EXPECT_TRUE(gate.MayPublish(1));
}

// In realtime pace nobody asks whether the next frame may be published.
TEST(LockstepGateTest, FramesOfAProcessThatFinishesNoneAreNotRememberedForEver) {
  LockstepGate gate(TwoProcesses(), 0);
  gate.OnStatus(Status("a", 1), 0);
  for (std::int64_t seq = 0; seq < 3000; ++seq) gate.OnPublished(kSession, seq, 0);
  EXPECT_EQ(gate.num_remembered(), LockstepGate::kMaxInFlight);
  gate.OnFrameDone(Done("a", 2999), 0);
  EXPECT_TRUE(gate.IsAllDone(0) || !gate.MayPublish(0)) << "b is still absent";
}

TEST(LockstepGateTest, WhoIsRestartedForEverIsNotNotedForEver) {
  LockstepGate gate(TwoProcesses(), 0);
  int num_notes = 0;
  std::string last;
  for (std::int64_t pid = 0; pid < 3000; ++pid) {
    gate.OnStatus(Status("a", pid), 0);
    for (const std::string& note : gate.TakeNotes()) {
      ++num_notes;
      last = note;
    }
  }
  EXPECT_EQ(num_notes, LockstepGate::kMaxNotes);
  EXPECT_NE(last.find("no more messages will follow"), std::string::npos) << last;
}

}  // namespace
}  // namespace airdos
