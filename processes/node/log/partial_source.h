#ifndef AIRDOS_PROCESSES_NODE_LOG_PARTIAL_SOURCE_H_
#define AIRDOS_PROCESSES_NODE_LOG_PARTIAL_SOURCE_H_

#include <memory>
#include <string>
#include <vector>

#include "processes/node/log/log_source.h"

namespace airdos {

/// The channels that "keypoints" and "masks" stand for: what a person detector publishes, if it is
/// not the source. Throws InputError, naming `option`, for other words.
std::vector<std::string> ChannelsOfPeople(const std::string& option,
                                          const std::vector<std::string>& words);

/// A source without some of its channels, because somebody else publishes them: each channel has
/// one publisher.
class PartialSource : public FrameSource {
 public:
  PartialSource(std::unique_ptr<FrameSource> source, std::vector<std::string> without);

  std::vector<Envelope> NextFrame() override;
  double fraction_done() const override { return source_->fraction_done(); }
  std::vector<std::string> TakeNotes() override { return source_->TakeNotes(); }

 private:
  std::unique_ptr<FrameSource> source_;
  std::vector<std::string> without_;
};

}  // namespace airdos

#endif  // AIRDOS_PROCESSES_NODE_LOG_PARTIAL_SOURCE_H_
