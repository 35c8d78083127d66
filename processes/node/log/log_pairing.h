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

/// Checks how the messages of a log belong together. The processes join them with the left image by
/// session and image number, so a right camera with a different numbering yields no pose at all,
/// and whoever made the log must be told why. Stores only the headers: 24 bytes per message, where
/// messages have thousands.
class LogPairing {
 public:
  /// A problem, for the user. `seq` is that of the first message concerned, if there is one.
  struct Remark {
    bool is_error = false;
    std::string kind;     ///< kind of the finding, such as "log.partners"
    std::string channel;  ///< or several channels; empty for the whole log
    std::optional<std::int64_t> seq;
    std::string text;
  };

  /// Adds a message of an input channel other than CALIBRATION, which belongs to no image.
  void Add(const std::string& channel, const Header& header);

  /// Reports each kind of mistake once per channel, with a count and its likely cause. Channels
  /// without any messages are not reported. `is_cut`: the log continues, so the newest images may
  /// still get their partners.
  std::vector<Remark> Remarks(bool is_cut = false) const;

  bool Has(const std::string& channel) const { return headers_.count(channel) > 0; }
  /// Whether all messages of the channel (two or more) have the same number: then its order, gaps
  /// and repetitions mean nothing.
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
  /// Likely cause of different numbers: "its numbers are those of CAMERA_LEFT + 1000 …".
  std::string WhyApart(const std::string& channel) const;

  std::map<std::string, Headers> headers_;
};

}  // namespace airdos

#endif  // AIRDOS_PROCESSES_NODE_LOG_LOG_PAIRING_H_
