#include <algorithm>
#include <cstdio>
#include <map>
#include <random>
#include <set>
#include <utility>

#include "airdos/stereo_calibration_t.hpp"
#include "processes/node/message/codec.h"
#include "tests/support/fault_fixture.h"

// What the chain makes of bad input: the sample log, spoiled, played into the real processes. Each
// test says what is lost. Where nothing waits for a deadline the processes still say, byte for
// byte, what airdos-replay makes of the same spoiled log.

namespace airdos {
namespace {

constexpr std::int64_t kLast = 19;
// An undisturbed run of the excerpt is off by at most 0.10 m, not aligned and as each frame was the
// newest.
constexpr double kGood_m = 0.15;

bool IsOf(const LogEvent& event, const std::set<std::string>& channels) {
  return channels.count(event.channel) > 0;
}

class FaultInputTest : public FaultTest {
 protected:
  /// Plays the events in lock-step; the processes wait for each input as long as it takes.
  void Play(const std::vector<LogEvent>& events, const std::string& deadline_s = "200") {
    chain_->SetNodeArguments({"--deadline-s", deadline_s});
    ASSERT_NO_FATAL_FAILURE(chain_->StartNodes());
    chain_->StartPlayer(Write(events));
    HearTheEnd(SeqOf(events.back()), session_of_last_);
    StopAndHear();
  }
  void ExpectWhatReplaySays(const std::string& log) {
    EXPECT_EQ(listener_->digests(), ReplayDigests(log, folder_));
  }
  void ExpectAnEstimateOfEachFrame() {
    EXPECT_EQ(listener_->states().size(), static_cast<std::size_t>(kLast + 1));
    EXPECT_EQ(listener_->num_messages(channel::kStateEstimate), kLast + 1);
  }
  /// The excerpt without some messages of these channels; `is_lost` sees the image number.
  template <class IsLost>
  std::vector<LogEvent> Without(const std::set<std::string>& channels, std::int64_t last,
                                IsLost is_lost) {
    std::vector<LogEvent> kept;
    for (LogEvent& event : SampleEvents(0, last)) {
      if (!IsOf(event, channels) || !is_lost(SeqOf(event))) kept.push_back(std::move(event));
    }
    return kept;
  }

  std::int64_t session_of_last_ = kSession;
};

class DroppedImagesTest : public FaultInputTest, public testing::WithParamInterface<int> {};

// Images dropped, left and right apart, 1, 5 and 20 % of them. Lost: the static features of a frame
// that lacks its left image (it is carried by the motion before and by people), new landmarks of
// one that lacks its right image. Not lost: the frame's pose, the map, W; every image is counted.
TEST_P(DroppedImagesTest, EachIsCountedAndTheFrameIsCarried) {
  std::mt19937_64 random(17);
  std::set<std::pair<std::string, std::int64_t>> dropped;
  const std::size_t num_dropped = std::max<std::size_t>(1, 2 * kLast * GetParam() / 100);
  while (dropped.size() < num_dropped) {
    const bool is_left = random() % 2 == 0;
    const auto seq = static_cast<std::int64_t>(2 + random() % (kLast - 3));
    dropped.insert({is_left ? channel::kCameraLeft : channel::kCameraRight, seq});
  }
  std::vector<LogEvent> events;
  for (LogEvent& event : SampleEvents(0, kLast)) {
    if (dropped.count({event.channel, SeqOf(event)}) == 0) events.push_back(std::move(event));
  }
  ASSERT_NO_FATAL_FAILURE(Play(events));
  ExpectAnEstimateOfEachFrame();
  for (const std::string program : {"airdos-frontend", "airdos-human-tracker"}) {
    const std::int64_t num_missing = Counters(program, channel::kCameraLeft).num_missing +
                                     Counters(program, channel::kCameraRight).num_missing;
    EXPECT_EQ(num_missing, static_cast<std::int64_t>(dropped.size())) << program;
  }
  std::printf("%d images dropped: error at the end %.3f m\n", static_cast<int>(num_dropped),
              Error_m(kLast));
  EXPECT_LT(Error_m(kLast), GetParam() <= 5 ? kGood_m : 0.3);
  ExpectWhatReplaySays(folder_ + "input.lcm");
}
INSTANTIATE_TEST_SUITE_P(Percent, DroppedImagesTest, testing::Values(1, 5, 20));

// Every message comes twice. Lost: nothing; counted as duplicates.
TEST_F(FaultInputTest, DuplicatedMessagesChangeNothing) {
  std::vector<LogEvent> twice;
  for (const LogEvent& event : SampleEvents(0, kLast)) {
    twice.push_back(event);
    twice.push_back(event);
  }
  ASSERT_NO_FATAL_FAILURE(Play(twice));
  EXPECT_EQ(Counters("airdos-frontend", channel::kCameraLeft).num_duplicate, kLast + 1);
  WriteEvents(SampleEvents(0, kLast), folder_ + "undisturbed.lcm");
  ExpectWhatReplaySays(folder_ + "undisturbed.lcm");
}

// The left images of frames 8 and 9 change places. Lost: the image that was overtaken (8), as a
// channel keeps its order; it is counted as missing and, when it comes, as a duplicate.
TEST_F(FaultInputTest, OfImagesOutOfOrderTheOvertakenOneIsLost) {
  std::vector<LogEvent> events = SampleEvents(0, kLast);
  LogEvent* eighth = nullptr;
  for (LogEvent& event : events) {
    if (event.channel != channel::kCameraLeft) continue;
    if (SeqOf(event) == 8) eighth = &event;
    if (SeqOf(event) == 9) std::swap(eighth->payload, event.payload);
  }
  ASSERT_NO_FATAL_FAILURE(Play(events));
  ExpectAnEstimateOfEachFrame();
  const channel_status_t counters = Counters("airdos-frontend", channel::kCameraLeft);
  EXPECT_EQ(counters.num_missing, 1);
  EXPECT_EQ(counters.num_duplicate, 1);
  EXPECT_LT(Error_m(kLast), kGood_m);
  ExpectWhatReplaySays(folder_ + "input.lcm");
}

// Somebody else says thousands of broken messages on the camera's channels meanwhile. Lost:
// nothing; each of them is rejected and counted.
TEST_F(FaultInputTest, NonsenseInBetweenIsRejectedAndChangesNothing) {
  constexpr std::size_t kMostNonsense = 20000;
  const std::vector<LogEvent> events = SampleEvents(0, kLast);
  chain_->SetNodeArguments({"--deadline-s", "200"});
  ASSERT_NO_FATAL_FAILURE(chain_->StartNodes());
  chain_->StartPlayer(Write(events));
  LcmTransport hostile(kUrl);
  std::map<std::string, std::int64_t> num_said;
  std::size_t next = 0;
  const auto say_nonsense = [&] {
    if (next >= kMostNonsense) return false;
    const LogEvent& whole = events[next++ % events.size()];
    const std::size_t broken_size = std::min<std::size_t>(1000, whole.payload.size() - 1);
    ++num_said[whole.channel];
    return !hostile.Publish(whole.channel, whole.payload.data(), broken_size);
  };
  const BusListener::FrameKey last = {kSession, kLast};
  EXPECT_TRUE(listener_->HearUntil(
      [&] { return say_nonsense() || listener_->IsDone("airdos-map-recorder", last); },
      LiveChain::kRun_s))
      << chain_->AllErrors();
  StopAndHear();
  ExpectWhatReplaySays(folder_ + "input.lcm");
  for (const std::string channel : {channel::kCameraLeft, channel::kCameraRight}) {
    for (const std::string program : {"airdos-frontend", "airdos-human-tracker"}) {
      const std::int64_t num_rejected = Counters(program, channel).num_rejected;
      EXPECT_GT(num_rejected, 0) << program;
      EXPECT_LE(num_rejected, num_said[channel]) << program << ": whole messages were rejected";
    }
  }
}

// The right camera is silent for 2 s (20 frames). Lost: new landmarks; the known ones are tracked
// in the left image, and the camera is off by what they and people do not tell. Not lost: W, as
// long as the view still holds something of before. The first frame waits for the deadline, the
// others do not; it is said which channel is silent.
TEST_F(FaultInputTest, ACameraSilentForTwoSecondsIsNamedAndTheChainGoesOn) {
  constexpr std::int64_t kEnd = 32;
  const auto events =
      Without({channel::kCameraRight}, kEnd, [](std::int64_t seq) { return seq >= 8 && seq < 28; });
  ASSERT_NO_FATAL_FAILURE(Play(events, "3"));
  EXPECT_EQ(listener_->states().size(), static_cast<std::size_t>(kEnd + 1));
  EXPECT_NE(chain_->Errors("airdos-frontend").find("nothing on CAMERA_RIGHT"), std::string::npos)
      << chain_->Errors("airdos-frontend");
  EXPECT_GE(Counters("airdos-frontend", channel::kCameraRight).num_missing, 20);
  EXPECT_LT(WorstError_m(0, 7), kGood_m);
  std::printf("worst while silent: %.3f m, after it: %.3f m\n", WorstError_m(8, 27), Error_m(kEnd));
  EXPECT_LT(WorstError_m(8, kEnd), 1.0);  // tracked in the left image: 0.39; not at all: 2.1
  EXPECT_LT(Error_m(kEnd), 0.3);
}

class SilentDetectorTest : public FaultInputTest,
                           public testing::WithParamInterface<std::vector<std::string>> {};

// A detector dies at frame 6. Lost: people from there on (keypoints); with the masks gone the
// keypoints mark where people are. Not lost: the camera's pose. It is said once which channel is
// silent; only the first frame waits for it.
TEST_P(SilentDetectorTest, TheChainGoesOnWithoutItAndSaysSo) {
  const std::vector<std::string>& silent = GetParam();
  const auto events =
      Without({silent.begin(), silent.end()}, kLast, [](std::int64_t seq) { return seq >= 6; });
  ASSERT_NO_FATAL_FAILURE(Play(events, "3"));
  ExpectAnEstimateOfEachFrame();
  for (const std::string& name : silent) {
    EXPECT_NE(chain_->AllErrors().find("nothing on " + silent.front()), std::string::npos) << name;
  }
  const bool has_keypoints = silent.front() == channel::kPersonMask;
  EXPECT_GT(listener_->num_people({kSession, 5}), 0);
  EXPECT_EQ(listener_->num_people({kSession, kLast}) > 0, has_keypoints);
  EXPECT_LT(Error_m(kLast), 0.15);
}
INSTANTIATE_TEST_SUITE_P(Channels, SilentDetectorTest,
                         testing::Values(std::vector<std::string>{channel::kPersonKeypointsLeft,
                                                                  channel::kPersonKeypointsRight},
                                         std::vector<std::string>{channel::kPersonMask}),
                         [](const auto& instance) { return instance.param.front(); });

// Nobody ever publishes people, as with a driver that forgets to. Lost: people. The first frame
// waits for them, and this is said once of each channel; the others go on without.
TEST_F(FaultInputTest, WithADetectorThatNeverSpokeTheChainGoesOnAndSaysSo) {
  const auto events =
      Without({channel::kPersonKeypointsLeft, channel::kPersonKeypointsRight, channel::kPersonMask},
              kLast, [](std::int64_t) { return true; });
  ASSERT_NO_FATAL_FAILURE(Play(events, "3"));
  ExpectAnEstimateOfEachFrame();
  EXPECT_LT(Error_m(kLast), 0.15);
  for (const std::string program : {"airdos-frontend", "airdos-human-tracker"}) {
    const std::string said = chain_->Errors(program);
    const std::size_t place = said.find("nothing on PERSON_");
    ASSERT_NE(place, std::string::npos) << said;
    EXPECT_EQ(said.find("nothing on PERSON_", place + 1), std::string::npos) << "once: " << said;
  }
}

// People are switched off. Nobody waits for what nobody publishes, and the human tracker need not
// run.
TEST_F(FaultInputTest, WithPeopleOffTheHumanTrackerIsNotNeeded) {
  const auto events =
      Without({channel::kPersonKeypointsLeft, channel::kPersonKeypointsRight, channel::kPersonMask},
              kLast, [](std::int64_t) { return true; });
  chain_->SetNodeArguments({"--deadline-s", "200"});
  ASSERT_NO_FATAL_FAILURE(chain_->StartNode(
      "airdos-frontend", {"--set", "people.use=false", "--set", "masks.use=false"}));
  ASSERT_NO_FATAL_FAILURE(chain_->StartNode("airdos-optimizer", {"--set", "people.mode=off"}));
  ASSERT_NO_FATAL_FAILURE(chain_->StartNode("airdos-map-recorder"));
  chain_->StartPlayer(Write(events));
  HearTheEnd(kLast);
  StopAndHear();
  ExpectAnEstimateOfEachFrame();
  EXPECT_LT(Error_m(kLast), 0.15);
  for (const std::string program : {"airdos-frontend", "airdos-optimizer"}) {
    EXPECT_EQ(listener_->statuses().at(program).num_frames_incomplete, 0) << program;
  }
}

/// Where airdos-replay says that the camera is in each frame of a log.
std::vector<Eigen::Vector3d> ReplayedPositions(const std::string& log, const std::string& folder) {
  ReplayDigests(log, folder);
  std::vector<Eigen::Vector3d> positions;
  EventLogReader reader(folder + "replayed.lcm");
  for (auto event = reader.Next(); event; event = reader.Next()) {
    if (event->channel != channel::kStateEstimate) continue;
    state_estimate_t estimate = {};
    EXPECT_TRUE(Decode(event->payload.data(), event->payload.size(), &estimate));
    positions.emplace_back(Eigen::Map<const Eigen::Vector3d>(estimate.position_W_C));
  }
  return positions;
}

// A camera's clock may count from 1970, or from when it was switched on. Lost: a double of seconds
// since 1970 is exact to 0.24 us, in which whoever carries a camera moves by less than 1 um.
TEST_F(FaultInputTest, ItDoesNotMatterFromWhereTimesCount) {
  constexpr std::int64_t kNumImages = 10;
  constexpr std::int64_t kSince1970_us = 1795000000000000;
  constexpr double kRounding_m = 1e-6;
  const auto replay = [&](std::int64_t origin_us) {
    std::vector<LogEvent> events = SampleEvents(0, kNumImages - 1);
    for (LogEvent& event : events) SetUtime(UtimeOf(event) + origin_us, &event);
    return ReplayedPositions(Write(events), folder_);
  };
  const auto since_start = replay(0);
  const auto since_1970 = replay(kSince1970_us);
  ASSERT_EQ(since_start.size(), static_cast<std::size_t>(kNumImages));
  ASSERT_EQ(since_1970.size(), since_start.size());
  for (std::size_t i = 0; i < since_start.size(); ++i) {
    EXPECT_LT((since_1970[i] - since_start[i]).norm(), kRounding_m) << i;
  }
}

// The calibration comes with frame 3. Lost: nothing, the frames before wait for it.
TEST_F(FaultInputTest, FramesWaitForALateCalibration) {
  std::vector<LogEvent> events = SampleEvents(0, kLast);
  ASSERT_EQ(events.front().channel, channel::kCalibration);
  const LogEvent calibration = events.front();
  events.erase(events.begin());
  const auto place = std::find_if(events.begin(), events.end(),
                                  [](const LogEvent& event) { return SeqOf(event) == 3; });
  events.insert(place, calibration);
  ASSERT_NO_FATAL_FAILURE(Play(events));
  WriteEvents(SampleEvents(0, kLast), folder_ + "undisturbed.lcm");
  ExpectWhatReplaySays(folder_ + "undisturbed.lcm");
}

// From frame 10 on the calibration is another one. Lost: nothing; it is rejected, counted and said,
// and the first one holds until a new session begins.
TEST_F(FaultInputTest, ACalibrationThatChangesInMidRunIsRejected) {
  std::vector<LogEvent> events = SampleEvents(0, kLast);
  for (LogEvent& event : events) {
    if (event.channel != channel::kCalibration || SeqOf(event) == 0) continue;
    stereo_calibration_t calibration = {};
    ASSERT_TRUE(Decode(event.payload.data(), event.payload.size(), &calibration));
    calibration.fx_px += 20;
    event.payload = Encode(calibration);
  }
  ASSERT_NO_FATAL_FAILURE(Play(events));
  for (const std::string program :
       {"airdos-frontend", "airdos-human-tracker", "airdos-optimizer"}) {
    EXPECT_EQ(Counters(program, channel::kCalibration).num_rejected, 1) << program;
    EXPECT_NE(chain_->Errors(program).find("calibration changes within a session"),
              std::string::npos);
  }
  WriteEvents(SampleEvents(0, kLast), folder_ + "undisturbed.lcm");
  ExpectWhatReplaySays(folder_ + "undisturbed.lcm");
}

// The camera's clock jumps an hour on at frame 7 and two hours back at frame 13. Lost: nothing but
// the motion prior's sense of speed over the jump. Numbers, not times, say what belongs together.
TEST_F(FaultInputTest, AClockThatJumpsCostsNoFrame) {
  constexpr std::int64_t kHour_us = 3600000000;
  std::vector<LogEvent> events = SampleEvents(0, kLast);
  for (LogEvent& event : events) {
    const std::int64_t seq = SeqOf(event);
    const std::int64_t shift_us = seq < 7 ? 2 * kHour_us : seq < 13 ? 3 * kHour_us : kHour_us;
    SetUtime(UtimeOf(event) + shift_us, &event);
  }
  ASSERT_NO_FATAL_FAILURE(Play(events));
  ExpectAnEstimateOfEachFrame();
  EXPECT_LT(WorstError_m(0, kLast), 0.15);
  ExpectWhatReplaySays(folder_ + "input.lcm");
}

// The publisher is started again: image numbers begin at 0, in a new session. Lost: W and the map
// go on as new ones, as nobody knows what lies between; the map of before is closed and kept.
TEST_F(FaultInputTest, APublisherThatStartsAgainStartsANewMap) {
  std::vector<LogEvent> events = SampleEvents(0, 9);
  for (LogEvent event : SampleEvents(0, 9)) {
    SetSession(kSession + 1, &event);
    events.push_back(std::move(event));
  }
  session_of_last_ = kSession + 1;
  ASSERT_NO_FATAL_FAILURE(Play(events));
  EXPECT_EQ(listener_->states().size(), 20u);
  for (const std::int64_t session : {kSession, kSession + 1}) {
    EXPECT_EQ(listener_->states().at({session, 0}).status, +state_estimate_t::STATUS_FIRST_FRAME);
    EXPECT_LT(Error_m(9, session), kGood_m);
  }
  EXPECT_TRUE(std::filesystem::exists(folder_ + "map/session_2/trajectory.tum"));
  ExpectWhatReplaySays(folder_ + "input.lcm");
}

}  // namespace
}  // namespace airdos
