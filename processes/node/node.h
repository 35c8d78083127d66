#ifndef AIRDOS_PROCESSES_NODE_NODE_H_
#define AIRDOS_PROCESSES_NODE_NODE_H_

#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "processes/node/message/codec.h"
#include "processes/node/message/header.h"
#include "processes/node/message/validate.h"

namespace airdos {

/// A message with its channel.
struct Envelope {
  std::string channel;
  std::vector<std::uint8_t> payload;
};

/// What a node has received on one of its input channels.
struct ChannelCounters {
  std::int64_t num_received = 0;
  std::int64_t num_missing = 0;
  std::int64_t num_duplicate = 0;
  std::int64_t num_rejected = 0;
  std::string last_reject;  ///< reason, in words
};

/// What became of a node's frames.
struct FrameCounters {
  std::int64_t num_done = 0;
  std::int64_t num_incomplete = 0;
  std::int64_t num_skipped = 0;
};

/// A vertex of the Kahn network: bytes in, bytes out. No clock, no threads, no transport; its owner
/// (a process with LCM, airdos-replay, a test) passes in what arrived and takes out what is to be
/// published. What it publishes on a channel depends only on what each of its input channels
/// carried, not on how they interleaved.
class Node {
 public:
  /// Number of warnings kept; the oldest are dropped first.
  static constexpr std::size_t kMaxWarnings = 20;

  explicit Node(std::string name) : name_(std::move(name)) {}
  virtual ~Node() = default;
  Node(const Node&) = delete;
  Node& operator=(const Node&) = delete;

  const std::string& name() const { return name_; }
  std::vector<std::string> input_channels() const;
  /// The channels that it publishes; nobody else may publish on them.
  const std::vector<std::string>& output_channels() const { return output_channels_; }
  /// False for input channels whose messages apply to more than one frame, or were computed by
  /// others from earlier frames: those may close a cycle of nodes.
  virtual bool MakesUpFrames(const std::string& /*channel*/) const { return true; }

  /// Takes in one message; never throws, whatever the bytes. Bytes that do not decode or are
  /// invalid are counted.
  void Receive(const std::string& channel, const void* data, std::size_t size);
  /// Processes the next frame that is ready. Returns false if there is none.
  virtual bool Step() = 0;
  /// Processes the oldest frame without the inputs that it still lacks: after a deadline, or at the
  /// end of a log. Returns false if no frame is waiting.
  virtual bool CompleteOldest() = 0;
  /// For realtime pace: drops (and counts) the frames older than the newest complete one, but for
  /// as many as may wait, and the oldest if too many are waiting.
  virtual void SkipToNewest() = 0;
  /// Channels that the oldest waiting frame lacks and may still receive, separated by spaces; empty
  /// if no frame is waiting.
  virtual std::string waiting_for() const = 0;
  virtual std::size_t num_pending() const = 0;
  /// Called when no more messages will come: writes what is only written at the end. Throws
  /// InputError if it cannot; a destructor could not report that.
  virtual void Finish() {}
  /// A summary of the whole run, for its end; empty if there is none.
  virtual std::string summary() const { return ""; }
  /// Why the whole run was in vain, for the exit code; empty if it was not, or if it had no frame.
  virtual std::string why_in_vain() const { return ""; }

  /// What was published since the last call, in order.
  std::vector<Envelope> TakeOutput();

  /// What is doubtful about the input, for the user: one line each, with the problem and the
  /// remedy. TakeWarnings() returns those since the last call; warnings() the newest kMaxWarnings
  /// of all. Like everything else, they depend on what arrived, not on when.
  std::vector<std::string> TakeWarnings();
  const std::deque<std::string>& warnings() const { return warnings_; }

  const std::map<std::string, ChannelCounters>& channels() const { return channels_; }
  const FrameCounters& frames() const { return frames_; }
  /// The frame last processed by Step() or CompleteOldest(); nothing before the first one.
  const std::optional<Header>& last_finished() const { return last_finished_; }

 protected:
  /// `handler` returns why it rejects a message, or an empty text. Messages that fail Validate()
  /// never reach it.
  template <class Message>
  void Subscribe(const std::string& channel, std::function<std::string(Message&&)> handler) {
    channels_[channel];
    handlers_[channel] = [handler](const void* data, std::size_t size) -> std::string {
      Message message;
      if (size > kMaxMessageBytes<Message>) return std::to_string(size) + " bytes are too many";
      if (!Decode(data, size, &message)) return "does not decode";
      const std::string reason = Validate(message);
      return reason.empty() ? handler(std::move(message)) : reason;
    };
  }

  /// For constructors: names a channel that the node publishes.
  void DeclareOutput(const std::string& channel) { output_channels_.push_back(channel); }

  void Warn(const std::string& warning);
  /// Counts a message of the channel as rejected, and remembers why.
  void Reject(const std::string& channel, const std::string& reason);

  template <class Message>
  void Publish(const std::string& channel, const Message& message) {
    output_.push_back({channel, Encode(message)});
  }

  /// Number of messages waiting for TakeOutput(), and dropping those after the first `num_kept`.
  std::size_t num_published() const { return output_.size(); }
  void DropPublished(std::size_t num_kept) { output_.resize(num_kept); }

  ChannelCounters& counters(const std::string& channel) { return channels_[channel]; }
  FrameCounters& mutable_frames() { return frames_; }
  /// Size of the message that a handler is processing.
  std::size_t num_bytes_received() const { return num_bytes_received_; }
  void set_last_finished(const Header& header) { last_finished_ = header; }

 private:
  using Handler = std::function<std::string(const void*, std::size_t)>;

  std::string name_;
  std::map<std::string, Handler> handlers_;
  std::map<std::string, ChannelCounters> channels_;
  FrameCounters frames_;
  std::optional<Header> last_finished_;
  std::vector<Envelope> output_;
  std::vector<std::string> output_channels_;
  std::deque<std::string> warnings_;
  std::vector<std::string> new_warnings_;
  std::size_t num_bytes_received_ = 0;
};

}  // namespace airdos

#endif  // AIRDOS_PROCESSES_NODE_NODE_H_
