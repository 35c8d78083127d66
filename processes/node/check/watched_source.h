#ifndef AIRDOS_PROCESSES_NODE_CHECK_WATCHED_SOURCE_H_
#define AIRDOS_PROCESSES_NODE_CHECK_WATCHED_SOURCE_H_

#include <memory>
#include <string>
#include <vector>

#include "common/check/row_watch.h"
#include "processes/node/log/log_source.h"

namespace airdos {

/// A source whose images are watched while they are handed out, checked beforehand or not:
/// TakeNotes() also says ("warning: NAME: …") where they are not rectified. Everything else is
/// unchanged.
class WatchedSource : public FrameSource {
 public:
  /// `name` stands for the input in warnings. The watch is not owned, so that one can go on where
  /// an input is opened again and again.
  WatchedSource(std::unique_ptr<FrameSource> source, std::string name, RowWatch* rows);

  std::vector<Envelope> NextFrame() override;
  double fraction_done() const override { return source_->fraction_done(); }
  std::vector<std::string> TakeNotes() override;

 private:
  std::unique_ptr<FrameSource> source_;
  std::string name_;
  RowWatch* rows_;
};

/// What to do about unrectified images that `program` plays from a log or data set: RowWatch's
/// `mend`.
std::string HowToRectify(const std::string& program);

}  // namespace airdos

#endif  // AIRDOS_PROCESSES_NODE_CHECK_WATCHED_SOURCE_H_
