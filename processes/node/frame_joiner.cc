#include "processes/node/frame_joiner.h"

#include <algorithm>

#include "common/util/check.h"

namespace airdos {

FrameJoiner::FrameJoiner(int num_inputs, int reorder_window)
    : num_inputs_(static_cast<std::size_t>(num_inputs)),
      reorder_window_(reorder_window),
      newest_(num_inputs_) {
  AIRDOS_CHECK(num_inputs > 0 && reorder_window >= 0);
}

bool FrameJoiner::IsOvertaken(std::size_t input, const Key& key) const {
  const std::optional<Key>& newest = newest_[input];
  return newest && Key{key.session_rank, key.seq + reorder_window_} < *newest;
}

bool FrameJoiner::MayHavePredecessor(const Key& key) const {
  if (key.seq == 0) return false;
  if (last_done_ && last_done_->session_rank == key.session_rank &&
      last_done_->seq + 1 == key.seq) {
    return false;
  }
  const Key predecessor{key.session_rank, key.seq - 1};
  for (std::size_t input = 0; input < num_inputs_; ++input) {
    if (!IsOvertaken(input, predecessor)) return true;
  }
  return false;
}

std::int64_t FrameJoiner::RankOf(std::int64_t session) {
  const auto [entry, is_new] = session_ranks_.try_emplace(session, num_sessions_);
  const std::int64_t rank = entry->second;
  if (!is_new) return rank;
  ++num_sessions_;
  if (session_ranks_.size() > kMaxSessions) {
    session_ranks_.erase(
        std::min_element(session_ranks_.begin(), session_ranks_.end(),
                         [](const auto& a, const auto& b) { return a.second < b.second; }));
  }
  return rank;
}

FrameJoiner::Arrival FrameJoiner::Announce(int input, const Header& header, Key* key) {
  const auto slot = static_cast<std::size_t>(input);
  AIRDOS_CHECK(input >= 0 && slot < num_inputs_);
  key->session_rank = RankOf(header.session);
  key->seq = header.seq;

  // Not "is the frame done": that would depend on how far the other channels are.
  if (IsOvertaken(slot, *key)) return Arrival::kLate;
  if (newest_[slot] && newest_[slot]->session_rank == key->session_rank &&
      key->seq > newest_[slot]->seq + kMaxAhead) {
    return Arrival::kTooFar;
  }
  if (!newest_[slot] || *newest_[slot] < *key) newest_[slot] = *key;
  // A frame can be done without being overtaken only after a deadline has expired.
  if (last_done_ && !(*last_done_ < *key)) return Arrival::kLate;

  auto [it, is_new] = pending_.try_emplace(*key);
  if (is_new) {
    it->second.arrived.assign(num_inputs_, false);
  }
  if (is_new || slot < it->second.header_input) {
    it->second.header = header;
    it->second.header_input = slot;
  }
  return it->second.arrived[slot] ? Arrival::kDuplicate : Arrival::kNew;
}

FrameJoiner::Arrival FrameJoiner::Add(int input, const Header& header, Key* key) {
  const Arrival arrival = Announce(input, header, key);
  if (arrival == Arrival::kNew) pending_.at(*key).arrived[static_cast<std::size_t>(input)] = true;
  return arrival;
}

std::optional<FrameJoiner::Frame> FrameJoiner::Oldest() const {
  if (pending_.empty()) return std::nullopt;
  const auto& [key, pending] = *pending_.begin();
  Frame frame{key, pending.header, {}, {}, false};
  for (std::size_t input = 0; input < num_inputs_; ++input) {
    if (pending.arrived[input]) continue;
    frame.missing.push_back(static_cast<int>(input));
    if (!IsOvertaken(input, key)) frame.awaited.push_back(static_cast<int>(input));
  }
  frame.settled = frame.awaited.empty() && !MayHavePredecessor(key);
  return frame;
}

std::optional<FrameJoiner::Key> FrameJoiner::NewestComplete(int num_newer) const {
  for (auto it = pending_.rbegin(); it != pending_.rend(); ++it) {
    const std::vector<bool>& arrived = it->second.arrived;
    if (std::find(arrived.begin(), arrived.end(), false) != arrived.end()) continue;
    if (num_newer-- == 0) return it->first;
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
