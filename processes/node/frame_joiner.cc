#include "processes/node/frame_joiner.h"

#include <algorithm>

#include "common/util/check.h"

namespace airdos {

FrameJoiner::FrameJoiner(int num_inputs, int reorder_window)
    : num_inputs_(num_inputs),
      reorder_window_(reorder_window),
      newest_(static_cast<std::size_t>(num_inputs)) {}

FrameJoiner::Arrival FrameJoiner::Add(int input, const Header& header, Key* key) {
  AIRDOS_CHECK(input >= 0 && input < num_inputs_);
  const auto session = std::find(sessions_.begin(), sessions_.end(), header.session);
  key->session_rank = static_cast<int>(session - sessions_.begin());
  key->seq = header.seq;
  if (session == sessions_.end()) sessions_.push_back(header.session);

  const auto slot = static_cast<std::size_t>(input);
  if (!newest_[slot] || *newest_[slot] < *key) newest_[slot] = *key;
  if (last_done_ && !(*last_done_ < *key)) return Arrival::kLate;

  auto [it, is_new] = pending_.try_emplace(*key);
  if (is_new) {
    it->second.header = header;
    it->second.arrived.assign(static_cast<std::size_t>(num_inputs_), false);
  }
  if (it->second.arrived[slot]) return Arrival::kDuplicate;
  it->second.arrived[slot] = true;
  return Arrival::kNew;
}

std::optional<FrameJoiner::Frame> FrameJoiner::Oldest() const {
  if (pending_.empty()) return std::nullopt;
  const auto& [key, pending] = *pending_.begin();
  Frame frame{key, pending.header, {}, true};
  for (int input = 0; input < num_inputs_; ++input) {
    const auto slot = static_cast<std::size_t>(input);
    if (pending.arrived[slot]) continue;
    frame.missing.push_back(input);
    const Key overtaken_after{key.session_rank, key.seq + reorder_window_};
    if (!newest_[slot] || !(overtaken_after < *newest_[slot])) frame.settled = false;
  }
  return frame;
}

std::optional<FrameJoiner::Key> FrameJoiner::NewestComplete() const {
  for (auto it = pending_.rbegin(); it != pending_.rend(); ++it) {
    const std::vector<bool>& arrived = it->second.arrived;
    if (std::find(arrived.begin(), arrived.end(), false) == arrived.end()) return it->first;
  }
  return std::nullopt;
}

void FrameJoiner::FinishOldest(std::int64_t* num_skipped) {
  AIRDOS_CHECK(!pending_.empty());
  const Key key = pending_.begin()->first;
  const bool same_session = last_done_ && last_done_->session_rank == key.session_rank;
  *num_skipped = same_session ? key.seq - last_done_->seq - 1 : 0;
  last_done_ = key;
  pending_.erase(pending_.begin());
}

}  // namespace airdos
