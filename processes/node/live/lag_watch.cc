#include "processes/node/live/lag_watch.h"

#include <algorithm>
#include <utility>

#include "common/util/format.h"

namespace airdos {

void LagWatch::OnStatus(const process_status_t& status) {
  constexpr std::size_t kMostProcesses = 64;  // anybody may publish anything
  constexpr double kLeast_s = 1;
  constexpr double kCaughtUp_s = 0.5;
  const bool is_at_work = status.state == process_status_t::STATE_READY ||
                          status.state == process_status_t::STATE_STALLED;
  const bool is_ours = newest_ && status.session == newest_->session &&
                       status.num_frames_done > 0 && status.seq <= newest_->seq;
  if (!is_at_work || !is_ours) {
    lag_s_.erase(status.process);
    return;
  }
  if (lag_s_.size() >= kMostProcesses && lag_s_.count(status.process) == 0) return;
  // In floating point: the difference of hostile times may not fit into an integer.
  lag_s_[status.process] =
      1e-6 * (static_cast<double>(newest_->utime) - static_cast<double>(status.utime));
  const auto worst =
      std::max_element(lag_s_.begin(), lag_s_.end(),
                       [](const auto& a, const auto& b) { return a.second < b.second; });
  if (worst->second >= std::max(kLeast_s, 1.25 * said_s_ + (said_s_ > 0 ? kLeast_s : 0))) {
    said_s_ = worst->second;
    notes_.push_back(Format("warning: %.1f s behind, growing: %s has done image %lld of %lld",
                            worst->second, worst->first.c_str(), static_cast<long long>(status.seq),
                            static_cast<long long>(newest_->seq)));
  } else if (said_s_ > 0 && worst->second < kCaughtUp_s) {
    said_s_ = 0;
    notes_.emplace_back("all processes have caught up");
  }
}

std::vector<std::string> LagWatch::TakeNotes() { return std::exchange(notes_, {}); }

}  // namespace airdos
