#include "tests/support/live_chain.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <csignal>

#include "airdos/frame_done_t.hpp"
#include "airdos/human_observations_t.hpp"
#include "airdos/pose_t.hpp"
#include "processes/node/log/log_source.h"
#include "processes/node/message/channels.h"
#include "processes/node/message/codec.h"
#include "processes/node/message/conversions.h"
#include "processes/node/message/validate.h"
#include "processes/tools/replay/replay.h"

namespace airdos {
namespace {

const std::string kSampleLog = std::string(AIRDOS_SOURCE_DIR) + "/logs/road_crossing06.lcm";

// A payload starts with the type's fingerprint, then utime, seq and session, all big-endian.
constexpr std::size_t kUtimeOffset = 8;
constexpr std::size_t kSeqOffset = 16;
constexpr std::size_t kSessionOffset = 24;

std::int64_t Get(const LogEvent& event, std::size_t offset) {
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < 8; ++i) value = value << 8 | event.payload.at(offset + i);
  return static_cast<std::int64_t>(value);
}

void Put(std::int64_t number, std::size_t offset, LogEvent* event) {
  auto value = static_cast<std::uint64_t>(number);
  for (std::size_t i = 8; i-- > 0; value >>= 8) {
    event->payload.at(offset + i) = static_cast<std::uint8_t>(value & 0xFF);
  }
}

}  // namespace

std::int64_t SeqOf(const LogEvent& event) { return Get(event, kSeqOffset); }
std::int64_t UtimeOf(const LogEvent& event) { return Get(event, kUtimeOffset); }
void SetUtime(std::int64_t utime, LogEvent* event) { Put(utime, kUtimeOffset, event); }
void SetSession(std::int64_t session, LogEvent* event) { Put(session, kSessionOffset, event); }

std::vector<LogEvent> SampleEvents(std::int64_t first, std::int64_t last) {
  std::vector<LogEvent> events;
  EventLogReader reader(kSampleLog);
  while (std::optional<LogEvent> event = reader.Next()) {
    const std::int64_t seq = SeqOf(*event);
    const bool is_first_calibration = event->channel == channel::kCalibration && seq == 0;
    if ((seq >= first && seq <= last) || is_first_calibration) events.push_back(std::move(*event));
  }
  return events;
}

void WriteEvents(const std::vector<LogEvent>& events, const std::string& path) {
  EventLogWriter writer(path);
  for (const LogEvent& event : events) {
    writer.Append(event.utime, event.channel, event.payload.data(), event.payload.size());
  }
}

std::map<std::int64_t, Se3> SampleTruth() {
  // In the log it is in NED axes: forward, right, down; C is right, down, forward.
  Eigen::Matrix3d R_C_N;
  R_C_N << 0, 1, 0, 0, 0, 1, 1, 0, 0;
  const Se3 T_C_N{Eigen::Quaterniond(R_C_N), Eigen::Vector3d::Zero()};
  std::map<std::int64_t, Se3> truth;
  std::optional<Se3> T_first_N;
  EventLogReader reader(kSampleLog);
  while (const std::optional<LogEvent> event = reader.Next()) {
    pose_t pose = {};
    if (event->channel != channel::kGroundTruth) continue;
    if (!Decode(event->payload.data(), event->payload.size(), &pose)) continue;
    EXPECT_EQ(pose.axes, +pose_t::AXES_NED);
    const Se3 T_N_camera = ToSe3(pose.position, pose.orientation);
    if (!T_first_N) T_first_N = T_N_camera;
    truth[pose.seq] = T_C_N * T_first_N->inverse() * T_N_camera * T_C_N.inverse();
  }
  return truth;
}

BusListener::BusListener(const std::string& url) : transport_(url) {
  transport_.SubscribeAll([this](const std::string& channel, const void* data, std::size_t size,
                                 std::int64_t) { OnMessage(channel, data, size); });
}

void BusListener::OnMessage(const std::string& channel, const void* data, std::size_t size) {
  ++num_messages_[channel];
  if (channel == channel::kCameraLeft) {
    const auto header = PeekHeader(data, size);
    if (!header) return;
    newest_image_ = std::max(newest_image_, header->seq);
    num_states_at_image_[{header->session, header->seq}] = states_.size();
  }
  if (IsOutputChannel(channel)) digests_.Add(channel, data, size);
  if (channel == channel::kStateEstimate) {
    state_estimate_t state = {};
    ASSERT_TRUE(Decode(data, size, &state));
    EXPECT_EQ(Validate(state), "");
    const bool has_pose = state.status != state_estimate_t::STATUS_INVALID;
    num_without_pose_ += has_pose ? 0 : 1;
    if (!has_pose) return;
    const auto image = num_states_at_image_.find({state.session, state.seq});
    if (image != num_states_at_image_.end()) {
      max_estimates_behind_ = std::max(max_estimates_behind_, states_.size() - image->second);
    }
    states_[{state.session, state.seq}] = state;
  } else if (channel == channel::kHumanObservations) {
    human_observations_t people = {};
    ASSERT_TRUE(Decode(data, size, &people));
    num_people_[{people.session, people.seq}] = people.num_humans;
  } else if (channel == channel::kStatus) {
    process_status_t status = {};
    ASSERT_TRUE(Decode(data, size, &status));
    statuses_[status.process] = status;
  } else if (channel == channel::kFrameDone) {
    frame_done_t done = {};
    ASSERT_TRUE(Decode(data, size, &done));
    done_[done.process].insert({done.session, done.seq});
  }
}

bool BusListener::HearUntil(const std::function<bool()>& condition, double deadline_s) {
  constexpr int kPoll_ms = 20;
  const auto deadline =
      std::chrono::steady_clock::now() + std::chrono::duration<double>(deadline_s);
  while (!condition()) {
    if (std::chrono::steady_clock::now() > deadline) return false;
    transport_.Poll(kPoll_ms);
  }
  return true;
}

void BusListener::Hear() {
  while (transport_.Poll(0)) {
  }
}

bool BusListener::IsDone(const std::string& process, const FrameKey& frame) const {
  const auto done = done_.find(process);
  return done != done_.end() && done->second.count(frame) > 0;
}

std::int64_t BusListener::num_messages(const std::string& channel) const {
  const auto count = num_messages_.find(channel);
  return count == num_messages_.end() ? 0 : count->second;
}

std::int64_t BusListener::num_people(const FrameKey& frame) const {
  const auto people = num_people_.find(frame);
  return people == num_people_.end() ? -1 : people->second;
}

std::string BusListener::digests() const { return FormatDigests(digests_.Result()); }

LiveChain::LiveChain(std::string folder, std::string url)
    : folder_(std::move(folder)), url_(std::move(url)) {}

const std::vector<std::string>& LiveChain::NodePrograms() {
  static const std::vector<std::string> programs{"airdos-frontend", "airdos-human-tracker",
                                                 "airdos-optimizer", "airdos-map-recorder"};
  return programs;
}

ChildProcess* LiveChain::Start(const std::string& program,
                               const std::vector<std::string>& arguments) {
  std::vector<std::string> command = launcher_;
  command.push_back(std::string(AIRDOS_BINARY_DIR) + "/bin/" + program);
  command.insert(command.end(), arguments.begin(), arguments.end());
  command.insert(command.end(), {"--lcm-url", url_});
  processes_.erase(program);  // first, because its files are reused
  processes_[program] = std::make_unique<ChildProcess>(command, folder_ + program);
  return process(program);
}

void LiveChain::StartNode(const std::string& program, const std::vector<std::string>& arguments) {
  std::vector<std::string> all = node_arguments_;
  all.insert(all.end(), arguments.begin(), arguments.end());
  if (program == "airdos-map-recorder") {
    all.insert(all.end(), {"--set", "output.directory=" + folder_ + "map"});
  }
  const ChildProcess* node = Start(program, all);
  ASSERT_TRUE(WaitUntil([node] { return node->HasSaid(" READY "); }, kStart_s))
      << program << ": " << node->Errors();
}

void LiveChain::StartNodes() {
  for (const std::string& program : NodePrograms()) StartNode(program);
}

ChildProcess* LiveChain::StartPlayer(const std::string& data,
                                     const std::vector<std::string>& arguments) {
  std::vector<std::string> all{"--data", data, "--no-check"};  // faults are intended
  all.insert(all.end(), arguments.begin(), arguments.end());
  return Start("airdos-stereo-player", all);
}

void LiveChain::StopNodes() {
  for (const std::string& program : NodePrograms()) {
    if (processes_.count(program) == 0) continue;
    process(program)->Signal(SIGINT);
    const bool is_in_vain = is_in_vain_ && program == "airdos-optimizer";
    EXPECT_EQ(process(program)->Wait(kStart_s), is_in_vain ? 1 : 0)
        << program << ": " << Errors(program);
  }
}

std::string LiveChain::AllErrors() const {
  std::string text;
  for (const auto& [program, process] : processes_) text += process->Errors();
  return text;
}

std::int64_t LiveChain::NumMissing(const std::string& program, const std::string& channel) const {
  const std::string errors = Errors(program);
  const std::string key = ": " + channel + ": received ";
  const std::size_t line = errors.find(key);
  const std::size_t missing = errors.find("missing ", line);
  if (line == std::string::npos || missing == std::string::npos) {
    ADD_FAILURE() << program << " does not say what it missed on " << channel << "\n" << errors;
    return 0;
  }
  return std::stoll(errors.substr(missing + std::string("missing ").size()));
}

std::string ReplayDigests(const std::string& log, const std::string& folder) {
  ChildProcess replay(
      {std::string(AIRDOS_BINARY_DIR) + "/bin/airdos-replay", log, "--out", folder + "replayed.lcm",
       "--run-dir", folder + "map_replayed", "--no-progress", "--no-check"},
      folder + "airdos-replay");
  EXPECT_EQ(replay.Wait(LiveChain::kRun_s), 0) << replay.Errors();
  return FormatDigests(DigestLog(folder + "replayed.lcm"));
}

}  // namespace airdos
