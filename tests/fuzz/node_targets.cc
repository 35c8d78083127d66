#include <opencv2/core/utility.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "common/config/config_reader.h"
#include "processes/frontend/frontend_node.h"
#include "processes/human_tracker/human_tracker_node.h"
#include "processes/map_recorder/map_recorder_node.h"
#include "processes/node/message/channels.h"
#include "processes/optimizer/optimizer_node.h"
#include "tests/fuzz/fuzz_input.h"
#include "tests/support/sample_messages.h"

namespace airdos {
namespace {

// An input is a list of steps: what to do (a byte), and for a message its number and its bytes.
constexpr int kNumActions = 16;  // the first ones are the node's channels
constexpr int kStep = 13;
constexpr int kCompleteOldest = 14;
constexpr int kSkipToNewest = 15;
constexpr int kOwnHeader = 0x80;  // the bytes are a whole message but for the fingerprint

struct FuzzChannel {
  const char* name;
  std::int64_t fingerprint;
};

template <class Message>
FuzzChannel ChannelOf(const char* name) {
  return {name, Message::getHash()};
}

void AddInt64(std::int64_t value, FuzzBytes* bytes) {
  for (int shift = 56; shift >= 0; shift -= 8)
    bytes->push_back(static_cast<std::uint8_t>(static_cast<std::uint64_t>(value) >> shift));
}

template <class Message>
void CheckMessage(const Envelope& envelope) {
  Message message;
  FuzzCheck(Decode(envelope.payload.data(), envelope.payload.size(), &message),
            "an own message on " + envelope.channel + " does not decode");
  const std::string reason = Validate(message);
  FuzzCheck(reason.empty(), "an own message on " + envelope.channel + ": " + reason);
}

/// Nobody downstream may have to reject what a node made of nonsense.
void CheckOutput(Node* node) {
  for (const Envelope& envelope : node->TakeOutput()) {
    if (envelope.channel == channel::kStaticFeatures) CheckMessage<static_features_t>(envelope);
    if (envelope.channel == channel::kHumanObservations)
      CheckMessage<human_observations_t>(envelope);
    if (envelope.channel == channel::kStateEstimate) CheckMessage<state_estimate_t>(envelope);
    if (envelope.channel == channel::kMapUpdate) CheckMessage<map_update_t>(envelope);
  }
}

void ReceiveFuzzed(const FuzzChannel& channel, int action, FuzzInput* input, Node* node) {
  FuzzBytes message;
  AddInt64(channel.fingerprint, &message);
  if ((action & kOwnHeader) == 0) {
    const int number = input->U8();
    AddInt64(100000 * (number % 64), &message);
    AddInt64(number % 64, &message);
    AddInt64(1 + number / 128, &message);
  }
  const FuzzBytes body = input->Block();
  message.insert(message.end(), body.begin(), body.end());
  node->Receive(channel.name, message.data(), message.size());
}

void Drive(const std::vector<FuzzChannel>& channels, FuzzInput input, Node* node) {
  cv::setNumThreads(1);
  constexpr int kMaxSteps = 64;
  for (int i = 0; i < kMaxSteps && !input.empty(); ++i) {
    const int action = input.U8();
    const int kind = (action & ~kOwnHeader) % kNumActions;
    if (kind == kStep) {
      node->Step();
    } else if (kind == kCompleteOldest) {
      node->CompleteOldest();
    } else if (kind == kSkipToNewest) {
      node->SkipToNewest();
    } else {
      ReceiveFuzzed(channels[static_cast<std::size_t>(kind) % channels.size()], action, &input,
                    node);
      node->Step();
    }
    CheckOutput(node);
    node->waiting_for();
  }
  while (node->CompleteOldest()) CheckOutput(node);
}

/// Writes inputs for Drive().
class NodeSeed {
 public:
  template <class Message>
  NodeSeed& Say(int channel, int seq, const Message& message) {
    bytes_.U8(channel);
    bytes_.U8(seq);
    bytes_.Block(BodyOf(message));
    return *this;
  }
  template <class Message>
  NodeSeed& SayWhole(int channel, const Message& message) {
    bytes_.U8(channel | kOwnHeader);
    const FuzzBytes whole = Encode(message);
    bytes_.Block(FuzzBytes(whole.begin() + 8, whole.end()));
    return *this;
  }
  NodeSeed& Do(int action) {
    bytes_.U8(action);
    return *this;
  }
  FuzzBytes Take() { return bytes_.Take(); }

 private:
  FuzzOutput bytes_;
};

std::string ConfigPath(const std::string& process) {
  return std::string(AIRDOS_SOURCE_DIR) + "/launch_scripts/config/" + process + ".yaml";
}

// Small, so that many inputs fit into a second.
constexpr int kWidth_px = 96;
constexpr int kHeight_px = 64;

stereo_calibration_t SmallCalibration() {
  stereo_calibration_t message = {};
  message.width = kWidth_px;
  message.height = kHeight_px;
  message.fx_px = message.fy_px = 80;
  message.cx_px = 48;
  message.cy_px = 32;
  message.baseline_m = 0.25;
  return message;
}

image_t SmallImage(int shift_px, const std::string& extension) {
  cv::Mat image(kHeight_px, kWidth_px, CV_8UC1, cv::Scalar(40));
  for (int i = 0; i < 12; ++i) {
    cv::rectangle(image, cv::Rect(shift_px + 7 * i, 5 + (i * 17) % 50, 4 + i % 3, 5),
                  cv::Scalar(80 + 14 * i), cv::FILLED);
  }
  image_t message = {};
  message.width = kWidth_px;
  message.height = kHeight_px;
  message.encoding = extension == ".png" ? image_t::ENCODING_PNG : image_t::ENCODING_JPEG;
  cv::imencode(extension, image, message.data);
  message.num_bytes = static_cast<std::int32_t>(message.data.size());
  return message;
}

person_keypoints_t SmallPeople(float shift_px) {
  person_keypoints_t message = {};
  message.layout = person_keypoints_t::LAYOUT_COCO18;
  message.num_people = 2;
  message.num_joints = 18;
  for (int person = 0; person < 2; ++person) {
    std::vector<float> u_px, v_px;
    for (int joint = 0; joint < 18; ++joint) {
      u_px.push_back(20 + 40 * static_cast<float>(person) + static_cast<float>(joint % 5) * 3 -
                     shift_px);
      v_px.push_back(6 + 3 * static_cast<float>(joint));
    }
    message.u_px.push_back(u_px);
    message.v_px.push_back(v_px);
    message.confidence.push_back(std::vector<float>(18, 0.9F));
  }
  return message;
}

// --- frontend
const std::vector<FuzzChannel>& FrontendChannels() {
  static const std::vector<FuzzChannel> channels{
      ChannelOf<stereo_calibration_t>(channel::kCalibration),
      ChannelOf<image_t>(channel::kCameraLeft),
      ChannelOf<image_t>(channel::kCameraRight),
      ChannelOf<person_mask_t>(channel::kPersonMask),
      ChannelOf<human_observations_t>(channel::kHumanObservations),
      ChannelOf<person_keypoints_t>(channel::kPersonKeypointsLeft),
      ChannelOf<map_update_t>(channel::kMapUpdate)};
  return channels;
}

void RunFrontend(const std::uint8_t* data, std::size_t size) {
  static const FrontendOptions options = [] {
    ConfigReader config = ConfigReader::FromFile(ConfigPath("frontend"));
    return ReadFrontendOptions(&config);
  }();
  FrontendNode node(options);
  Drive(FrontendChannels(), FuzzInput(data, size), &node);
}

std::vector<FuzzBytes> FrontendSeeds() {
  NodeSeed whole, pictures;
  whole.Say(0, 0, SmallCalibration());
  pictures.Say(0, 0, SmallCalibration());
  person_mask_t no_mask = {};
  no_mask.encoding = person_mask_t::ENCODING_NONE;
  for (int seq = 0; seq < 4; ++seq) {
    whole.Say(1, seq, SmallImage(4 + seq, ".jpg")).Say(2, seq, SmallImage(seq, ".jpg"));
    whole.Say(3, seq, no_mask).Say(4, seq, Sample<human_observations_t>());
    whole.Say(5, seq, SmallPeople(0));
    map_update_t update = Sample<map_update_t>();
    update.num_parts = 1;
    update.part = 0;
    whole.Say(6, seq, update);
    pictures.Say(1, seq, SmallImage(4 + seq, ".png")).Say(2, seq, SmallImage(seq, ".png"));
    pictures.Do(kCompleteOldest);
  }
  return {whole.Take(), pictures.Take()};
}

// --- human tracker
const std::vector<FuzzChannel>& TrackerChannels() {
  static const std::vector<FuzzChannel> channels{
      ChannelOf<stereo_calibration_t>(channel::kCalibration),
      ChannelOf<image_t>(channel::kCameraLeft), ChannelOf<image_t>(channel::kCameraRight),
      ChannelOf<person_keypoints_t>(channel::kPersonKeypointsLeft),
      ChannelOf<person_keypoints_t>(channel::kPersonKeypointsRight)};
  return channels;
}

void RunTracker(const std::uint8_t* data, std::size_t size) {
  static const HumanTrackerOptions options = [] {
    ConfigReader config = ConfigReader::FromFile(ConfigPath("human_tracker"));
    return ReadHumanTrackerOptions(&config);
  }();
  HumanTrackerNode node(options);
  Drive(TrackerChannels(), FuzzInput(data, size), &node);
}

std::vector<FuzzBytes> TrackerSeeds() {
  NodeSeed whole, people;
  whole.Say(0, 0, SmallCalibration());
  people.Say(0, 0, SmallCalibration());
  for (int seq = 0; seq < 4; ++seq) {
    whole.Say(1, seq, SmallImage(4 + seq, ".jpg")).Say(2, seq, SmallImage(seq, ".jpg"));
    whole.Say(3, seq, SmallPeople(0)).Say(4, seq, SmallPeople(4));
    people.Say(3, seq, SmallPeople(0)).Say(4, seq, SmallPeople(4)).Do(kCompleteOldest);
  }
  return {whole.Take(), people.Take()};
}

// --- optimizer
const std::vector<FuzzChannel>& OptimizerChannels() {
  static const std::vector<FuzzChannel> channels{
      ChannelOf<stereo_calibration_t>(channel::kCalibration),
      ChannelOf<static_features_t>(channel::kStaticFeatures),
      ChannelOf<human_observations_t>(channel::kHumanObservations)};
  return channels;
}

void RunOptimizer(const std::uint8_t* data, std::size_t size) {
  static const OptimizerOptions options = [] {
    ConfigReader config = ConfigReader::FromFile(ConfigPath("optimizer"));
    return ReadOptimizerOptions(&config);
  }();
  OptimizerNode node(options);
  Drive(OptimizerChannels(), FuzzInput(data, size), &node);
}

static_features_t SmallFeatures(int seq) {
  static_features_t message = Sample<static_features_t>();
  message.num_features = 12;
  message.landmark_id.clear();
  message.u_left_px.clear();
  message.v_px.clear();
  message.u_right_px.clear();
  message.has_right.assign(12, 1);
  message.sigma_px.assign(12, 1);
  for (int i = 0; i < 12; ++i) {
    message.landmark_id.push_back(i + seq);
    message.u_left_px.push_back(static_cast<float>(60 + 40 * i + seq));
    message.v_px.push_back(static_cast<float>(20 + (i * 71) % 300));
    message.u_right_px.push_back(static_cast<float>(50 + 39 * i + seq));
  }
  message.position_O_C[2] = 0.05 * seq;
  return message;
}

std::vector<FuzzBytes> OptimizerSeeds() {
  NodeSeed whole;
  whole.Say(0, 0, Sample<stereo_calibration_t>());
  for (int seq = 0; seq < 4; ++seq) {
    whole.Say(1, seq, SmallFeatures(seq)).Say(2, seq, Sample<human_observations_t>());
  }
  NodeSeed sparse;
  sparse.SayWhole(0, Sample<stereo_calibration_t>()).SayWhole(1, Sample<static_features_t>());
  sparse.SayWhole(2, Sample<human_observations_t>());
  return {whole.Take(), sparse.Take()};
}

// --- map recorder
const std::vector<FuzzChannel>& RecorderChannels() {
  static const std::vector<FuzzChannel> channels{
      ChannelOf<stereo_calibration_t>(channel::kCalibration),
      ChannelOf<state_estimate_t>(channel::kStateEstimate),
      ChannelOf<map_update_t>(channel::kMapUpdate), ChannelOf<pose_t>(channel::kGroundTruth)};
  return channels;
}

void RunRecorder(const std::uint8_t* data, std::size_t size) {
  MapRecorderOptions options;
  options.directory = FuzzFolder::Path() + "/map";
  options.chunk_frames = 2;
  {
    MapRecorderNode node(options);
    Drive(RecorderChannels(), FuzzInput(data, size), &node);
    node.Finish();
  }
  std::filesystem::remove_all(options.directory);
}

std::vector<FuzzBytes> RecorderSeeds() {
  NodeSeed whole;
  whole.Say(0, 0, Sample<stereo_calibration_t>());
  map_update_t first = Sample<map_update_t>();
  first.part = 0;
  for (int seq = 0; seq < 4; ++seq) {
    whole.Say(1, seq, Sample<state_estimate_t>()).Say(3, seq, Sample<pose_t>());
    whole.Say(2, seq, first).Say(2, seq, Sample<map_update_t>());
  }
  NodeSeed other_session;
  other_session.SayWhole(1, Sample<state_estimate_t>()).SayWhole(2, Sample<map_update_t>());
  other_session.SayWhole(3, Sample<pose_t>()).Say(1, 128, Sample<state_estimate_t>());
  return {whole.Take(), other_session.Take()};
}

}  // namespace

std::vector<FuzzTarget> NodeTargets() {
  return {{"frontend", RunFrontend, FrontendSeeds, 32768},
          {"human_tracker", RunTracker, TrackerSeeds, 32768},
          {"optimizer", RunOptimizer, OptimizerSeeds, 16384},
          {"map_recorder", RunRecorder, RecorderSeeds, 16384}};
}

}  // namespace airdos
