#include "processes/node/stray_watch.h"

namespace airdos {

bool StrayWatch::Run::Add(const Header& header) {
  const bool is_same_session = last && last->session == header.session;
  if (is_same_session && header.seq == last->seq) return false;
  const bool goes_on =
      is_same_session && header.seq > last->seq && (!is_interrupted || header.seq == last->seq + 1);
  last = header;
  is_interrupted = false;
  count = goes_on ? count + 1 : 1;
  return count == kMinStrays;
}

void StrayWatch::AddNew(const Header& header) {
  if (!newest_ || newest_->session != header.session) first_of_session_ = header;
  newest_ = header;
  num_same_number_ = 0;
  again_.is_interrupted = true;
  too_late_ = Run();
}

std::string StrayWatch::AlreadyWorkedOn(std::int64_t session) const {
  std::string text = "session " + std::to_string(session) + " was already processed";
  text += newest_->session == session
              ? " up to image " + std::to_string(newest_->seq)
              : ", session " + std::to_string(newest_->session) + " came after it";
  return text +
         ": repeated messages are dropped; to play it again use replay_log.sh (a new session "
         "each time) or airdos-stereo-player --data LOG --session N, or restart the processes";
}

std::string StrayWatch::AddRefused(const Header& header) {
  if (newest_ && newest_->session == header.session && newest_->seq == header.seq) {
    if (newest_->utime == header.utime || ++num_same_number_ != kMinStrays) return "";
    return channel_ + ": number " + std::to_string(header.seq) +
           " comes again and again, each time with another utime: the images are dropped; seq must "
           "count them";
  }
  const bool is_again =
      newest_ && (newest_->session != header.session || header.seq < newest_->seq);
  if (is_again) {
    return again_.Add(header) && says_again_ ? AlreadyWorkedOn(header.session) : "";
  }
  if (!too_late_.Add(header)) return "";
  return channel_ + ": image " + std::to_string(header.seq) +
         " comes after that frame, or a later one, was processed without it: it is dropped, and so "
         "were those before; do all channels count from the same number? Otherwise a larger "
         "--deadline-s helps";
}

}  // namespace airdos
