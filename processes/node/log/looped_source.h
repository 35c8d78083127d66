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

/// A source again and again as one long session: capture times and image numbers go on where the
/// time before ended (a mean frame interval later), everything else is as it was. The scene jumps
/// where it starts again. For long runs: what grows with their length shows. Whatever session the
/// messages had, all have that of the first. Played once, nothing is changed.
class LoopedSource : public FrameSource {
 public:
  using Open = std::function<std::unique_ptr<FrameSource>()>;

  /// `open` opens the source from its beginning; called num_loops times.
  LoopedSource(Open open, int num_loops);

  std::vector<Envelope> NextFrame() override;
  double fraction_done() const override;
  /// Each once, however often it is played.
  std::vector<std::string> TakeNotes() override;

 private:
  void Shift(Envelope* message);

  Open open_;
  int num_loops_;
  int loop_ = 0;
  std::unique_ptr<FrameSource> source_;
  std::optional<Header> first_;
  Header last_;  // newest of the first time
  Header shift_;
  std::set<std::string> said_;
};

}  // namespace airdos

#endif  // AIRDOS_PROCESSES_NODE_LOG_LOOPED_SOURCE_H_
