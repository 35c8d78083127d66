#ifndef AIRDOS_PROCESSES_NODE_LOG_SOURCE_H_
#define AIRDOS_PROCESSES_NODE_LOG_SOURCE_H_

#include <cstddef>
#include <cstdint>
#include <deque>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "processes/node/event_log.h"
#include "processes/node/frame_joiner.h"
#include "processes/node/node.h"

namespace airdos {

/// What every message of ours starts with, without knowing its type; nothing if the payload is too
/// short.
std::optional<Header> PeekHeader(const void* data, std::size_t size);
/// Puts another one in its place; nothing is done if the payload is too short.
void WriteHeader(const Header& header, void* data, std::size_t size);

/// The images and what else comes from outside (never what processes made of it).
bool IsInputChannel(const std::string& channel);
/// What the processes made, one message or more for each image: covered by the determinism
/// contract.
bool IsOutputChannel(const std::string& channel);

/// Source of a run's input, frame by frame.
class FrameSource {
 public:
  virtual ~FrameSource() = default;
  /// Messages of the next frame, in the order in which they are to be published; empty at the end.
  virtual std::vector<Envelope> NextFrame() = 0;
  /// How much of the source was handed out, 0..1.
  virtual double fraction_done() const = 0;
  /// What people should know about the source, a line each; given once.
  virtual std::vector<std::string> TakeNotes() = 0;
};

/// Which of a log's messages are the input of a run.
enum class LogInputs {
  kImages,    ///< those from outside
  kFeatures,  ///< also what the frontend and the human tracker made of them
};

/// The input channels of a log, in the log's order. A frame ends before the first message of a
/// newer one; messages that come late travel with the frame in which they came.
///
/// Messages without a header are left out. So are those whose header cannot be right: one flipped
/// bit of a session or an image number, taken for true, would make all that follows late. A message
/// of a new session, or of an image further ahead than the next one of its session, counts only
/// if one of the next kLookahead messages agrees (the same session, not an older image), or if none
/// follows. TakeNotes() tells how many were left out.
class LogSource : public FrameSource {
 public:
  static constexpr std::size_t kLookahead = 16;
  /// A frame is handed out in pieces of at most so many messages.
  static constexpr std::size_t kMaxFrameMessages = 100;

  /// Frames with first_seq <= seq <= last_seq; calibrations from before are kept.
  explicit LogSource(const std::string& path,
                     std::int64_t first_seq = std::numeric_limits<std::int64_t>::min(),
                     std::int64_t last_seq = std::numeric_limits<std::int64_t>::max(),
                     LogInputs inputs = LogInputs::kImages);

  /// Throws InputError where the log holds no message that it could give.
  std::vector<Envelope> NextFrame() override;
  double fraction_done() const override;
  std::vector<std::string> TakeNotes() override { return std::exchange(notes_, {}); }

 private:
  struct Input {
    Header header;
    LogEvent event;
  };

  /// The next message that is input, whatever its header says.
  std::optional<Input> ReadInput();
  /// The next one whose header may be right.
  std::optional<Input> NextInput();
  bool IsCredible(const Header& header) const;
  void Remember(const Header& header);
  void NoteDamage();

  EventLogReader reader_;
  std::int64_t first_seq_;
  std::int64_t last_seq_;
  LogInputs inputs_;
  std::int64_t num_without_header_ = 0;
  std::int64_t num_incredible_ = 0;
  std::deque<Input> ahead_;  // read, not yet looked at
  std::vector<std::string> notes_;
  std::deque<Header> newest_;  // of what was credible, one a session
  Header frame_;               // of the frame that is handed out
  std::optional<Input> next_;  // first message of the frame to come
  bool is_at_end_ = false;
};

}  // namespace airdos

#endif  // AIRDOS_PROCESSES_NODE_LOG_SOURCE_H_
