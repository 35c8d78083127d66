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

/// When to judge something that is watched frame by frame: after the first ten frames, when it is
/// not too late to stop, and then after every hundred.
class LookSchedule {
 public:
  static constexpr int kFirstLook = 10;
  static constexpr int kLook = 100;
  /// Counts a frame; returns whether to judge now.
  bool IsDue() { return ++num_frames_ == kFirstLook || num_frames_ % kLook == 0; }

 private:
  int num_frames_ = 0;
};

/// Watches whether the left images of a session have messages with the same number, session and
/// time on another channel; this is rarely so if the drivers of two cameras count independently.
/// Reports each problem once.
class PartnerWatch {
 public:
  /// `what` is what one message is called, such as "right image". A channel that may be silent is
  /// judged only once something has arrived on it.
  PartnerWatch(std::string channel, std::string what, bool may_be_silent)
      : channel_(std::move(channel)), what_(std::move(what)), may_be_silent_(may_be_silent) {}

  /// Adds a frame that has its left image. Returns a warning, or an empty text.
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
  int num_left_ = 0;  // since the last judgement
  int num_with_partner_ = 0;
  std::vector<double> steps_us_;    // between consecutive left images
  std::vector<double> offsets_us_;  // between a left image and its partner, absolute values
  bool are_numbers_said_ = false;
  bool are_times_said_ = false;
};

}  // namespace airdos

#endif  // AIRDOS_PROCESSES_NODE_PARTNER_WATCH_H_
