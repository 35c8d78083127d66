#include "processes/node/check/watched_source.h"

#include <optional>
#include <utility>

#include "airdos/image_t.hpp"
#include "processes/node/message/channels.h"
#include "processes/node/message/codec.h"
#include "processes/node/message/image_codec.h"
#include "processes/node/message/validate.h"

namespace airdos {
namespace {

/// The newest message of the channel, or null.
const Envelope* LastOf(const std::vector<Envelope>& frame, const char* channel) {
  const Envelope* last = nullptr;
  for (const Envelope& message : frame) {
    if (message.channel == channel) last = &message;
  }
  return last;
}

std::optional<Header> HeaderOf(const Envelope* message) {
  if (message == nullptr) return std::nullopt;
  return PeekHeader(message->payload.data(), message->payload.size());
}

/// Of one image number, and taken together as the frontend sees it (FrontendNode::Images()).
bool IsPair(const std::optional<Header>& left, const std::optional<Header>& right) {
  constexpr std::int64_t kMaxApart_us = 20000;
  return left && right && left->session == right->session && left->seq == right->seq &&
         right->utime <= left->utime + kMaxApart_us && left->utime <= right->utime + kMaxApart_us;
}

std::optional<cv::Mat> GreyOf(const Envelope& message) {
  image_t image;
  const bool decodes = Decode(message.payload.data(), message.payload.size(), &image);
  if (!decodes || !Validate(image).empty()) return std::nullopt;
  return DecodeGray(image);
}

}  // namespace

WatchedSource::WatchedSource(std::unique_ptr<FrameSource> source, std::string name, RowWatch* rows)
    : source_(std::move(source)), name_(std::move(name)), rows_(rows) {}

std::vector<Envelope> WatchedSource::NextFrame() {
  std::vector<Envelope> frame = source_->NextFrame();
  if (frame.empty()) rows_->Finish();
  const Envelope* left = LastOf(frame, channel::kCameraLeft);
  const Envelope* right = LastOf(frame, channel::kCameraRight);
  if (!IsPair(HeaderOf(left), HeaderOf(right)) || !rows_->IsDue()) return frame;
  const std::optional<cv::Mat> left_image = GreyOf(*left);
  const std::optional<cv::Mat> right_image = GreyOf(*right);
  if (left_image && right_image && left_image->size() == right_image->size()) {
    rows_->Add(*left_image, *right_image);
  }
  return frame;
}

std::vector<std::string> WatchedSource::TakeNotes() {
  std::vector<std::string> notes = source_->TakeNotes();
  for (const std::string& warning : rows_->TakeWarnings()) {
    notes.push_back("warning: " + name_ + ": " + warning);
  }
  return notes;
}

std::string HowToRectify(const std::string& program) {
  return "play them as recorded, with their calibration: " + program +
         " --images LEFT RIGHT --calibration FILE";
}

}  // namespace airdos
