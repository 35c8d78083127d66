#ifndef AIRDOS_PROCESSES_NODE_PARTNER_WATCH_H_
#define AIRDOS_PROCESSES_NODE_PARTNER_WATCH_H_

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "processes/node/message/header.h"
#include "processes/node/stray_watch.h"

namespace airdos {

/// Says when something that is watched frame by frame is to be judged: after the first ten frames,
/// when it is not too late to stop, and then after each hundred.
class LookSchedule {
 public:
  static constexpr int kFirstLook = 10;
  static constexpr int kLook = 100;
  /// Counts a frame; whether it is time to look.
  bool IsDue() { return ++num_frames_ == kFirstLook || num_frames_ % kLook == 0; }

 private:
  int num_frames_ = 0;
};

/// Whether a channel has a message of the same number, session and time for the left images of a
/// session: drivers of two cameras that count for themselves seldom do. Says each thing once.
class PartnerWatch {
 public:
  /// `what` is the name of one message, "right image". A channel that may be silent is judged only
  /// once something came on it.
  PartnerWatch(std::string channel, std::string what, bool may_be_silent)
      : channel_(std::move(channel)), what_(std::move(what)), may_be_silent_(may_be_silent) {}

  /// A frame that has its left image. Returns what is to be said now; empty if nothing.
  std::string Add(const Header& left, const std::optional<Header>& partner,
                  const StrayWatch& left_numbers, const StrayWatch& numbers);

 private:
  std::string JudgeNumbers(std::int64_t session, const StrayWatch& left_numbers,
                           const StrayWatch& numbers);
  std::string JudgeTimes();

  std::string channel_;
  std::string what_;
  bool may_be_silent_;
  LookSchedule schedule_;
  std::optional<std::int64_t> last_utime_;
  int num_left_ = 0;  // since the last look
  int num_with_partner_ = 0;
  std::vector<double> steps_us_;    // from one left image to the next
  std::vector<double> offsets_us_;  // from a left image to its partner, without sign
  bool are_numbers_said_ = false;
  bool are_times_said_ = false;
};

}  // namespace airdos

#endif  // AIRDOS_PROCESSES_NODE_PARTNER_WATCH_H_
