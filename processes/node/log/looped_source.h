#ifndef AIRDOS_PROCESSES_NODE_LOG_LOOPED_SOURCE_H_
#define AIRDOS_PROCESSES_NODE_LOG_LOOPED_SOURCE_H_

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "processes/node/log/log_source.h"

namespace airdos {

/// Plays a source repeatedly as one long session: capture times and image numbers continue where
/// the previous loop ended (a mean frame interval later), and everything else is unchanged. The
/// scene jumps at each restart. Meant for long runs, to reveal what grows with their length. All
/// messages get the session of the first one. With a single loop, nothing is changed.
class LoopedSource : public FrameSource {
 public:
  using Open = std::function<std::unique_ptr<FrameSource>()>;

  /// `open` opens the source from its beginning; it is called num_loops times.
  LoopedSource(Open open, int num_loops);

  std::vector<Envelope> NextFrame() override;
  double fraction_done() const override;
  /// Each note once, however often the source is played.
  std::vector<std::string> TakeNotes() override;

 private:
  void Shift(Envelope* message);

  Open open_;
  int num_loops_;
  int loop_ = 0;
  std::unique_ptr<FrameSource> source_;
  std::optional<Header> first_;
  Header last_;  // newest header of the first loop
  Header shift_;
  std::set<std::string> said_;
};

}  // namespace airdos

#endif  // AIRDOS_PROCESSES_NODE_LOG_LOOPED_SOURCE_H_
