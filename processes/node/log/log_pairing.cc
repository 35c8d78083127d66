#include "processes/node/log/log_pairing.h"

#include <algorithm>
#include <cmath>

#include "processes/node/message/channels.h"

namespace airdos {
namespace {

constexpr std::size_t kNewestOfCutLog = 16;  // frames that may still wait for their partners
constexpr double kMostOf = 0.8;              // a cause must explain this share

std::string OfAll(std::size_t count, std::size_t all) {
  return std::to_string(count) + " of " + std::to_string(all);
}

/// A difference as " + 1000" or " - 3".
std::string Signed(std::int64_t difference) {
  return (difference < 0 ? " - " : " + ") + std::to_string(std::abs(difference));
}

std::set<std::int64_t> SessionsOf(const std::vector<Header>& headers) {
  std::set<std::int64_t> sessions;
  for (const Header& header : headers) sessions.insert(header.session);
  return sessions;
}

std::string Range(const std::vector<Header>& headers) {
  const auto [min, max] =
      std::minmax_element(headers.begin(), headers.end(),
                          [](const Header& a, const Header& b) { return a.seq < b.seq; });
  return std::to_string(min->seq) + " to " + std::to_string(max->seq);
}

/// The difference found in most of `num` comparisons, if there is one. Differences wrap around,
/// because hostile numbers would overflow.
std::optional<std::int64_t> Commonest(const std::map<std::int64_t, std::size_t>& counts,
                                      std::size_t num) {
  const auto best =
      std::max_element(counts.begin(), counts.end(),
                       [](const auto& a, const auto& b) { return a.second < b.second; });
  if (best == counts.end() ||
      static_cast<double>(best->second) < kMostOf * static_cast<double>(num))
    return std::nullopt;
  return best->first;
}

std::int64_t Minus(std::int64_t a, std::int64_t b) {
  return static_cast<std::int64_t>(static_cast<std::uint64_t>(a) - static_cast<std::uint64_t>(b));
}

bool IsThousandfold(std::int64_t a, std::int64_t b) {
  const double ratio = b == 0 ? 0 : static_cast<double>(a) / static_cast<double>(b);
  return std::abs(ratio - 1e3) < 1 || std::abs(ratio - 1e-3) < 1e-6;
}

/// Compares the numbers of messages with the same capture time.
struct ByTime {
  std::size_t num_matched = 0;
  std::optional<std::int64_t> difference;  // between their numbers
};

ByTime JoinByTime(const std::vector<Header>& lefts, const std::vector<Header>& others) {
  std::map<std::int64_t, std::int64_t> seq_at;
  for (const Header& left : lefts) seq_at.emplace(left.utime, left.seq);
  ByTime result;
  if (2 * seq_at.size() < lefts.size()) return result;  // repeated times are not informative
  std::map<std::int64_t, std::size_t> counts;
  for (const Header& other : others) {
    const auto left = seq_at.find(other.utime);
    if (left == seq_at.end()) continue;
    ++result.num_matched;
    ++counts[Minus(other.seq, left->second)];
  }
  result.difference = Commonest(counts, result.num_matched);
  return result;
}

std::optional<std::int64_t> DifferenceByOrder(const std::vector<Header>& lefts,
                                              const std::vector<Header>& others) {
  const std::size_t num = std::min(lefts.size(), others.size());
  std::map<std::int64_t, std::size_t> counts;
  for (std::size_t i = 0; i < num; ++i) ++counts[Minus(others[i].seq, lefts[i].seq)];
  return Commonest(counts, num);
}

}  // namespace

void LogPairing::Add(const std::string& channel, const Header& header) {
  if (channel != channel::kCalibration) headers_[channel].push_back(header);
}

const LogPairing::Headers& LogPairing::Of(const std::string& channel) const {
  static const Headers none;
  const auto it = headers_.find(channel);
  return it == headers_.end() ? none : it->second;
}

bool LogPairing::HasOneNumber(const std::string& channel) const {
  const Headers& headers = Of(channel);
  return headers.size() >= 2 &&
         std::all_of(headers.begin(), headers.end(),
                     [&](const Header& header) { return header.seq == headers[0].seq; });
}

void LogPairing::CheckNumbers(std::vector<Remark>* remarks) const {
  std::map<std::int64_t, std::string> with_number;
  for (const auto& [name, headers] : headers_) {
    if (!HasOneNumber(name)) continue;
    std::string& names = with_number[headers[0].seq];
    names += (names.empty() ? "" : ", ") + name;
  }
  for (const auto& [number, names] : with_number) {
    remarks->push_back({true, "log.numbers", names, std::nullopt,
                        "all messages have number " + std::to_string(number) +
                            " (seq): number the images 0, 1, 2, …, and give every message of one "
                            "image its number"});
  }
  for (const auto& [name, headers] : headers_) {
    if (headers.size() < 3 || SessionsOf(headers).size() < headers.size()) continue;
    remarks->push_back({true, "log.numbers", name, std::nullopt,
                        "each of the " + std::to_string(headers.size()) +
                            " messages has its own session: a session is one run of the "
                            "source, and its number stays the same until the source restarts"});
  }
}

std::string LogPairing::WhyApart(const std::string& channel) const {
  const Headers& lefts = Of(channel::kCameraLeft);
  const Headers& others = Of(channel);
  const std::set<std::int64_t> sessions = SessionsOf(others);
  const std::set<std::int64_t> left_sessions = SessionsOf(lefts);
  const bool shares_session =
      std::any_of(sessions.begin(), sessions.end(),
                  [&](std::int64_t session) { return left_sessions.count(session) > 0; });
  if (!shares_session) {
    return "its session is " + std::to_string(*sessions.begin()) + ", that of CAMERA_LEFT " +
           std::to_string(*left_sessions.begin()) +
           ": a source must give all messages of its images the same session";
  }
  const std::string remedy = "give all messages of one image the same number (seq)";
  const ByTime by_time = JoinByTime(lefts, others);
  if (2 * by_time.num_matched >= std::min(lefts.size(), others.size())) {
    if (!by_time.difference) return "capture times agree, numbers do not: " + remedy;
    if (*by_time.difference != 0) {
      return "where capture times agree, its numbers are those of CAMERA_LEFT" +
             Signed(*by_time.difference) + ": " + remedy;
    }
  }
  const std::optional<std::int64_t> by_order = DifferenceByOrder(lefts, others);
  if (by_order && *by_order != 0) {
    return "in the order of the log its numbers are those of CAMERA_LEFT" + Signed(*by_order) +
           ": " + remedy;
  }
  return "its numbers are " + Range(others) + ", those of CAMERA_LEFT " + Range(lefts);
}

void LogPairing::CheckPartners(const std::string& channel, const std::map<Key, Header>& lefts,
                               bool is_cut, std::vector<Remark>* remarks) const {
  std::set<Key> keys;
  for (const Header& header : Of(channel)) keys.insert({header.session, header.seq});
  std::size_t num_alone = 0;
  std::optional<std::int64_t> first;
  for (const auto& [key, header] : lefts) {
    if (keys.count(key) > 0) continue;
    ++num_alone;
    if (!first) first = key.second;
  }
  const std::size_t num_extra = keys.size() - (lefts.size() - num_alone);
  const bool is_truth = channel == channel::kGroundTruth;
  if (num_alone > 0) {
    const bool has_none = num_alone == lefts.size();
    // Without a right image there is no measurement; without the other inputs a frame has just
    // less.
    const bool is_error =
        !is_truth &&
        (has_none || (channel == channel::kCameraRight && 2 * num_alone > lefts.size()));
    std::string text = OfAll(num_alone, lefts.size()) +
                       " left images have no message with their number and session here";
    text += has_none ? ": " + WhyApart(channel) : ", the first is " + std::to_string(*first);
    if (!has_none && is_error) text += ": " + WhyApart(channel);
    remarks->push_back({is_error, "log.partners", channel, std::nullopt, text});
    if (has_none) return;
  }
  if (is_truth || is_cut || num_extra == 0) return;
  remarks->push_back(
      {false, "log.partners", channel, std::nullopt,
       OfAll(num_extra, keys.size()) + " messages have a number that CAMERA_LEFT does not have"});
}

void LogPairing::CheckTimes(const std::string& channel, const std::map<Key, Header>& lefts,
                            std::vector<Remark>* remarks) const {
  std::size_t num_joined = 0;
  std::size_t num_other = 0;
  std::size_t num_thousandfold = 0;
  std::map<std::int64_t, std::size_t> differences_us;
  std::optional<std::pair<Header, Header>> first;
  for (const Header& header : Of(channel)) {
    const auto left = lefts.find({header.session, header.seq});
    if (left == lefts.end()) continue;
    ++num_joined;
    if (left->second.utime == header.utime) continue;
    if (num_other++ == 0) first = {header, left->second};
    ++differences_us[Minus(header.utime, left->second.utime)];
    num_thousandfold += IsThousandfold(header.utime, left->second.utime) ? 1 : 0;
  }
  if (num_other == 0) return;
  std::string text = "has another capture time (" + std::to_string(first->first.utime) +
                     ") than CAMERA_LEFT with this number (" + std::to_string(first->second.utime) +
                     ")";
  if (num_other > 1) text += ", and so have " + OfAll(num_other, num_joined);
  const ByTime by_time = JoinByTime(Of(channel::kCameraLeft), Of(channel));
  if (2 * num_thousandfold > num_other) {
    text += ": one is 1000 times the other, so one of them is not in us";
  } else if (by_time.num_matched > num_other / 2 && by_time.difference &&
             *by_time.difference != 0) {
    text += ": " + WhyApart(channel);
  } else if (const auto always = Commonest(differences_us, num_other); always && num_other > 1) {
    text += ", by" + Signed(*always) + " us: give all messages of one image the same capture time";
  }
  remarks->push_back({true, "log.utime", channel, first->first.seq, text});
}

std::vector<LogPairing::Remark> LogPairing::Remarks(bool is_cut) const {
  std::vector<Remark> remarks;
  CheckNumbers(&remarks);
  const Headers& all_lefts = Of(channel::kCameraLeft);
  const bool is_hopeless = std::any_of(remarks.begin(), remarks.end(), [](const Remark& remark) {
    return remark.channel.find(channel::kCameraLeft) != std::string::npos;
  });
  if (all_lefts.empty() || is_hopeless) return remarks;
  std::map<Key, Header> lefts;
  const std::size_t num_newest =
      is_cut && all_lefts.size() > 2 * kNewestOfCutLog ? kNewestOfCutLog : 0;
  for (std::size_t i = 0; i + num_newest < all_lefts.size(); ++i)
    lefts.emplace(Key{all_lefts[i].session, all_lefts[i].seq}, all_lefts[i]);
  for (const auto& [name, headers] : headers_) {
    if (name == channel::kCameraLeft || HasOneNumber(name)) continue;
    CheckPartners(name, lefts, is_cut, &remarks);
    if (name != channel::kGroundTruth) CheckTimes(name, lefts, &remarks);
  }
  return remarks;
}

}  // namespace airdos
