#ifndef AIRDOS_PROCESSES_NODE_LOG_SOURCE_H_
#define AIRDOS_PROCESSES_NODE_LOG_SOURCE_H_

#include <cstddef>
#include <cstdint>
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
/// newer one; messages that come late travel with the frame in which they came. Messages without a
/// header are dropped and counted in damage().
class LogSource : public FrameSource {
 public:
  /// Frames with first_seq <= seq <= last_seq; calibrations from before are kept.
  explicit LogSource(const std::string& path,
                     std::int64_t first_seq = std::numeric_limits<std::int64_t>::min(),
                     std::int64_t last_seq = std::numeric_limits<std::int64_t>::max(),
                     LogInputs inputs = LogInputs::kImages);

  std::vector<Envelope> NextFrame() override;
  double fraction_done() const override;
  std::vector<std::string> TakeNotes() override { return std::exchange(notes_, {}); }

 private:
  std::optional<LogEvent> NextInput(Header* header);
  void NoteDamage();

  EventLogReader reader_;
  std::int64_t first_seq_;
  std::int64_t last_seq_;
  LogInputs inputs_;
  std::int64_t num_without_header_ = 0;
  std::vector<std::string> notes_;
  std::optional<Header> newest_;
  std::optional<LogEvent> next_;  // first message of the frame to come
  Header next_header_;
  bool is_at_end_ = false;
};

}  // namespace airdos

#endif  // AIRDOS_PROCESSES_NODE_LOG_SOURCE_H_
