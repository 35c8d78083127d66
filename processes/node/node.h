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

struct Envelope {
  std::string channel;
  std::vector<std::uint8_t> payload;
};

/// What a node has seen of one of its input channels.
struct ChannelCounters {
  std::int64_t num_received = 0;
  std::int64_t num_missing = 0;
  std::int64_t num_duplicate = 0;
  std::int64_t num_rejected = 0;
  std::string last_reject;  ///< why, in words
};

struct FrameCounters {
  std::int64_t num_done = 0;
  std::int64_t num_incomplete = 0;
  std::int64_t num_skipped = 0;
};

/// One vertex of the Kahn network: bytes in, bytes out. No clock, no thread, no transport; whoever
/// owns it (a process behind LCM, airdos-replay, a test) hands in what arrived and takes out what
/// is to be published. What it publishes on a channel depends only on what each of its input
/// channels carried, not on how they interleaved.
class Node {
 public:
  /// Warnings that are kept; the oldest go first.
  static constexpr std::size_t kMaxWarnings = 20;

  explicit Node(std::string name) : name_(std::move(name)) {}
  virtual ~Node() = default;
  Node(const Node&) = delete;
  Node& operator=(const Node&) = delete;

  const std::string& name() const { return name_; }
  std::vector<std::string> input_channels() const;
  /// What it publishes; nobody else may publish there.
  const std::vector<std::string>& output_channels() const { return output_channels_; }
  /// False for input channels that bring what holds for more than a frame, or what others made of
  /// earlier frames: those can close a circle of nodes.
  virtual bool MakesUpFrames(const std::string& /*channel*/) const { return true; }

  /// Takes in one message; never throws, whatever the bytes are. Bytes that do not decode or make
  /// no sense are counted.
  void Receive(const std::string& channel, const void* data, std::size_t size);
  /// Works on the next frame that is ready. False if none is.
  virtual bool Step() = 0;
  /// Works on the oldest frame without the inputs it still lacks: after a deadline, or at the end
  /// of a log. False if none waits.
  virtual bool CompleteOldest() = 0;
  /// Drops (and counts) the frames that are older than the newest complete one, and the oldest
  /// where too many wait: realtime pace.
  virtual void SkipToNewest() = 0;
  /// Channels that the oldest waiting frame lacks and that can still bring it, separated by spaces;
  /// empty if no frame waits.
  virtual std::string waiting_for() const = 0;
  virtual std::size_t num_pending() const = 0;
  /// No more will come: writes what is only written at the end. Throws InputError if it cannot; a
  /// destructor could only mumble it.
  virtual void Finish() {}
  /// What is to be said of the whole run at its end; empty if nothing.
  virtual std::string summary() const { return ""; }
  /// Why the whole run was in vain, for the exit code; empty where it was not, or had no frame.
  virtual std::string why_in_vain() const { return ""; }

  /// What was published since the last call, in order.
  std::vector<Envelope> TakeOutput();

  /// What of the input is doubtful, for people: one line each, what it is and what to do. Those
  /// since the last call, and the newest kMaxWarnings of all. Like all else they depend on what
  /// came, not on when.
  std::vector<std::string> TakeWarnings();
  const std::deque<std::string>& warnings() const { return warnings_; }

  const std::map<std::string, ChannelCounters>& channels() const { return channels_; }
  const FrameCounters& frames() const { return frames_; }
  /// The frame that Step() or CompleteOldest() worked on last; nothing before the first one.
  const std::optional<Header>& last_finished() const { return last_finished_; }

 protected:
  /// `handler` returns why it rejects the message, or an empty text. Messages that fail Validate()
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

  /// For the constructor: names a channel that the node publishes.
  void DeclareOutput(const std::string& channel) { output_channels_.push_back(channel); }

  void Warn(const std::string& warning);
  /// Counts a message of the channel as rejected, and remembers why.
  void Reject(const std::string& channel, const std::string& reason);

  template <class Message>
  void Publish(const std::string& channel, const Message& message) {
    output_.push_back({channel, Encode(message)});
  }

  /// Messages that wait for TakeOutput(), and how to take back those after the first `num_kept`.
  std::size_t num_published() const { return output_.size(); }
  void DropPublished(std::size_t num_kept) { output_.resize(num_kept); }

  ChannelCounters& counters(const std::string& channel) { return channels_[channel]; }
  FrameCounters& mutable_frames() { return frames_; }
  /// Bytes of the message that a handler works on.
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
