#include "processes/node/log/looped_source.h"

#include <algorithm>
#include <utility>

namespace airdos {

LoopedSource::LoopedSource(Open open, int num_loops)
    : open_(std::move(open)), num_loops_(num_loops), source_(open_()) {}

std::vector<Envelope> LoopedSource::NextFrame() {
  std::vector<Envelope> frame = source_->NextFrame();
  if (frame.empty() && first_ && loop_ + 1 < num_loops_) {
    ++loop_;
    source_ = open_();
    const std::int64_t num_frames = last_.seq - first_->seq + 1;
    const std::int64_t length_us = last_.utime - first_->utime;
    shift_.seq = loop_ * num_frames;
    shift_.utime = loop_ * (length_us + length_us / std::max<std::int64_t>(1, num_frames - 1));
    frame = source_->NextFrame();
  }
  for (Envelope& message : frame) Shift(&message);
  return frame;
}

void LoopedSource::Shift(Envelope* message) {
  if (num_loops_ == 1) return;  // a log may contain several sessions
  const auto header = PeekHeader(message->payload.data(), message->payload.size());
  if (!header) return;
  if (!first_) first_ = last_ = *header;
  if (loop_ == 0) {
    last_.seq = std::max(last_.seq, header->seq);
    last_.utime = std::max(last_.utime, header->utime);
  }
  WriteHeader({header->utime + shift_.utime, header->seq + shift_.seq, first_->session},
              message->payload.data(), message->payload.size());
}

std::vector<std::string> LoopedSource::TakeNotes() {
  std::vector<std::string> notes;
  for (const std::string& note : source_->TakeNotes()) {
    if (said_.insert(note).second) notes.push_back(note);
  }
  return notes;
}

double LoopedSource::fraction_done() const {
  return (loop_ + source_->fraction_done()) / num_loops_;
}

}  // namespace airdos
