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

/// The header common to all our messages, read without knowing the type; nothing if the payload is
/// too short.
std::optional<Header> PeekHeader(const void* data, std::size_t size);
/// Replaces the header; does nothing if the payload is too short.
void WriteHeader(const Header& header, void* data, std::size_t size);

/// Source of a run's input, frame by frame.
class FrameSource {
 public:
  virtual ~FrameSource() = default;
  /// The next frame's messages, in the order in which to publish them; empty at the end.
  virtual std::vector<Envelope> NextFrame() = 0;
  /// The fraction of the source that has been handed out, 0..1.
  virtual double fraction_done() const = 0;
  /// What the user should know about the source, one line each; each returned once.
  virtual std::vector<std::string> TakeNotes() = 0;
};

/// Which messages of a log are the input of a run.
enum class LogInputs {
  kImages,    ///< those that come from outside
  kFeatures,  ///< also the output of frontend and human tracker
};

/// The input channels of a log, in the log's order. A frame ends before the first message of a
/// newer one; messages that come late are handed out with the frame in which they came.
///
/// Messages without a header are skipped, and so are those whose header cannot be right: a single
/// flipped bit in a session or image number, if trusted, would make everything that follows late. A
/// message of a new session, or of an image further ahead than the next one of its session, counts
/// only if one of the next kLookahead messages agrees with it (same session, not an older image),
/// or if no message follows. TakeNotes() reports how many were skipped and, at the end, which
/// channels do not match CAMERA_LEFT (LogPairing), so that the processes would wait for their
/// messages in vain.
class LogSource : public FrameSource {
 public:
  static constexpr std::size_t kLookahead = 16;
  /// A frame is handed out in pieces of at most this many messages.
  static constexpr std::size_t kMaxFrameMessages = 100;

  /// Frames with first_seq <= seq <= last_seq; calibrations from before are kept. Throws
  /// InputError, listing the log's contents, if the file is not a log or has no image (or no
  /// message of STATIC_FEATURES, if those are the input).
  explicit LogSource(const std::string& path,
                     std::int64_t first_seq = std::numeric_limits<std::int64_t>::min(),
                     std::int64_t last_seq = std::numeric_limits<std::int64_t>::max(),
                     LogInputs inputs = LogInputs::kImages);

  /// Gives the sessions of the log new numbers, session, session + 1, … in their order, so that it
  /// can be played to processes that have already seen it. Without this call the bytes are as in
  /// the log.
  void RenumberSessions(std::int64_t session) { first_session_ = session; }

  /// Throws InputError if the log contains no usable message.
  std::vector<Envelope> NextFrame() override;
  double fraction_done() const override;
  std::vector<std::string> TakeNotes() override { return std::exchange(notes_, {}); }

 private:
  /// A message and its header.
  struct Input {
    Header header;
    LogEvent event;
  };

  /// The next input message, whatever its header.
  std::optional<Input> ReadInput();
  /// The next input message with a credible header.
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
  std::deque<Input> ahead_;  // read, but not yet examined
  std::vector<std::string> notes_;
  std::deque<Header> newest_;  // newest credible header of each session
  Header frame_;               // header of the frame being handed out
  std::optional<Input> next_;  // first message of the next frame
  LogPairing pairing_;
  std::optional<std::int64_t> first_session_;        // first of the new session numbers
  std::map<std::int64_t, std::int64_t> session_of_;  // new number of each session of the log
  bool is_at_end_ = false;
};

}  // namespace airdos

#endif  // AIRDOS_PROCESSES_NODE_LOG_LOG_SOURCE_H_
