#ifndef AIRDOS_PROCESSES_NODE_FRAME_NODE_H_
#define AIRDOS_PROCESSES_NODE_FRAME_NODE_H_

#include <algorithm>
#include <deque>
#include <exception>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/geometry/stereo_camera.h"
#include "common/util/check.h"
#include "processes/node/frame_joiner.h"
#include "processes/node/message/channels.h"
#include "processes/node/message/conversions.h"
#include "processes/node/message/part_set.h"
#include "processes/node/node.h"
#include "processes/node/stray_watch.h"

namespace airdos {

/// A node that works frame by frame. A subclass declares in its constructor which channels make up
/// a frame (Join, JoinParts) and whether it needs the calibration (JoinCalibration), and overrides
/// MissingFeedback if it depends on its own past; it then gets each frame exactly once and in
/// order.
template <class Inputs>
class FrameNode : public Node {
 public:
  /// A channel has one publisher and LCM preserves its order, so whatever is overtaken is lost.
  /// Waiting for reordered messages would form a cycle with the optimizer's feedback: a lost
  /// message of frame k could be given up only once frame k + 1 + window has arrived, but that
  /// frame waits for the result of frame k.
  static constexpr int kReorderWindow = 0;
  /// Limits on pending frames and on the bytes of their messages. Beyond them the oldest frame is
  /// processed incomplete (dropped, in realtime pace), so memory stays bounded.
  static constexpr std::size_t kMaxPending = 1000;
  static constexpr std::size_t kMaxPendingBytes = 512u << 20;
  /// This many frames may arrive before their calibration, which some sources publish once a
  /// second.
  static constexpr int kPatienceForCalibration = 40;
  /// Number of sessions whose calibration is kept; beyond it the oldest one is forgotten.
  static constexpr std::size_t kMaxCalibrations = 100;

  using Node::Node;

  bool MakesUpFrames(const std::string& channel) const override {
    const auto& names = channels_of_inputs_;
    return std::find(names.begin(), names.end(), channel) != names.end();
  }

  bool Step() override {
    const std::optional<FrameJoiner::Frame> frame = Joiner().Oldest();
    if (!frame) return false;
    const bool is_ready =
        frame->settled && HasCalibration(frame->header) && MissingFeedback(frame->header).empty();
    if (!is_ready && !IsOverfull()) return false;
    Work(*frame);
    return true;
  }

  bool CompleteOldest() override {
    const std::optional<FrameJoiner::Frame> frame = Joiner().Oldest();
    if (!frame) return false;
    Work(*frame);
    return true;
  }

  void SkipToNewest() override {
    const std::optional<FrameJoiner::Key> newest = Joiner().NewestComplete(max_behind_);
    while ((newest && Joiner().Oldest()->key < *newest) || IsOverfull()) {
      DropInputs(Joiner().Oldest()->key);
      std::int64_t num_absent = 0;
      Joiner().FinishOldest(&num_absent);
      ++mutable_frames().num_skipped;
    }
  }

  std::string waiting_for() const override {
    if (joiner_ == nullptr) return "";
    const std::optional<FrameJoiner::Frame> frame = joiner_->Oldest();
    if (!frame) return "";
    std::string text;
    for (const int input : frame->awaited)  // what was overtaken is lost, so nobody waits for it
      text += channels_of_inputs_[static_cast<std::size_t>(input)] + " ";
    if (!HasCalibration(frame->header)) text += std::string(channel::kCalibration) + " ";
    for (const std::string& name : MissingFeedback(frame->header)) text += name + " ";
    if (!text.empty()) text.pop_back();
    return text;
  }

  std::size_t num_pending() const override {
    return joiner_ == nullptr ? 0 : joiner_->num_pending();
  }

 protected:
  /// Joins a channel with one message per frame.
  template <class Message>
  void Join(const std::string& channel, std::optional<Message> Inputs::*field) {
    const int input = AddInput(channel);
    Subscribe<Message>(channel, [this, input, field](Message&& message) {
      return Arrived(input, HeaderOf(message),
                     [&](Inputs& inputs) { inputs.*field = std::move(message); });
    });
  }

  /// Joins a channel with one or more messages per frame, numbered by `part` and `num_parts`. They
  /// are handed over in order of `part` once all have arrived. Only one set is kept: the first part
  /// of a later frame discards an incomplete set.
  template <class Message>
  void JoinParts(const std::string& channel, std::vector<Message> Inputs::*field) {
    const int input = AddInput(channel);
    const auto set = std::make_shared<PartsOfFrame<Message>>();
    Subscribe<Message>(channel, [this, input, field, set](Message&& message) {
      const Header header = HeaderOf(message);
      FrameJoiner::Key key;
      const FrameJoiner::Arrival arrival = Joiner().Announce(input, header, &key);
      if (arrival != FrameJoiner::Arrival::kNew) return Refused(arrival, input, header);
      if (set->parts.empty() || set->key < key || key < set->key) *set = {key, {}};
      const std::string refusal = set->parts.Add(std::move(message));
      if (!refusal.empty() || !set->parts.is_complete()) return refusal;
      std::vector<Message> parts = set->parts.Take();
      return Arrived(input, header, [&](Inputs& inputs) { inputs.*field = std::move(parts); });
    });
  }

  /// Realtime pace: how many newer complete frames may wait while one is worked on, before any is
  /// skipped. For nodes whose frames take turns in being slow and fast.
  void SetMaxBehind(int num_frames) { max_behind_ = num_frames; }

  /// Frames wait for the calibration of their session; ProcessFrame() then finds it in camera().
  /// The first calibration of a session applies to the whole session, including earlier frames: if
  /// it could change, the frames it applies to would depend on how fast it travels. A different one
  /// is rejected.
  void JoinCalibration() {
    needs_calibration_ = true;
    Subscribe<stereo_calibration_t>(channel::kCalibration, [this](stereo_calibration_t&& message) {
      const StereoCamera camera = ToStereoCamera(message);
      const auto [known, is_new] = calibrations_.try_emplace(message.session, camera);
      if (is_new) RememberCalibrated(message.session);
      if (is_new || known->second == camera) return std::string();
      return std::string("calibration changes within a session");
    });
  }

  /// Channels of feedback without which the frame must not start; empty if none is needed.
  virtual std::vector<std::string> MissingFeedback(const Header&) const { return {}; }
  /// Called before a frame of a new session is processed: forget everything.
  virtual void StartSession(const Header& header) = 0;
  /// Publishes exactly one output for the frame, whatever is missing from `inputs`. If it throws,
  /// whatever it published is dropped and it is called again with empty `inputs`, because others
  /// wait for that output; then the exception propagates to the caller of Step() or
  /// CompleteOldest().
  virtual void ProcessFrame(const Header& header, Inputs inputs) = 0;

  /// The numbers that arrived on a joined channel.
  const StrayWatch& numbers_of(const std::string& channel) const {
    const auto& names = channels_of_inputs_;
    const auto place = std::find(names.begin(), names.end(), channel);
    AIRDOS_CHECK(place != names.end());
    return watches_[static_cast<std::size_t>(place - names.begin())];
  }

  /// Calibration of the frame being processed.
  const StereoCamera& camera() const { return camera_; }

  /// Whether an image (cv::Mat) of the frame in work decoded, and has the size that the calibration
  /// says. Counts it as rejected otherwise; `reason` says why it did not decode.
  template <class Image>
  bool Fits(const std::optional<Image>& image, const std::string& channel,
            const std::string& reason) {
    if (image && image->cols == camera_.width && image->rows == camera_.height) return true;
    Reject(channel, image ? "its size is not that of the calibration" : reason);
    return false;
  }

 private:
  struct Slot {
    Inputs inputs;
    std::size_t num_bytes = 0;  // of the messages that they arrived in
  };
  template <class Message>
  struct PartsOfFrame {
    FrameJoiner::Key key;
    PartSet<Message> parts;
  };

  int AddInput(const std::string& channel) {
    AIRDOS_CHECK(joiner_ == nullptr);
    channels_of_inputs_.push_back(channel);
    watches_.emplace_back(channel, watches_.empty());
    return static_cast<int>(channels_of_inputs_.size()) - 1;
  }

  FrameJoiner& Joiner() {
    if (joiner_ == nullptr) {
      joiner_ = std::make_unique<FrameJoiner>(static_cast<int>(channels_of_inputs_.size()),
                                              kReorderWindow);
    }
    return *joiner_;
  }

  template <class Fill>
  std::string Arrived(int input, const Header& header, Fill fill) {
    FrameJoiner::Key key;
    const FrameJoiner::Arrival arrival = Joiner().Add(input, header, &key);
    if (arrival != FrameJoiner::Arrival::kNew) return Refused(arrival, input, header);
    watches_[static_cast<std::size_t>(input)].AddNew(header);
    if (input == 0 && !HasCalibration(header)) {
      if (num_uncalibrated_ < kPatienceForCalibration) ++num_uncalibrated_;
      if (num_uncalibrated_ == kPatienceForCalibration) WarnOfCalibration(header.session);
    }
    Slot& slot = inputs_[key];
    slot.num_bytes += num_bytes_received();
    num_pending_bytes_ += num_bytes_received();
    fill(slot.inputs);
    return "";
  }

  bool IsOverfull() {
    return Joiner().num_pending() > kMaxPending ||
           (num_pending_bytes_ > kMaxPendingBytes && Joiner().num_pending() > 1);
  }

  void DropInputs(const FrameJoiner::Key& key) {
    const auto slot = inputs_.find(key);
    if (slot == inputs_.end()) return;
    num_pending_bytes_ -= slot->second.num_bytes;
    inputs_.erase(slot);
  }

  void ForgetCalibration(std::int64_t session) {
    calibrations_.erase(session);
    calibrated_.erase(std::remove(calibrated_.begin(), calibrated_.end(), session),
                      calibrated_.end());
  }

  void RememberCalibrated(std::int64_t session) {
    calibrated_.push_back(session);
    if (calibrated_.size() <= kMaxCalibrations) return;
    calibrations_.erase(calibrated_.front());
    calibrated_.pop_front();
  }

  std::string Refused(FrameJoiner::Arrival arrival, int input, const Header& header) {
    if (arrival == FrameJoiner::Arrival::kTooFar) {
      return "seq " + std::to_string(header.seq) + " is far beyond the previous one";
    }
    const auto slot = static_cast<std::size_t>(input);
    ++counters(channels_of_inputs_[slot]).num_duplicate;
    const std::string warning = watches_[slot].AddRefused(header);
    if (!warning.empty()) Warn(warning);
    return "";
  }

  bool HasCalibration(const Header& header) const {
    return !needs_calibration_ || calibrations_.count(header.session) > 0;
  }

  void WarnOfCalibration(std::int64_t session) {
    if (uncalibrated_said_ == session) return;
    uncalibrated_said_ = session;
    std::string others;
    if (!calibrated_.empty()) {
      others = "; there is one for session " + std::to_string(calibrated_.back());
    }
    Warn("no CALIBRATION yet for session " + std::to_string(session) +
         ": there are no poses until it arrives" + others);
  }

  void Work(const FrameJoiner::Frame& frame) {
    Inputs inputs = std::move(inputs_[frame.key].inputs);
    DropInputs(frame.key);
    std::int64_t num_absent = 0;
    Joiner().FinishOldest(&num_absent);
    set_last_finished(frame.header);
    for (const std::string& channel : channels_of_inputs_)
      counters(channel).num_missing += num_absent;
    for (const int input : frame.missing) {
      ++counters(channels_of_inputs_[static_cast<std::size_t>(input)]).num_missing;
    }
    if (!frame.missing.empty() || !HasCalibration(frame.header)) ++mutable_frames().num_incomplete;
    if (!HasCalibration(frame.header)) {  // without it pixels have no meaning
      WarnOfCalibration(frame.header.session);
      return;
    }
    num_uncalibrated_ = 0;
    ++mutable_frames().num_done;
    if (needs_calibration_) camera_ = calibrations_.at(frame.header.session);
    if (!session_ || *session_ != frame.header.session) {
      if (session_) ForgetCalibration(*session_);
      session_ = frame.header.session;
      StartSession(frame.header);
    }
    const std::size_t num_published = this->num_published();
    try {
      ProcessFrame(frame.header, std::move(inputs));
    } catch (const std::exception&) {
      DropPublished(num_published);
      ProcessFrame(frame.header, Inputs());
      throw;
    }
  }

  std::vector<std::string> channels_of_inputs_;
  std::vector<StrayWatch> watches_;  // one per input
  std::unique_ptr<FrameJoiner> joiner_;
  std::map<FrameJoiner::Key, Slot> inputs_;
  std::size_t num_pending_bytes_ = 0;
  int max_behind_ = 0;
  bool needs_calibration_ = false;
  std::map<std::int64_t, StereoCamera> calibrations_;  // keyed by session
  std::deque<std::int64_t> calibrated_;                // their sessions, oldest first
  StereoCamera camera_;
  std::optional<std::int64_t> session_;
  int num_uncalibrated_ = 0;  // consecutive frames without a calibration
  std::optional<std::int64_t> uncalibrated_said_;
};

}  // namespace airdos

#endif  // AIRDOS_PROCESSES_NODE_FRAME_NODE_H_
