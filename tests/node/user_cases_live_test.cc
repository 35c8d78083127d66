#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "common/check/stereo_matches.h"
#include "common/map/map_export.h"
#include "processes/frontend/input_watch.h"
#include "processes/human_tracker/people_watch.h"
#include "processes/node/live/own_output.h"
#include "processes/node/partner_watch.h"
#include "processes/node/stray_watch.h"
#include "processes/optimizer/landmark_archive.h"
#include "processes/optimizer/optimizer_messages.h"
#include "processes/optimizer/optimizer_node.h"
#include "tests/node/fake_nodes.h"
#include "tests/node/frontend_walk.h"

// What users' own drivers and second plays of a log do to processes that run: they go on, and say
// in words what is wrong.

namespace airdos {
namespace {

bool HasWarning(const Node& node, const std::string& text) {
  return std::any_of(
      node.warnings().begin(), node.warnings().end(),
      [&](const std::string& warning) { return warning.find(text) != std::string::npos; });
}

std::string AllWarnings(const Node& node) {
  std::string all;
  for (const std::string& warning : node.warnings()) all += warning + "\n";
  return all;
}

// ---- Cameras that count from different numbers ----

image_t Renumbered(image_t image, std::int64_t by) {
  image.seq += by;
  return image;
}

/// Frames whose images are numbered so much higher on the left, or on the right, than all else.
std::vector<static_features_t> TrackRenumbered(std::int64_t left_by, std::int64_t right_by,
                                               FrontendNode* node) {
  constexpr int kNumFrames = 12;
  Send(channel::kCalibration, Calibration(), node);
  std::vector<static_features_t> output;
  const auto take = [&](std::vector<static_features_t> more) {
    output.insert(output.end(), more.begin(), more.end());
  };
  for (int k = 0; k < kNumFrames; ++k) {
    SendNobody(k, node);
    Send(channel::kPersonMask, NoMask(k), node);
    Send(channel::kCameraLeft, Renumbered(Left(k), left_by), node);
    Send(channel::kCameraRight, Renumbered(Right(k), right_by), node);
    take(StepAll(node));
  }
  while (node->CompleteOldest()) take(Take(node));  // the end of a log, or a deadline
  return output;
}

/// Times of the poses, in the order in which they came.
std::vector<std::int64_t> TimesOfPoses(const std::vector<static_features_t>& output) {
  std::vector<std::int64_t> utimes;
  for (const static_features_t& features : output) {
    EXPECT_EQ(Validate(features), "");
    if (features.tracking_state == static_features_t::STATE_INVALID) continue;
    utimes.push_back(features.utime);
  }
  return utimes;
}

TEST(UserCases, Case86cTheRightCameraCountsFromAnotherNumber) {
  FrontendNode node(WithoutFeedback());
  const std::vector<static_features_t> output = TrackRenumbered(0, 1000, &node);
  EXPECT_EQ(output.size(), 24u) << "one message for each frame that anything came of";
  const std::vector<std::int64_t> utimes = TimesOfPoses(output);
  EXPECT_EQ(utimes.size(), 12u) << "frames without a left image, at times that are over";
  EXPECT_TRUE(std::is_sorted(utimes.begin(), utimes.end()));
  EXPECT_TRUE(HasWarning(node,
                         "no right image came for 10 of 10 left images: CAMERA_RIGHT counts from "
                         "1000, the left images from 0; do both drivers count from the same "
                         "number?"))
      << AllWarnings(node);
}

TEST(UserCases, Case86cTheLeftCameraCountsFromAnotherNumber) {
  FrontendNode node(WithoutFeedback());
  const std::vector<static_features_t> output = TrackRenumbered(1000, 0, &node);
  const std::vector<std::int64_t> utimes = TimesOfPoses(output);
  EXPECT_EQ(utimes.size(), 12u) << "only those with their left image";
  EXPECT_TRUE(std::is_sorted(utimes.begin(), utimes.end()));
  EXPECT_EQ(output.front().tracking_state, +static_features_t::STATE_INVALID);
  EXPECT_TRUE(HasWarning(node, "CAMERA_RIGHT counts from 0, the left images from 1000"))
      << AllWarnings(node);
}

TEST(UserCases, Case86cAWatchedStreamWithoutFaultIsNotBlamed) {
  FrontendNode node(WithoutFeedback());
  const std::vector<static_features_t> output = TrackRenumbered(0, 0, &node);
  EXPECT_EQ(TimesOfPoses(output).size(), 12u);
  EXPECT_EQ(AllWarnings(node), "");
}

/// Both count, but one began some images later: the numbers agree, the times do not.
TEST(UserCases, Case86cTheRightCameraBeganLater) {
  PartnerWatch watch("CAMERA_RIGHT", "right image", false);
  StrayWatch left_numbers("CAMERA_LEFT", true);
  StrayWatch right_numbers("CAMERA_RIGHT", false);
  std::string said;
  for (std::int64_t seq = 0; seq < 10; ++seq) {
    const Header left = {100000 * seq, seq, 1};
    const Header right = {100000 * (seq + 5), seq, 1};
    left_numbers.AddNew(left);
    right_numbers.AddNew(right);
    said += watch.Add(left, right, left_numbers, right_numbers);
  }
  EXPECT_NE(said.find("CAMERA_RIGHT is 0.5 s away from the left image of the same number"),
            std::string::npos)
      << said;
}

TEST(UserCases, Case86cTheRightCameraHasASessionOfItsOwn) {
  PartnerWatch watch("CAMERA_RIGHT", "right image", false);
  StrayWatch left_numbers("CAMERA_LEFT", true);
  StrayWatch right_numbers("CAMERA_RIGHT", false);
  std::string said;
  for (std::int64_t seq = 0; seq < 200; ++seq) {
    left_numbers.AddNew({100000 * seq, seq, 1});
    right_numbers.AddNew({100000 * seq, seq, 2});
    said += watch.Add({100000 * seq, seq, 1}, std::nullopt, left_numbers, right_numbers);
  }
  EXPECT_EQ(said,
            "no right image came for 10 of 10 left images: CAMERA_RIGHT has session 2, the left "
            "images have session 1; both must have the same session")
      << "and once";
}

TEST(UserCases, Case86cADetectorThatIsNotThereIsNotBlamed) {
  PartnerWatch watch("PERSON_MASK", "person mask", true);
  StrayWatch left_numbers("CAMERA_LEFT", true);
  const StrayWatch silent("PERSON_MASK", false);
  for (std::int64_t seq = 0; seq < 200; ++seq) {
    left_numbers.AddNew({seq, seq, 1});
    EXPECT_EQ(watch.Add({seq, seq, 1}, std::nullopt, left_numbers, silent), "");
  }
}

// The same images in another order of arrival must give the same bytes, whatever time each says.
TEST(UserCases, Case86cTheTimeOfAFrameIsThatOfItsLeftImage) {
  for (const bool is_right_first : {false, true}) {
    FrontendNode node(WithoutFeedback());
    Send(channel::kCalibration, Calibration(), &node);
    image_t right = Right(0);
    right.utime += 3000;
    if (is_right_first) Send(channel::kCameraRight, right, &node);
    Send(channel::kCameraLeft, Left(0), &node);
    if (!is_right_first) Send(channel::kCameraRight, right, &node);
    SendNobody(0, &node);
    Send(channel::kPersonMask, NoMask(0), &node);
    const std::vector<static_features_t> output = StepAll(&node);
    ASSERT_EQ(output.size(), 1u);
    EXPECT_EQ(output[0].utime, Left(0).utime);
  }
}

// A front end that was killed leaves frames which the optimizer can only predict.
TEST(UserCases, Case86cTheOptimizerPredictsNothingIntoThePast) {
  OptimizerNode node(OptimizerOptions{});
  Send(channel::kCalibration, Calibration(), &node);
  const auto work = [&](std::int64_t seq, std::int64_t utime, std::int8_t state) {
    static_features_t features{};
    features.utime = utime;
    features.seq = seq;
    features.session = kSession;
    features.tracking_state = state;
    features.orientation_O_C[0] = features.orientation_W_C[0] = 1;
    human_observations_t humans = NoHumans(seq);
    humans.utime = utime;
    Send(channel::kHumanObservations, humans, &node);
    if (state >= 0) Send(channel::kStaticFeatures, features, &node);
    EXPECT_TRUE(node.CompleteOldest());
    state_estimate_t estimate{};
    for (const Envelope& message : node.TakeOutput()) {
      if (message.channel != channel::kStateEstimate) continue;
      EXPECT_TRUE(Decode(message.payload.data(), message.payload.size(), &estimate));
    }
    return estimate.status != state_estimate_t::STATUS_INVALID;
  };
  constexpr std::int8_t kNone = -1;
  EXPECT_FALSE(work(0, 1000, static_features_t::STATE_INVALID)) << "nothing is known yet";
  EXPECT_TRUE(work(1, 2000, static_features_t::STATE_INITIALIZING));
  EXPECT_TRUE(work(2, 3000, kNone)) << "predicted";
  EXPECT_FALSE(work(3, 1500, kNone));
  EXPECT_FALSE(work(4, 3000, static_features_t::STATE_INVALID));
  EXPECT_TRUE(work(5, 4000, static_features_t::STATE_COASTING));
}

// ---- The same numbers again ----

class PlayedAgainTest : public testing::Test {
 protected:
  PlayedAgainTest() : node_("node", {"FIRST", "SECOND"}, "OUT") {}
  void Play(std::int64_t first, std::int64_t last, std::int64_t session) {
    for (std::int64_t seq = first; seq <= last; ++seq) PlayOne(seq, session);
  }
  void PlayOne(std::int64_t seq, std::int64_t session) {
    for (const char* channel : {"FIRST", "SECOND"}) {
      const Envelope message = TextEnvelope(channel, seq, "text", session);
      node_.Receive(channel, message.payload.data(), message.payload.size());
    }
    while (node_.Step()) {
    }
  }
  TextNode node_;
};

TEST_F(PlayedAgainTest, CaseLogPlayedTwice) {
  Play(0, 49, 1);
  EXPECT_TRUE(node_.TakeWarnings().empty());
  Play(0, 49, 1);
  const std::vector<std::string> said = node_.TakeWarnings();
  ASSERT_EQ(said.size(), 1u) << "once, not for each channel";
  EXPECT_EQ(said[0],
            "session 1 was already processed up to image 49: repeated messages are dropped; to "
            "play it again use replay_log.sh (a new session each time) or airdos-stereo-player "
            "--data LOG --session N, or restart the processes");
  Play(0, 49, 1);
  EXPECT_EQ(node_.TakeWarnings().size(), 1u) << "each time";
  EXPECT_EQ(node_.frames().num_done, 50);
}

TEST_F(PlayedAgainTest, CaseLogPlayedTwiceAtOnce) {
  Play(0, 20, 1);
  for (std::int64_t k = 0; k < 10; ++k) {
    PlayOne(21 + k, 1);
    PlayOne(k, 1);
  }
  ASSERT_EQ(node_.TakeWarnings().size(), 1u);
}

TEST_F(PlayedAgainTest, CaseEarlierSessionPlayedAgain) {
  Play(0, 9, 1);
  Play(0, 9, 2);
  EXPECT_TRUE(node_.TakeWarnings().empty()) << "a new session is none that comes again";
  Play(0, 9, 1);
  const std::vector<std::string> said = node_.TakeWarnings();
  ASSERT_EQ(said.size(), 1u);
  EXPECT_EQ(said[0].find("session 1 was already processed, session 2 came after it"), 0u);
}

TEST_F(PlayedAgainTest, CaseDuplicatesAndOvertakenMessagesAreNoSecondPlay) {
  for (std::int64_t seq = 0; seq < 60; seq += 2) {
    PlayOne(seq + 1, 1);
    PlayOne(seq, 1);  // overtaken
    PlayOne(seq + 1, 1);
  }
  EXPECT_TRUE(node_.TakeWarnings().empty());
}

TEST_F(PlayedAgainTest, CaseNumbersThatDoNotCount) {
  for (std::int64_t k = 0; k < 20; ++k) {
    frame_done_t message = TextMessage(0, "text", 1);
    message.utime = 1000 * k;
    const std::vector<std::uint8_t> bytes = Encode(message);
    node_.Receive("FIRST", bytes.data(), bytes.size());
  }
  const std::vector<std::string> said = node_.TakeWarnings();
  ASSERT_EQ(said.size(), 1u);
  EXPECT_EQ(said[0].find("FIRST: number 0 comes again and again"), 0u);
}

// Frame 1000 was given up while it waited for its left image: from there on all left ones are late.
TEST_F(PlayedAgainTest, CaseImagesThatComeAfterTheirFrame) {
  Play(0, 4, 1);
  const Envelope ahead = TextEnvelope("SECOND", 1000, "text", 1);
  node_.Receive("SECOND", ahead.payload.data(), ahead.payload.size());
  ASSERT_TRUE(node_.CompleteOldest());
  for (std::int64_t seq = 5; seq < 15; ++seq) {
    const Envelope message = TextEnvelope("FIRST", seq, "text", 1);
    node_.Receive("FIRST", message.payload.data(), message.payload.size());
  }
  ASSERT_EQ(node_.TakeWarnings().size(), 1u);
  EXPECT_TRUE(
      HasWarning(node_, "FIRST: image 7 comes after that frame, or a later one, was processed"))
      << AllWarnings(node_);
}

TEST(UserCases, CaseNoCalibration) {
  FrontendNode node(WithoutFeedback());
  Send(channel::kCalibration, Calibration(kSession + 1), &node);
  SendFrame(0, &node);
  EXPECT_FALSE(node.Step());
  EXPECT_TRUE(node.warnings().empty()) << "it may still come";
  for (int k = 1; k < 60; ++k) SendNobody(k, &node);
  EXPECT_TRUE(node.warnings().empty());
  ASSERT_TRUE(node.CompleteOldest());  // after a deadline
  ASSERT_TRUE(node.CompleteOldest());
  ASSERT_EQ(node.warnings().size(), 1u);
  EXPECT_EQ(
      node.warnings().front(),
      "no CALIBRATION yet for session 7: there are no poses until it arrives; there is one for "
      "session 8");
}

TEST(UserCases, CaseWarningsAreBounded) {
  TextNode node("node", {"FIRST"}, "OUT");
  const auto play = [&] {
    for (std::int64_t seq = 0; seq < 5; ++seq) {
      const Envelope message = TextEnvelope("FIRST", seq, "text", 1);
      node.Receive("FIRST", message.payload.data(), message.payload.size());
    }
  };
  for (int k = 0; k < 100; ++k) play();
  EXPECT_EQ(node.warnings().size(), Node::kMaxWarnings);
  EXPECT_EQ(node.TakeWarnings().size(), Node::kMaxWarnings);
  EXPECT_TRUE(node.TakeWarnings().empty());
}

// ---- Who speaks on a node's own channel ----

class OwnOutputTest : public testing::Test {
 protected:
  void Say(const std::string& text) { own_.AddSaid("OUT", text.data(), text.size()); }
  bool IsForeign(const std::string& text) {
    return own_.IsForeign("OUT", text.data(), text.size());
  }
  OwnOutput own_;
};

TEST_F(OwnOutputTest, CaseLogWithOutputs) {
  EXPECT_FALSE(IsForeign("of a process that was killed before this one was started"));
  for (int k = 0; k < 20; ++k) {
    Say(std::to_string(k));
    EXPECT_FALSE(IsForeign(std::to_string(k)));
  }
  EXPECT_TRUE(IsForeign("other bytes"));
  EXPECT_TRUE(IsForeign("20")) << "the same bytes, before this process says them";
  Say("20");
  EXPECT_FALSE(IsForeign("20"));
}

TEST_F(OwnOutputTest, CaseTheSameBytesFromSomebodyElse) {
  int num_foreign = 0;
  for (int k = 0; k < 20; ++k) {
    Say(std::to_string(k));
    num_foreign += IsForeign(std::to_string(k)) ? 1 : 0;
    num_foreign += IsForeign(std::to_string(k)) ? 1 : 0;
  }
  EXPECT_EQ(num_foreign, 20 - OwnOutput::kMaxDoubled);
}

TEST_F(OwnOutputTest, CaseANetworkThatDoublesAMessageNowAndThen) {
  for (int k = 0; k < 10000; ++k) {
    Say(std::to_string(k));
    EXPECT_FALSE(IsForeign(std::to_string(k)));
    if (k % 200 == 0) {
      EXPECT_FALSE(IsForeign(std::to_string(k))) << k;
    }
  }
}

// ---- Images, masks and keypoints that are not what they are said to be ----

std::string Joined(const std::vector<std::string>& lines) {
  std::string all;
  for (const std::string& line : lines) all.append(line).append("\n");
  return all;
}

/// Shows the watch ten pairs of the walk, the right images moved down by so many rows.
std::string WatchPairs(int rows, bool is_exchanged = false) {
  InputWatch watch;
  for (int k = 0; k < 10; ++k) {
    const StereoPair& pair = Walk(k);
    cv::Mat right = cv::Mat::zeros(pair.right.size(), CV_8UC1);
    pair.right.rowRange(0, right.rows - rows).copyTo(right.rowRange(rows, right.rows));
    if (is_exchanged) {
      watch.AddPair(right, pair.left);
    } else {
      watch.AddPair(pair.left, right);
    }
  }
  return Joined(watch.TakeWarnings());
}

TEST(UserCases, CaseImagesThatAreNotRectified) {
  EXPECT_EQ(WatchPairs(0), "");
  const std::string said = WatchPairs(3);
  EXPECT_EQ(said.find("the images are not rectified: rows of matches differ by 3"), 0u) << said;
  EXPECT_EQ(std::count(said.begin(), said.end(), '\n'), 1) << "once";
  EXPECT_EQ(WatchPairs(1).find("the images are badly rectified"), 0u);
}

TEST(UserCases, CaseImagesThatAreExchanged) {
  const std::string said = WatchPairs(0, true);
  EXPECT_EQ(said.find("left and right images are exchanged: "), 0u) << said;
}

/// What the front end warns of where the cameras are exchanged, the right one so much later.
std::string WarningsOfExchangedCameras(std::int64_t right_later_us) {
  FrontendNode node(WithoutFeedback());
  Send(channel::kCalibration, Calibration(), &node);
  for (int k = 0; k < 12; ++k) {
    image_t left = Left(k);
    image_t right = Right(k);
    std::swap(left.data, right.data);
    std::swap(left.num_bytes, right.num_bytes);
    right.utime += right_later_us;
    SendNobody(k, &node);
    Send(channel::kPersonMask, NoMask(k), &node);
    Send(channel::kCameraLeft, left, &node);
    Send(channel::kCameraRight, right, &node);
    StepAll(&node);
  }
  return AllWarnings(node);
}

TEST(UserCases, Case86cImagesOfOtherTimesAreNotHeldAgainstEachOther) {
  constexpr char kExchanged[] = "left and right images are exchanged";
  for (const std::int64_t sign : {-1, 1}) {
    std::string said = WarningsOfExchangedCameras(sign * 20000);
    EXPECT_NE(said.find(kExchanged), std::string::npos) << said;
    said = WarningsOfExchangedCameras(sign * 20001);
    EXPECT_EQ(said.find(kExchanged), std::string::npos) << said;
  }
}

TEST(UserCases, CaseRowErrorOfImagesWithoutCorners) {
  const cv::Mat grey(192, 320, CV_8UC1, cv::Scalar(90));
  EXPECT_FALSE(RowErrorOf(MatchStereo(grey, grey, 300)));
}

std::string WatchMasks(const cv::Mat& mask, const BodyKeypoints& person) {
  InputWatch watch;
  for (int k = 0; k < 10; ++k) watch.AddMask(mask, {person});
  return Joined(watch.TakeWarnings());
}

TEST(UserCases, CaseMasksThatDoNotMarkPeople) {
  BodyKeypoints person;
  for (std::size_t i = 0; i < person.size(); ++i) {
    person[i] = {100, 40 + 5.0 * static_cast<double>(i), 0.9};
  }
  const cv::Mat nobody = cv::Mat::zeros(192, 320, CV_8UC1);
  cv::Mat marked = nobody.clone();
  marked.colRange(90, 110) = cv::Scalar(255);
  EXPECT_EQ(WatchMasks(marked, person), "");
  EXPECT_EQ(WatchMasks(nobody, BodyKeypoints{}), "") << "nobody is there";
  EXPECT_EQ(WatchMasks(nobody, person).find("the person masks do not mark people: 0 of 140"), 0u);
  EXPECT_EQ(WatchMasks(~nobody, person).find("the person masks cover 100 % of the image"), 0u)
      << WatchMasks(~nobody, person);
  EXPECT_EQ(WatchMasks(~marked, person).find("the person masks cover 94 %"), 0u);
  person[0].u_px = 1e300;
  person[1].v_px = -1e300;
  EXPECT_EQ(WatchMasks(marked, person), "");
}

std::string WatchTimes(std::int64_t step) {
  InputWatch watch;
  for (std::int64_t k = 0; k < 20; ++k) watch.AddTime(1'000'000 + step * k);
  const std::vector<std::string> said = watch.TakeWarnings();
  return said.empty() ? "" : said.front();
}

TEST(UserCases, Case87TimesInOtherUnits) {
  for (const std::int64_t step_us : {4'000, 33'333, 100'000, 1'000'000}) {
    EXPECT_EQ(WatchTimes(step_us), "");
  }
  EXPECT_NE(WatchTimes(33'333'333).find("it is in ns; utime must be the capture time in us"),
            std::string::npos);
  EXPECT_NE(WatchTimes(33).find("it is in ms"), std::string::npos);
  EXPECT_NE(WatchTimes(0).find("stands still"), std::string::npos);
}

std::string WatchPeople(double disparity_px, bool has_right = true) {
  PeopleWatch watch;
  std::string all;
  for (int k = 0; k < 20; ++k) {
    std::vector<BodyKeypoints> left(3);
    for (std::size_t p = 0; p < left.size(); ++p) {
      for (std::size_t i = 0; i < left[p].size(); ++i) {
        left[p][i] = {80.0 * static_cast<double>(p) + 7.0 * static_cast<double>(i % 3) + k,
                      100 + 8.0 * static_cast<double>(i) + 9.0 * static_cast<double>(p), 0.8};
      }
    }
    std::vector<BodyKeypoints> right = left;
    for (BodyKeypoints& person : right) {
      for (BodyKeypoint& joint : person) joint.u_px -= disparity_px;
    }
    if (!has_right) right.clear();
    all += watch.Add(left, right);
  }
  return all;
}

TEST(UserCases, Case41KeypointsOfLeftAndRight) {
  EXPECT_EQ(WatchPeople(6), "");
  EXPECT_EQ(WatchPeople(-6).find("left and right keypoints are exchanged: 30 of 30 people"), 0u);
  EXPECT_EQ(WatchPeople(0).find("left and right keypoints are the same"), 0u);
  EXPECT_EQ(WatchPeople(0, false).find("nobody in the right keypoints, 30 people"), 0u);
}

// ---- What others are told ----

MapChanges::Landmark LandmarkAt(std::int64_t id, double x) {
  return {LandmarkId{id}, {x, 2, 3}, 0.1, 4};
}

TEST(UserCases, CaseALateJoinerGetsTheMap) {
  LandmarkArchive archive;
  MapChanges changes;
  for (std::int64_t id = 1; id <= 950; ++id) changes.landmarks.push_back(LandmarkAt(id, 1));
  archive.Add(changes);
  changes = MapChanges();
  changes.landmarks = {LandmarkAt(10, 5)};
  changes.removed = {LandmarkId{11}};
  archive.Add(changes);
  std::map<LandmarkId, double> heard;
  const std::size_t num_frames = 1 + archive.size() / LandmarkArchive::kRepeatedPerFrame;
  for (std::size_t k = 0; k < num_frames; ++k) {
    const std::vector<MapChanges::Landmark> repeated = archive.NextRepeated();
    EXPECT_LE(repeated.size(), LandmarkArchive::kRepeatedPerFrame);
    for (const MapChanges::Landmark& landmark : repeated) heard[landmark.id] = landmark.p_W.x();
  }
  EXPECT_EQ(heard.size(), 949u);
  EXPECT_EQ(heard.count(LandmarkId{11}), 0u);
  EXPECT_EQ(heard.at(LandmarkId{10}), 5) << "as it was told last";
  for (const map_update_t& part : ToMapUpdates({1, 2, 3}, changes, archive.NextRepeated())) {
    EXPECT_EQ(Validate(part), "");
    EXPECT_EQ(part.num_repeated, 200);
    EXPECT_EQ(part.num_landmarks, 1);
  }
}

TEST(UserCases, CaseTheMapThatIsToldAgainIsBounded) {
  LandmarkArchive archive(100);
  MapChanges changes;
  EXPECT_EQ(archive.NextRepeated().size(), 0u);
  for (std::int64_t id = 1; id <= 100; ++id) changes.landmarks.push_back(LandmarkAt(id, 1));
  EXPECT_FALSE(archive.Add(changes));
  EXPECT_EQ(archive.NextRepeated().size(), 100u) << "each once";
  changes.landmarks = {LandmarkAt(101, 1)};
  EXPECT_TRUE(archive.Add(changes));
  changes.landmarks = {LandmarkAt(102, 1)};
  EXPECT_FALSE(archive.Add(changes)) << "said once";
  EXPECT_EQ(archive.size(), 100u);
  EXPECT_EQ(archive.NextRepeated().front().id, LandmarkId{101}) << "it goes on where it was";
}

TEST(UserCases, Case86cTrajectoryFilesNeverGoBackInTime) {
  FourDMap map;
  for (const auto& [seq, utime] : std::vector<std::pair<std::int64_t, std::int64_t>>{
           {0, 1000000}, {1, 1100000}, {2, 1000000}, {3, 1100000}, {4, 1200000}}) {
    map.frames[FrameId{seq}].utime = utime;
    map.frames[FrameId{seq}].live = Se3();
  }
  const std::string folder = testing::TempDir() + "airdos_user_cases_live";
  ExportMap(map, "map.airdos", folder, /*force=*/false, /*num_replaced=*/nullptr);
  std::ifstream file(folder + "/trajectory_live.tum");
  std::string times;
  for (std::string line; std::getline(file, line);) {
    times += line[0] == '#' ? line + " " : line.substr(0, 4);
  }
  std::filesystem::remove_all(folder);
  EXPECT_EQ(times,
            "# left out: 2 poses whose time is not later than that of an earlier image "
            "1.001.101.20");
}

}  // namespace
}  // namespace airdos
