#ifndef AIRDOS_PROCESSES_NODE_LOG_LOG_PAIRING_H_
#define AIRDOS_PROCESSES_NODE_LOG_LOG_PAIRING_H_

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "processes/node/message/header.h"

namespace airdos {

/// How the messages of a log go together. The processes join them with the left image by session
/// and image number, so a right camera that counts from elsewhere gives no pose at all, and whoever
/// made the log must be told why. Keeps the headers alone: 24 bytes a message, of logs whose
/// messages have thousands.
class LogPairing {
 public:
  /// What does not fit, for people. `seq` is that of the first message concerned, if there is one.
  struct Remark {
    bool is_error = false;
    std::string kind;     ///< as findings have it: "log.partners"
    std::string channel;  ///< or several; empty: the whole log
    std::optional<std::int64_t> seq;
    std::string text;
  };

  /// A message of an input channel; of CALIBRATION, which belongs to no image, none is taken.
  void Add(const std::string& channel, const Header& header);

  /// Says each kind of mistake once a channel, with a count and its likely cause. Channels without
  /// any message are not asked for. `is_cut`: the log goes on, so the newest images may still get
  /// their partners.
  std::vector<Remark> Remarks(bool is_cut = false) const;

  bool Has(const std::string& channel) const { return headers_.count(channel) > 0; }
  /// Whether all messages of the channel, two or more, have one number: then its order, gaps and
  /// repetitions say nothing.
  bool HasOneNumber(const std::string& channel) const;

 private:
  using Key = std::pair<std::int64_t, std::int64_t>;  // session, seq
  using Headers = std::vector<Header>;

  void CheckNumbers(std::vector<Remark>* remarks) const;
  void CheckPartners(const std::string& channel, const std::map<Key, Header>& lefts, bool is_cut,
                     std::vector<Remark>* remarks) const;
  void CheckTimes(const std::string& channel, const std::map<Key, Header>& lefts,
                  std::vector<Remark>* remarks) const;
  const Headers& Of(const std::string& channel) const;
  /// Likely cause why numbers differ: "its numbers are those of CAMERA_LEFT + 1000 …".
  std::string WhyApart(const std::string& channel) const;

  std::map<std::string, Headers> headers_;
};

}  // namespace airdos

#endif  // AIRDOS_PROCESSES_NODE_LOG_LOG_PAIRING_H_
