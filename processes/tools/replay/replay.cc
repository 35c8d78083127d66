#include "processes/tools/replay/replay.h"

#include <sys/resource.h>
#include <time.h>

#include <algorithm>
#include <fstream>
#include <iomanip>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <sstream>
#include <utility>

#include "common/util/digest.h"
#include "common/util/error.h"
#include "common/util/json_file.h"
#include "common/util/output_files.h"
#include "common/util/quantile.h"
#include "processes/node/bus/fifo_bus.h"
#include "processes/node/bus/parallel_bus.h"
#include "processes/node/message/channels.h"
#include "processes/node/message/codec.h"

namespace airdos {
namespace {

double NowMs(clockid_t clock) {
  timespec now = {};
  clock_gettime(clock, &now);
  return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

std::string WarningText(const Node& node, const std::string& warning) {
  return node.name() + ": warning: " + warning;
}

// Accumulates the time of a node's calls until it is done with a frame, and collects its warnings.
// Each node has its own entry, so nodes on different threads do not interfere.
class Overseer : public Bus::WorkObserver {
 public:
  explicit Overseer(const std::vector<ReplayNode>& nodes) {
    for (const ReplayNode& entry : nodes) laps_[entry.node->name()].node = entry.node.get();
  }
  void BeforeWork(const Node& node) override {
    Lap& lap = laps_.at(node.name());
    lap.start_wall_ms = NowMs(CLOCK_MONOTONIC);
    lap.start_cpu_ms = NowMs(CLOCK_THREAD_CPUTIME_ID);
  }
  void AfterWork(const Node& node) override {
    Lap& lap = laps_.at(node.name());
    lap.cpu_ms += NowMs(CLOCK_THREAD_CPUTIME_ID) - lap.start_cpu_ms;
    lap.wall_ms += NowMs(CLOCK_MONOTONIC) - lap.start_wall_ms;
    KeepWarnings(lap.node->TakeWarnings(), node);
    if (node.frames().num_done == lap.num_done) return;
    lap.timing.wall_ms.push_back(std::exchange(lap.wall_ms, 0));
    lap.timing.cpu_ms.push_back(std::exchange(lap.cpu_ms, 0));
    lap.num_done = node.frames().num_done;
  }
  std::map<std::string, NodeTiming> TakeTiming() {
    std::map<std::string, NodeTiming> timing;
    for (auto& [name, lap] : laps_) {
      if (lap.num_done > 0) timing[name] = std::move(lap.timing);
    }
    return timing;
  }
  // Those since the last call; called by a thread that no node works on.
  std::vector<std::string> TakeWarnings() {
    const std::lock_guard<std::mutex> lock(mutex_);
    return std::exchange(warnings_, {});
  }

 private:
  struct Lap {
    Node* node = nullptr;
    double start_wall_ms = 0;
    double start_cpu_ms = 0;
    double wall_ms = 0;
    double cpu_ms = 0;
    std::int64_t num_done = 0;
    NodeTiming timing;
  };

  void KeepWarnings(const std::vector<std::string>& warnings, const Node& node) {
    const std::lock_guard<std::mutex> lock(mutex_);
    for (const std::string& warning : warnings) warnings_.push_back(WarningText(node, warning));
  }

  std::map<std::string, Lap> laps_;
  std::mutex mutex_;
  std::vector<std::string> warnings_;  // of all nodes
};

using FrameKey = std::pair<std::int64_t, std::int64_t>;  // (session, seq)

// Keeps what the bus carries: log, digests, frame numbers.
class Archive {
 public:
  Archive(const std::vector<ReplayNode>& nodes, const ReplayOptions& options)
      : writes_inputs_(options.writes_inputs) {
    for (const ReplayNode& entry : nodes)
      published_.insert(entry.publishes.begin(), entry.publishes.end());
    if (!options.out_path.empty()) writer_.emplace(options.out_path);
  }

  void Take(const Envelope& message) {
    const void* data = message.payload.data();
    const std::size_t size = message.payload.size();
    const Header header = PeekHeader(data, size).value_or(Header{});
    // People come from the source or from a detector that runs here.
    const bool is_published = published_.count(message.channel) > 0;
    const bool is_input = IsInputChannel(message.channel) && !is_published;
    if (message.channel == channel::kCameraLeft || message.channel == channel::kCameraRight ||
        message.channel == channel::kStaticFeatures)
      frames_.insert({header.session, header.seq});
    tally_.Take(message.channel, data, size);
    if (IsOutputChannel(message.channel) || is_published) digests_.Add(message.channel, data, size);
    if (writer_ && (writes_inputs_ || !is_input))
      writer_->Append(header.utime, message.channel, data, size);
  }

  void Fill(ReplayResult* result) const {
    result->num_frames = static_cast<std::int64_t>(frames_.size());
    result->tally = tally_.Count();
    result->num_posed = result->tally.num_frames - result->tally.num_without_pose;
    result->num_events = writer_ ? writer_->num_events() : 0;
    result->digests = digests_.Result();
  }

 private:
  bool writes_inputs_;
  std::set<std::string> published_;
  std::optional<EventLogWriter> writer_;
  ChannelDigests digests_;
  std::set<FrameKey> frames_;
  RunTally tally_;
};

std::string FileSha256(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw InputError(path + ": cannot be read");
  Digest digest;
  std::vector<char> chunk(1 << 20);
  while (file.read(chunk.data(), static_cast<std::streamsize>(chunk.size())), file.gcount() > 0)
    digest.Add(chunk.data(), static_cast<std::size_t>(file.gcount()));
  return digest.Hex();
}

void AddRemarks(const Node& node, std::vector<std::string>* remarks) {
  const FrameCounters& frames = node.frames();
  if (frames.num_incomplete > 0) {
    remarks->push_back(node.name() + ": " + std::to_string(frames.num_incomplete) +
                       " frames incomplete");
  }
  for (const std::string& warning : node.warnings()) {
    remarks->push_back(WarningText(node, warning));
  }
  for (const auto& [channel, counters] : node.channels()) {
    const auto add = [&, name = channel](std::int64_t count, const std::string& what) {
      if (count > 0)
        remarks->push_back(node.name() + ": " + name + ": " + std::to_string(count) + " " + what);
    };
    add(counters.num_missing, "missing");
    add(counters.num_duplicate, "duplicate or late");
    add(counters.num_rejected, "rejected, the last because: " + counters.last_reject);
  }
}

struct Statistics {
  double mean = 0;
  double p50 = 0;
  double p99 = 0;
};

Statistics StatisticsOf(const std::vector<double>& values) {
  if (values.empty()) return {};
  double sum = 0;
  for (const double value : values) sum += value;
  return {sum / static_cast<double>(values.size()), Quantile(values, 0.50), Quantile(values, 0.99)};
}

double PeakMemoryMb() {
  rusage usage = {};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;
}

// The next frame. If the source fails, everything before takes effect first.
std::vector<Envelope> NextFrame(FrameSource* source, Bus* bus) {
  try {
    return source->NextFrame();
  } catch (...) {
    bus->Settle();
    throw;
  }
}

}  // namespace

ReplayResult Replay(FrameSource* source, const std::vector<ReplayNode>& nodes,
                    const ReplayOptions& options) {
  Archive archive(nodes, options);
  Overseer overseer(nodes);
  const auto say = [&options](const std::vector<std::string>& remarks) {
    if (!options.on_remark) return;
    for (const std::string& remark : remarks) options.on_remark(remark);
  };
  std::unique_ptr<Bus> bus = std::make_unique<FifoBus>();
  if (options.is_parallel) bus = std::make_unique<ParallelBus>();
  for (const ReplayNode& entry : nodes) bus->AddNode(entry.node.get(), entry.publishes);
  bus->AddObserver([&archive](const Envelope& message) { archive.Take(message); });
  bus->SetWorkObserver(&overseer);

  ReplayResult result;
  const double start_ms = NowMs(CLOCK_MONOTONIC);
  for (;;) {
    std::vector<Envelope> frame = NextFrame(source, bus.get());
    const std::vector<std::string> notes = source->TakeNotes();
    result.remarks.insert(result.remarks.end(), notes.begin(), notes.end());
    say(notes);
    say(overseer.TakeWarnings());
    if (frame.empty()) break;
    bus->PublishFrame(std::move(frame));
    if (options.on_progress) options.on_progress(source->fraction_done());
  }
  bus->Finish();
  say(overseer.TakeWarnings());
  result.wall_s = 1e-3 * (NowMs(CLOCK_MONOTONIC) - start_ms);
  for (const ReplayNode& entry : nodes) entry.node->Finish();

  archive.Fill(&result);
  // Whatever went to a pipe or a device cannot be read again.
  if (StampOf(options.out_path)) result.log_sha256 = FileSha256(options.out_path);
  result.timing = overseer.TakeTiming();
  for (const ReplayNode& entry : nodes) AddRemarks(*entry.node, &result.remarks);
  return result;
}

std::map<std::string, ChannelDigests::Entry> DigestLog(const std::string& path) {
  EventLogReader reader(path);
  ChannelDigests digests;
  while (const std::optional<LogEvent> event = reader.Next()) {
    if (IsOutputChannel(event->channel))
      digests.Add(event->channel, event->payload.data(), event->payload.size());
  }
  return digests.Result();
}

std::string FormatDigests(const std::map<std::string, ChannelDigests::Entry>& digests) {
  std::ostringstream text;
  for (const auto& [channel, entry] : digests) {
    text << std::left << std::setw(20) << channel << std::right << std::setw(7)
         << entry.num_messages << "  " << entry.sha256 << "\n";
  }
  return text.str();
}

std::string FormatSummary(const ReplayResult& result) {
  std::ostringstream text;
  text << std::fixed << std::setprecision(1);
  text << "frames: " << result.num_frames << ", with a pose: " << result.num_posed << " ("
       << ToText(result.tally) << ")\n";
  text << "ms per frame      wall: mean    p50    p99    CPU: mean    p50    p99\n";
  for (const auto& [name, timing] : result.timing) {
    const Statistics wall = StatisticsOf(timing.wall_ms);
    const Statistics cpu = StatisticsOf(timing.cpu_ms);
    text << std::left << std::setw(16) << name << std::right << std::setw(13) << wall.mean
         << std::setw(7) << wall.p50 << std::setw(7) << wall.p99 << std::setw(13) << cpu.mean
         << std::setw(7) << cpu.p50 << std::setw(7) << cpu.p99 << "\n";
  }
  text << FormatDigests(result.digests);
  for (const std::string& remark : result.remarks) text << "note: " << remark << "\n";
  if (!result.log_sha256.empty()) {
    text << "output log        " << std::setw(9) << result.num_events << "  " << result.log_sha256
         << "\n";
  }
  return text.str();
}

void WriteTiming(const ReplayResult& result, const std::string& path) {
  const auto to_json = [](const std::vector<double>& values) {
    const Statistics statistics = StatisticsOf(values);
    return nlohmann::json{
        {"mean", statistics.mean}, {"p50", statistics.p50}, {"p99", statistics.p99}};
  };
  nlohmann::json json{{"num_frames", result.num_frames},
                      {"num_posed", result.num_posed},
                      {"num_events", result.num_events},
                      {"wall_s", result.wall_s},
                      {"peak_memory_mb", PeakMemoryMb()}};
  for (const auto& [name, timing] : result.timing) {
    json["processes"][name] = {{"num_frames", timing.wall_ms.size()},
                               {"wall_ms", to_json(timing.wall_ms)},
                               {"cpu_ms", to_json(timing.cpu_ms)}};
  }
  WriteJson(json, path);
}

}  // namespace airdos
