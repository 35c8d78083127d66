#include <iterator>
#include <nlohmann/json.hpp>

#include "common/config/config_reader.h"
#include "common/map/four_d_map.h"
#include "common/map/map_export.h"
#include "common/perception/tfjs_to_onnx.h"
#include "common/util/error.h"
#include "common/util/json_file.h"
#include "processes/node/bus/fifo_bus.h"
#include "processes/node/check/check_log.h"
#include "processes/node/log/event_log.h"
#include "processes/node/log/log_source.h"
#include "processes/node/message/channels.h"
#include "tests/fuzz/fuzz_input.h"
#include "tests/support/echo_node.h"
#include "tests/support/sample_messages.h"

namespace airdos {
namespace {

FuzzBytes ReadAll(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return FuzzBytes{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

// --- logs
void RunEventLog(const std::uint8_t* data, std::size_t size) {
  const std::string path = FuzzFolder::Write("events.lcm", data, size);
  try {
    EventLogReader reader(path);
    std::int64_t num_bytes = 0;
    while (const std::optional<LogEvent> event = reader.Next()) {
      num_bytes += static_cast<std::int64_t>(event->payload.size());
    }
    FuzzCheck(num_bytes + reader.num_bytes_skipped() <= reader.num_bytes(),
              "a log gave more than it holds");
  } catch (const InputError&) {
  }
}

/// As airdos-replay does it: a log, the bus, a node.
void RunLogBus(const std::uint8_t* data, std::size_t size) {
  const std::string path = FuzzFolder::Write("bus.lcm", data, size);
  try {
    LogSource source(path);
    EchoNode node;
    FifoBus bus;
    bus.AddNode(&node, {EchoNode::kEcho});
    for (std::vector<Envelope> frame = source.NextFrame(); !frame.empty();
         frame = source.NextFrame()) {
      for (Envelope& message : frame) bus.Publish(std::move(message));
      source.TakeNotes();
      source.fraction_done();
    }
    bus.Finish();
  } catch (const InputError&) {
  }
}

/// As airdos-check does it.
void RunCheckLog(const std::uint8_t* data, std::size_t size) {
  const std::string path = FuzzFolder::Write("check.lcm", data, size);
  FindingList findings;
  try {
    CheckOptions options;
    options.max_frames = 2;
    options.odometry_frames = 2;
    CheckLog(path, options, &findings);
  } catch (const InputError&) {
  }
  JsonText(findings.ToJson(path));
}

std::vector<FuzzBytes> LogSeeds() {
  const std::string path = FuzzFolder::Path() + "/seed.lcm";
  {
    EventLogWriter writer(path);
    const auto add = [&](const char* channel, std::int64_t seq, auto message) {
      message.seq = seq;
      message.utime = 100000 * seq;
      const FuzzBytes bytes = Encode(message);
      writer.Append(message.utime, channel, bytes.data(), bytes.size());
    };
    for (std::int64_t seq = 0; seq < 3; ++seq) {
      add(channel::kCalibration, seq, Sample<stereo_calibration_t>());
      add(channel::kCameraLeft, seq, Sample<image_t>());
      add(channel::kCameraRight, seq, Sample<image_t>());
      add(channel::kGroundTruth, seq, Sample<pose_t>());
    }
  }
  return {ReadAll(path)};
}

// --- maps
MapDelta SmallChanges() {
  MapDelta changes;
  MapFrame frame;
  frame.utime = 5;
  frame.live = Se3();
  frame.refined = Se3();
  changes.SetFrame({1}, frame);
  changes.SetLandmark({2}, MapLandmark());
  changes.RemoveLandmark({3});
  MapHuman human;
  human.joints[1] = MapJoint();
  human.segment_lengths_m[2] = 0.3F;
  human.part_motions[0] = MapPartMotion();
  changes.SetHuman({1}, {4}, human);
  return changes;
}

void RunMapFile(const std::uint8_t* data, std::size_t size) {
  const std::string path = FuzzFolder::Write("map.airdos", data, size);
  try {
    MapFileSummary summary;
    const FourDMap map = ReadFourDMap(path, &summary);
    FuzzCheck(summary.num_bytes_used + summary.num_bytes_dropped <= static_cast<int64_t>(size),
              "a map gave more than it holds");
    const std::string folder = FuzzFolder::Path() + "/export";
    std::filesystem::create_directories(folder);
    ExportMap(map, path, folder, false, nullptr);
    std::filesystem::remove_all(folder);
  } catch (const InputError&) {
  }
}

std::vector<FuzzBytes> MapFileSeeds() {
  const std::string path = FuzzFolder::Path() + "/seed.airdos";
  {
    MapFileWriter writer(path);
    writer.Append(HeadChunk(1, "seed"));
    writer.Append(SmallChanges().ToChunk());
    writer.Append(EndChunk(StereoCamera{64, 48, 50, 50, 32, 24, 0.2}, 1));
  }
  return {ReadAll(path)};
}

/// What is behind the checksum, which random bytes never get past: the type, then the content.
void RunMapChunks(const std::uint8_t* data, std::size_t size) {
  FuzzInput input(data, size);
  const std::string path = FuzzFolder::Path() + "/chunks.airdos";
  {
    MapFileWriter writer(path);
    while (!input.empty()) {
      const std::uint32_t type = input.U8();
      writer.Append({type, input.Block()});
    }
  }
  const FuzzBytes file = ReadAll(path);
  RunMapFile(file.data(), file.size());
}

std::vector<FuzzBytes> MapChunkSeeds() {
  FuzzOutput seed;
  for (const MapChunk& chunk : {HeadChunk(1, "seed"), SmallChanges().ToChunk(),
                                EndChunk(StereoCamera{64, 48, 50, 50, 32, 24, 0.2}, 1)}) {
    seed.U8(static_cast<int>(chunk.type));
    seed.Block(chunk.bytes);
  }
  return {seed.Take()};
}

// --- configurations
void RunConfig(const std::uint8_t* data, std::size_t size) {
  try {
    ConfigReader config =
        ConfigReader::FromString(std::string(reinterpret_cast<const char*>(data), size), "fuzz");
    const auto attempt = [](const auto& read) {
      try {
        read();
      } catch (const InputError&) {
      }
    };
    bool flag = false;
    int whole = 0;
    double number = 0;
    std::string text;
    attempt([&] { config.Read("section.flag", &flag); });
    attempt([&] { config.Read("section.whole", &whole, -5, 5); });
    attempt([&] { config.Read("section.number", &number, 0, 1); });
    attempt([&] { config.Read("section.text", &text); });
    attempt([&] { config.ReadChoice("section.choice", {"a", "b"}); });
    attempt([&] { config.Override("section.number=0.5"); });
    FuzzCheck(number >= 0 && number <= 1 && whole >= -5 && whole <= 5, "a range was not kept");
    config.Resolved();
    config.Finish();
  } catch (const InputError&) {
  }
}

std::vector<FuzzBytes> ConfigSeeds() {
  const auto bytes = [](const std::string& text) { return FuzzBytes(text.begin(), text.end()); };
  return {bytes("section:\n  flag: true\n  whole: 3\n  number: 0.25\n  text: hello\n  choice: a\n"),
          bytes("# a comment\nsection: {flag: false, whole: -5}\nother: &x {a: 1}\nthird: *x\n")};
}

// --- networks: what we read of them ourselves; ONNX is read by OpenCV
void RunTfjsModel(const std::uint8_t* data, std::size_t size) {
  const float weights[] = {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12};
  FuzzFolder::Write("weights.bin", weights, sizeof weights);
  try {
    TfjsCut cut;
    cut.outputs = {"result"};
    TfjsToOnnx(ReadTfjsModel(FuzzFolder::Write("model.json", data, size)), cut);
  } catch (const InputError&) {
  }
}

std::vector<FuzzBytes> TfjsSeeds() {
  const std::string head = R"({"modelTopology": {"node": [{"name": "i", "op": "Placeholder"}, )";
  const std::string end = R"(]}, "weightsManifest": [{"paths": ["weights.bin"], "weights": [)"
                          R"({"name": "w", "shape": [1, 1, 3, 1], "dtype": "float32"}, )"
                          R"({"name": "b", "shape": [1], "dtype": "float32"}, )"
                          R"({"name": "q", "shape": [2], "dtype": "float32",)"
                          R"( "quantization": {"dtype": "uint8", "scale": 0.5, "min": 1}}]}]})";
  const std::string nodes[] = {
      R"({"name": "result", "op": "_FusedConv2D", "input": ["i", "w", "b"], "attr": {)"
      R"("strides": {"list": {"i": ["1", "2", "2", "1"]}}, "padding": {"s": "U0FNRQ=="},)"
      R"( "fused_ops": {"list": {"s": ["Qmlhc0FkZA==", "UmVsdTY="]}}}})",
      R"({"name": "s", "op": "Shape", "input": ["i"]}, )"
      R"({"name": "result", "op": "ResizeBilinear", "input": ["i", "q"],)"
      R"( "attr": {"half_pixel_centers": {"b": true}}})",
      R"({"name": "a", "op": "Add", "input": ["i", "b"]}, )"
      R"({"name": "result", "op": "AvgPool", "input": ["a"], "attr": {)"
      R"("ksize": {"list": {"i": ["1", "2", "2", "1"]}}, "padding": {"s": "VkFMSUQ="}}})"};
  std::vector<FuzzBytes> seeds;
  for (const std::string& node : nodes) {
    const std::string text = head + node + end;
    seeds.emplace_back(text.begin(), text.end());
  }
  return seeds;
}

}  // namespace

std::vector<FuzzTarget> FileTargets() {
  return {{"event_log", RunEventLog, LogSeeds, 16384},
          {"log_bus", RunLogBus, LogSeeds, 16384},
          {"check_log", RunCheckLog, LogSeeds, 16384},
          {"map_file", RunMapFile, MapFileSeeds, 8192},
          {"map_chunks", RunMapChunks, MapChunkSeeds, 8192},
          {"config", RunConfig, ConfigSeeds, 4096},
          {"tfjs_model", RunTfjsModel, TfjsSeeds, 8192}};
}

}  // namespace airdos
