#ifndef AIRDOS_PROCESSES_NODE_LOG_LOG_SOURCE_H_
#define AIRDOS_PROCESSES_NODE_LOG_LOG_SOURCE_H_

#include <cstddef>
#include <cstdint>
#include <deque>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "processes/node/frame_joiner.h"
#include "processes/node/log/event_log.h"
#include "processes/node/log/log_channels.h"
#include "processes/node/log/log_pairing.h"
#include "processes/node/node.h"

namespace airdos {

/// What every message of ours starts with, without knowing its type; nothing if the payload is too
/// short.
std::optional<Header> PeekHeader(const void* data, std::size_t size);
/// Puts another one in its place; nothing is done if the payload is too short.
void WriteHeader(const Header& header, void* data, std::size_t size);

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
/// follows. TakeNotes() tells how many were left out, and at the end which channels do not go with
/// CAMERA_LEFT (LogPairing): the processes would wait for their messages in vain.
class LogSource : public FrameSource {
 public:
  static constexpr std::size_t kLookahead = 16;
  /// A frame is handed out in pieces of at most so many messages.
  static constexpr std::size_t kMaxFrameMessages = 100;

  /// Frames with first_seq <= seq <= last_seq; calibrations from before are kept. Throws InputError
  /// where the file is no log, or has not one image (one message of STATIC_FEATURES, if those are
  /// wanted): then it says what it has.
  explicit LogSource(const std::string& path,
                     std::int64_t first_seq = std::numeric_limits<std::int64_t>::min(),
                     std::int64_t last_seq = std::numeric_limits<std::int64_t>::max(),
                     LogInputs inputs = LogInputs::kImages);

  /// Gives the sessions of the log new numbers: session, session + 1, … in their order, so that it
  /// can be played into processes that have seen it already. Without it bytes are as in the log.
  void RenumberSessions(std::int64_t session) { first_session_ = session; }

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
  void NotePairing();
  Envelope ToEnvelope(Input input);

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
  LogPairing pairing_;
  std::optional<std::int64_t> first_session_;        // of the new ones
  std::map<std::int64_t, std::int64_t> session_of_;  // the new one of each of the log
  bool is_at_end_ = false;
};

}  // namespace airdos

#endif  // AIRDOS_PROCESSES_NODE_LOG_LOG_SOURCE_H_
