#ifndef AIRDOS_PROCESSES_NODE_STRAY_WATCH_H_
#define AIRDOS_PROCESSES_NODE_STRAY_WATCH_H_

#include <cstdint>
#include <optional>
#include <string>
#include <utility>

#include "processes/node/message/header.h"

namespace airdos {

/// Watches the numbers of one channel's messages and says why so many of them cannot be used: the
/// same session is played again, the source does not count, or the frames were completed before
/// they came. Single strays (duplicates, two that changed places) are no matter. Whoever takes the
/// messages in tells which ones are new and which are refused.
class StrayWatch {
 public:
  /// So many in a row are no accident.
  static constexpr int kMinStrays = 3;

  /// `says_again`: whether it is the channel that tells of sessions that are played again. All
  /// channels of one source play along; one that says so is enough.
  StrayWatch(std::string channel, bool says_again)
      : channel_(std::move(channel)), says_again_(says_again) {}

  /// A message that takes part in its frame.
  void AddNew(const Header& header);
  /// A message that comes too late, or twice. Returns what is to be said now; empty if nothing.
  std::string AddRefused(const Header& header);

  /// Of the messages that took part: the first one of the newest one's session, and the newest.
  const std::optional<Header>& first_of_session() const { return first_of_session_; }
  const std::optional<Header>& newest() const { return newest_; }

 private:
  /// Numbers that go on, one after the other, and are all refused. Between those of other
  /// messages, which are taken, they must follow on one another.
  struct Run {
    std::optional<Header> last;
    int count = 0;
    bool is_interrupted = false;
    /// True once, when there are enough of them.
    bool Add(const Header& header);
  };

  std::string AlreadyWorkedOn(std::int64_t session) const;

  std::string channel_;
  bool says_again_;
  std::optional<Header> first_of_session_;
  std::optional<Header> newest_;
  Run again_;
  Run too_late_;
  int num_same_number_ = 0;  // of the newest one, with other times
};

}  // namespace airdos

#endif  // AIRDOS_PROCESSES_NODE_STRAY_WATCH_H_
