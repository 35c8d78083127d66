#include "processes/node/log/partial_source.h"

#include <algorithm>
#include <utility>

#include "common/util/error.h"
#include "processes/node/message/channels.h"

namespace airdos {

std::vector<std::string> ChannelsOfPeople(const std::string& option,
                                          const std::vector<std::string>& words) {
  std::vector<std::string> channels;
  for (const std::string& word : words) {
    if (word == "keypoints") {
      channels.insert(channels.end(),
                      {channel::kPersonKeypointsLeft, channel::kPersonKeypointsRight});
    } else if (word == "masks") {
      channels.emplace_back(channel::kPersonMask);
    } else {
      throw InputError(option + ": '" + word + "' is neither keypoints nor masks");
    }
  }
  return channels;
}

PartialSource::PartialSource(std::unique_ptr<FrameSource> source, std::vector<std::string> without)
    : source_(std::move(source)), without_(std::move(without)) {}

std::vector<Envelope> PartialSource::NextFrame() {
  while (true) {
    std::vector<Envelope> frame = source_->NextFrame();
    if (frame.empty()) return frame;  // the end
    const auto is_left_out = [this](const Envelope& message) {
      return std::find(without_.begin(), without_.end(), message.channel) != without_.end();
    };
    frame.erase(std::remove_if(frame.begin(), frame.end(), is_left_out), frame.end());
    if (!frame.empty()) return frame;
  }
}

}  // namespace airdos
