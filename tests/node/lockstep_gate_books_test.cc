// The player's gate over minutes of steady work, on a virtual clock: who is waited for, how long,
// and when it goes on.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <deque>
#include <string>
#include <vector>

#include "processes/stereo_player/lockstep_gate.h"

namespace airdos {
namespace {

constexpr std::int64_t kSession = 5;
constexpr std::int64_t kStep_ms = 10;

/// A process that takes `ms_per_frame` for each frame, in order, and says STATUS once a second.
struct Worker {
  std::string name;
  std::int64_t ms_per_frame;
  bool says_stalled = false;  // STATUS while it works for more than a second
  std::deque<std::int64_t> to_do{};
  std::int64_t done_at_ms = 0;
  std::int64_t num_done = 0;
  std::int64_t most_to_do = 0;
};

/// Gate, player and processes. Everything happens at whole hundredths of a second.
class Line {
 public:
  explicit Line(std::vector<Worker> workers, int frames_in_flight = 4)
      : workers_(std::move(workers)), gate_(Options(workers_, frames_in_flight), 0) {}

  /// Lets time go on; the player publishes whenever it may.
  void RunTo(std::int64_t end_ms, bool publishes = true) {
    for (; now_ms_ < end_ms; now_ms_ += kStep_ms) {
      const double now_s = 1e-3 * static_cast<double>(now_ms_);
      for (Worker& worker : workers_) Work(&worker, now_s);
      // Bounded: a gate that never closes must not take all memory.
      for (int i = 0; i < 20 && publishes && gate_.MayPublish(now_s); ++i) Publish(now_s);
      if (!publishes) static_cast<void>(gate_.MayPublish(now_s));
      for (const std::string& note : gate_.TakeNotes())
        notes_ += std::to_string(now_ms_) + ": " + note + "\n";
    }
  }
  bool IsAllDone() { return gate_.IsAllDone(1e-3 * static_cast<double>(now_ms_)); }

  std::int64_t num_published() const { return num_published_; }
  const std::string& notes() const { return notes_; }
  const Worker& worker(std::size_t i) const { return workers_[i]; }
  LockstepGate* gate() { return &gate_; }

 private:
  static LockstepGateOptions Options(const std::vector<Worker>& workers, int frames_in_flight) {
    LockstepGateOptions options;
    options.frames_in_flight = frames_in_flight;
    for (const Worker& worker : workers) options.wait_for.push_back(worker.name);
    return options;
  }
  void Work(Worker* worker, double now_s) {
    if (!worker->to_do.empty() && now_ms_ >= worker->done_at_ms) {
      frame_done_t done = {};
      done.process = worker->name;
      done.session = kSession;
      done.seq = worker->to_do.front();
      worker->to_do.pop_front();
      worker->done_at_ms = now_ms_ + worker->ms_per_frame;
      ++worker->num_done;
      gate_.OnFrameDone(done, now_s);
    }
    if (now_ms_ % 1000 != 0) return;
    process_status_t status = {};
    status.process = worker->name;
    status.pid = 1;
    status.state = worker->says_stalled && !worker->to_do.empty() ? process_status_t::STATE_STALLED
                                                                  : process_status_t::STATE_READY;
    gate_.OnStatus(status, now_s);
  }
  void Publish(double now_s) {
    for (Worker& worker : workers_) {
      if (worker.to_do.empty()) worker.done_at_ms = now_ms_ + worker.ms_per_frame;
      worker.to_do.push_back(num_published_);
      worker.most_to_do =
          std::max(worker.most_to_do, static_cast<std::int64_t>(worker.to_do.size()));
    }
    gate_.OnPublished(kSession, num_published_++, now_s);
  }

  std::vector<Worker> workers_;
  LockstepGate gate_;
  std::int64_t now_ms_ = 0;
  std::int64_t num_published_ = 0;
  std::string notes_;
};

// The slowest one makes four frames a second: four at the start, and then one for each that it
// does.
TEST(LockstepGateBooksTest, AMinuteGoesAtThePaceOfTheSlowest) {
  Line line({{"fast", 100}, {"slow", 250}});
  line.RunTo(60000);
  EXPECT_EQ(line.num_published(), 4 + 239);  // done at 250, 500, … 59750 ms
  EXPECT_EQ(line.worker(1).num_done, 239);
  EXPECT_EQ(line.worker(1).most_to_do, 4);
  EXPECT_EQ(line.worker(1).to_do.size(), 4u) << "there is always work";
  EXPECT_EQ(line.gate()->num_remembered(), 4u);
  EXPECT_FALSE(line.IsAllDone());
  line.RunTo(60750, false);
  EXPECT_FALSE(line.IsAllDone()) << "the last one is done at 60750 ms";
  line.RunTo(60760, false);
  EXPECT_TRUE(line.IsAllDone());
  EXPECT_EQ(line.notes(), "");
}

TEST(LockstepGateBooksTest, OneFrameInFlightIsOneAfterTheOther) {
  Line line({{"a", 300}}, 1);
  line.RunTo(60000);
  EXPECT_EQ(line.worker(0).most_to_do, 1);
  EXPECT_EQ(line.num_published(), 1 + 199);
}

// Twenty seconds a frame: longer than the silence and than an idle process is waited for, but it
// says STATUS, and that it works.
TEST(LockstepGateBooksTest, OneThatWorksLongIsWaitedForAndNamedEveryFiveSeconds) {
  Line line({{"slow", 20000, true}}, 2);
  line.RunTo(65000);
  EXPECT_EQ(line.num_published(), 2 + 3);
  std::string expected;
  for (const int second : {5, 10, 15, 25, 30, 35, 45, 50, 55}) {
    expected +=
        std::to_string(1000 * second) + ": waiting for slow to finish a frame, 2 in flight\n";
  }
  EXPECT_EQ(line.notes(), expected);
}

// A pause of the player is no fault of the processes.
TEST(LockstepGateBooksTest, WhoHasNothingToDoIsNotGivenUp) {
  Line line({{"a", 100}});
  line.RunTo(1000);
  const std::int64_t num_before = line.num_published();
  line.RunTo(200000, false);
  EXPECT_EQ(line.notes(), "");
  EXPECT_TRUE(line.IsAllDone());
  line.RunTo(201000);
  EXPECT_EQ(line.worker(0).most_to_do, 4) << "it is waited for as before";
  EXPECT_EQ(line.num_published(), num_before + 4 + 9);
}

// In realtime pace the player does not ask: frames that come all the time are no progress.
TEST(LockstepGateBooksTest, PublishingIsNoProgress) {
  LockstepGateOptions options;
  options.wait_for = {"a"};
  LockstepGate gate(options, 0);
  process_status_t status = {};
  status.process = "a";
  status.pid = 1;
  status.state = process_status_t::STATE_READY;
  status.waiting_for = "CAMERA_RIGHT";
  for (std::int64_t tenth = 0; tenth <= 600; ++tenth) {
    const double now_s = 0.1 * static_cast<double>(tenth);
    if (tenth % 10 == 0) gate.OnStatus(status, now_s);
    gate.OnPublished(kSession, tenth, now_s);
  }
  EXPECT_FALSE(gate.IsAllDone(60));
  EXPECT_TRUE(gate.IsAllDone(60.1));
  const std::vector<std::string> notes = gate.TakeNotes();
  ASSERT_FALSE(notes.empty());
  EXPECT_EQ(notes.back(), "a has finished no frame for 60 s: continuing without it");
}

TEST(LockstepGateBooksTest, WhoCameBeforeTheFirstFrameMissedNothing) {
  LockstepGate gate(LockstepGateOptions(), 0);
  process_status_t status = {};
  status.process = "viewer";
  status.state = process_status_t::STATE_READY;
  for (const std::int64_t pid : {1, 2}) {
    status.pid = pid;
    gate.OnStatus(status, 0);
  }
  EXPECT_FALSE(gate.TakeNewcomer());
  gate.OnPublished(kSession, 0, 1);
  status.pid = 3;
  gate.OnStatus(status, 2);
  EXPECT_TRUE(gate.TakeNewcomer());
}

}  // namespace
}  // namespace airdos
