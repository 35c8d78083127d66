#include <map>
#include <opencv2/imgcodecs.hpp>
#include <optional>

#include "common/dataset/sequence_files.h"
#include "common/util/error.h"
#include "processes/node/live/log_recorder.h"
#include "processes/node/log/event_log.h"
#include "processes/node/message/channels.h"
#include "processes/node/message/image_codec.h"
#include "processes/node/message/keypoint_messages.h"
#include "processes/stereo_player/image_packer.h"
#include "processes/stereo_player/lockstep_gate.h"
#include "tests/fuzz/fuzz_input.h"
#include "tests/support/sample_messages.h"

namespace airdos {
namespace {

constexpr int kMaxMessageSeedBytes = 4096;

/// The first byte chooses the type; the fingerprint is put in front.
template <class Message>
void RunAs(const FuzzBytes& body) {
  Message message = {};
  FuzzBytes bytes = Encode(message);
  bytes.resize(8);
  bytes.insert(bytes.end(), body.begin(), body.end());
  if (!Decode(bytes.data(), bytes.size(), &message)) return;
  // Only what is sane may be used further, and it must survive the way out and in again.
  if (!Validate(message).empty()) return;
  Message again;
  const FuzzBytes encoded = Encode(message);
  FuzzCheck(Decode(encoded.data(), encoded.size(), &again), "a valid message does not come back");
  FuzzCheck(Validate(again).empty(), "a valid message comes back as another");
}

template <class... Messages>
struct Types {
  static constexpr int kCount = sizeof...(Messages);
  static void Run(int choice, const FuzzBytes& body) {
    int index = 0;
    ((choice % kCount == index++ ? RunAs<Messages>(body) : void()), ...);
  }
  static std::vector<FuzzBytes> Seeds() {
    std::vector<FuzzBytes> seeds;
    (Add(Sample<Messages>(), &seeds), ...);
    return seeds;
  }
  template <class Message>
  static void Add(const Message& message, std::vector<FuzzBytes>* seeds) {
    seeds->push_back(Numbered(static_cast<int>(seeds->size()), Encode(message)));
  }
  /// The type's number takes the place of the fingerprint.
  static FuzzBytes Numbered(int number, FuzzBytes message) {
    message.erase(message.begin(), message.begin() + 7);
    message[0] = static_cast<std::uint8_t>(number);
    return message;
  }
  static std::optional<int> NumberOf(const FuzzBytes& message) {
    int index = -1;
    std::optional<int> number;
    const auto match = [&](const FuzzBytes& sample) {
      ++index;
      if (std::equal(sample.begin(), sample.begin() + 8, message.begin())) number = index;
    };
    (match(Encode(Messages{})), ...);
    return number;
  }
};

using AllTypes = Types<image_t, stereo_calibration_t, person_keypoints_t, person_mask_t,
                       static_features_t, human_observations_t, state_estimate_t, map_update_t,
                       pose_t, frame_done_t, process_status_t>;

void RunMessages(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return;
  AllTypes::Run(data[0], FuzzBytes(data + 1, data + size));
}

void RunKeypoints(const std::uint8_t* data, std::size_t size) {
  FuzzInput input(data, size);
  person_keypoints_t message = {};
  FuzzBytes bytes = Encode(message);
  bytes.resize(8);
  bytes.insert(bytes.end(), data, data + size);
  if (Decode(bytes.data(), bytes.size(), &message) && Validate(message).empty()) ToPeople(message);
}

std::vector<FuzzBytes> KeypointSeeds() {
  const FuzzBytes bytes = Encode(Sample<person_keypoints_t>());
  return {FuzzBytes(bytes.begin() + 8, bytes.end())};
}

/// Encoding, size as the message says it, then the file.
void RunImage(const std::uint8_t* data, std::size_t size) {
  FuzzInput input(data, size);
  image_t image = {};
  image.encoding = static_cast<std::int8_t>(1 + input.U8() % 4);
  image.width = 1 + input.U8() + 256 * (input.U8() % 33);
  image.height = 1 + input.U8() + 256 * (input.U8() % 33);
  const FuzzBytes file = size > 5 ? FuzzBytes(data + 5, data + size) : FuzzBytes();
  image.data = file;
  image.num_bytes = static_cast<std::int32_t>(file.size());
  DecodeGray(image);
  DecodeColor(image);
  person_mask_t mask = {};
  mask.encoding = image.encoding;
  mask.width = image.width;
  mask.height = image.height;
  mask.data = file;
  mask.num_bytes = image.num_bytes;
  DecodeMask(mask);
  try {
    ReadImageSize(FuzzFolder::Write("image.png", file.data(), file.size()));
  } catch (const InputError&) {
  }
  try {
    ImagePacker(ImagePackerOptions()).Pack(file, "image", &image);
  } catch (const InputError&) {
  }
}

std::vector<FuzzBytes> ImageSeeds() {
  std::vector<FuzzBytes> seeds;
  for (const bool is_color : {false, true}) {
    const cv::Mat image(12, 16, is_color ? CV_8UC3 : CV_8UC1, cv::Scalar(90, 120, 30));
    for (const std::string extension : {".jpg", ".png"}) {
      FuzzBytes file;
      cv::imencode(extension, image, file);
      FuzzBytes seed = {static_cast<std::uint8_t>(extension == ".jpg" ? 0 : 1), 15, 0, 11, 0};
      seed.insert(seed.end(), file.begin(), file.end());
      seeds.push_back(seed);
    }
  }
  FuzzBytes progressive;
  cv::imencode(".jpg", cv::Mat(12, 16, CV_8UC1, cv::Scalar(3)), progressive,
               {cv::IMWRITE_JPEG_PROGRESSIVE, 1});
  progressive.insert(progressive.begin(), {0, 15, 0, 11, 0});
  seeds.push_back(progressive);
  return seeds;
}

/// What the player hears: steps of time, frames it publishes, STATUS and FRAME_DONE.
void RunGate(const std::uint8_t* data, std::size_t size) {
  FuzzInput input(data, size);
  LockstepGateOptions options;
  options.wait_for = {"airdos-optimizer", "b"};
  LockstepGate gate(options, 0);
  double now_s = 0;
  std::int64_t seq = 0;
  while (!input.empty()) {
    const int action = input.U8();
    now_s += 0.1 * input.U8();
    if (action % 4 == 0) gate.OnPublished(1, seq++, now_s);
    const FuzzBytes body = action % 4 == 0 ? FuzzBytes() : input.Block();
    const auto hear = [&](auto message, const auto& handle) {
      FuzzBytes bytes = Encode(message);
      bytes.resize(8);
      bytes.insert(bytes.end(), body.begin(), body.end());
      if (Decode(bytes.data(), bytes.size(), &message) && Validate(message).empty())
        handle(message);
    };
    if (action % 4 == 1) {
      hear(process_status_t{}, [&](const auto& status) { gate.OnStatus(status, now_s); });
    } else if (action % 4 == 2) {
      hear(frame_done_t{}, [&](const auto& done) { gate.OnFrameDone(done, now_s); });
    }
    gate.MayPublish(now_s);
    gate.IsAllDone(now_s);
    gate.TakeNewcomer();
    gate.TakeNotes();
  }
}

std::vector<FuzzBytes> GateSeeds() {
  const auto whole = [](const auto& message) {
    const FuzzBytes bytes = Encode(message);
    return FuzzBytes(bytes.begin() + 8, bytes.end());
  };
  FuzzOutput seed;
  seed.U8(1);
  seed.U8(1);
  seed.Block(whole(Sample<process_status_t>()));
  for (int i = 0; i < 3; ++i) {
    seed.U8(0);
    seed.U8(1);
  }
  seed.U8(2);
  seed.U8(1);
  seed.Block(whole(Sample<frame_done_t>()));
  return {seed.Take()};
}

/// Whatever anybody says on any channel, into a recording.
void RunLogRecorderTarget(const std::uint8_t* data, std::size_t size) {
  FuzzInput input(data, size);
  LogRecorderOptions options;
  options.path = FuzzFolder::Path() + "/recorded.lcm";
  options.replaces_file = true;
  LogRecorder recorder(options);
  while (!input.empty()) {
    const int action = input.U8();
    const FuzzBytes name = input.Block();
    const FuzzBytes payload = input.Block();
    recorder.Take(action % 2 == 0 ? channel::kCameraLeft : std::string(name.begin(), name.end()),
                  payload.data(), payload.size(), action);
  }
  recorder.Summary();
}

std::vector<FuzzBytes> LogRecorderSeeds() {
  FuzzOutput seed;
  for (int i = 0; i < 3; ++i) {
    seed.U8(i);
    seed.Block(std::string("CHANNEL"));
    seed.Block(Encode(Sample<pose_t>()));
  }
  return {seed.Take()};
}

}  // namespace

std::vector<FuzzBytes> MessageSeedsOfLog(const std::string& path) {
  constexpr int kOfAChannel = 3;
  std::vector<FuzzBytes> seeds;
  std::map<std::string, int> num_taken;
  EventLogReader reader(path);
  while (const std::optional<LogEvent> event = reader.Next()) {
    const std::size_t size = event->payload.size();
    if (size < 32 || size > kMaxMessageSeedBytes || num_taken[event->channel] == kOfAChannel)
      continue;
    const std::optional<int> number = AllTypes::NumberOf(event->payload);
    if (!number) continue;
    ++num_taken[event->channel];
    seeds.push_back(AllTypes::Numbered(*number, event->payload));
  }
  return seeds;
}

std::vector<FuzzTarget> MessageTargets() {
  return {{"messages", RunMessages, AllTypes::Seeds, kMaxMessageSeedBytes},
          {"keypoints", RunKeypoints, KeypointSeeds, 8192},
          {"image", RunImage, ImageSeeds, 8192},
          {"player_inputs", RunGate, GateSeeds, 4096},
          {"log_recorder", RunLogRecorderTarget, LogRecorderSeeds, 4096}};
}

}  // namespace airdos
