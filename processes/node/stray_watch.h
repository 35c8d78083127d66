#ifndef AIRDOS_PROCESSES_NODE_STRAY_WATCH_H_
#define AIRDOS_PROCESSES_NODE_STRAY_WATCH_H_

#include <cstdint>
#include <optional>
#include <string>
#include <utility>

#include "processes/node/message/header.h"

namespace airdos {

/// Watches the numbers of one channel's messages and reports why many of them cannot be used: the
/// same session is being played again, the source does not count, or the frames were completed
/// before the messages came. Single strays (duplicates, or two messages that changed places) are
/// ignored. The caller tells which messages are new and which are refused.
class StrayWatch {
 public:
  /// This many in a row are no accident.
  static constexpr int kMinStrays = 3;

  /// `says_again`: whether this channel reports sessions that are played again. That affects all
  /// channels of a source, but one report is enough.
  StrayWatch(std::string channel, bool says_again)
      : channel_(std::move(channel)), says_again_(says_again) {}

  /// Adds a message that is used in its frame.
  void AddNew(const Header& header);
  /// Adds a message that is too late or a duplicate. Returns a warning, or an empty text.
  std::string AddRefused(const Header& header);

  /// Among the messages used: the first one in the newest one's session, and the newest.
  const std::optional<Header>& first_of_session() const { return first_of_session_; }
  const std::optional<Header>& newest() const { return newest_; }

 private:
  /// Increasing numbers that are all refused. Where accepted messages come in between, the numbers
  /// must be consecutive.
  struct Run {
    std::optional<Header> last;
    int count = 0;
    bool is_interrupted = false;
    /// Returns true once, when there are enough of them.
    bool Add(const Header& header);
  };

  std::string AlreadyWorkedOn(std::int64_t session) const;

  std::string channel_;
  bool says_again_;
  std::optional<Header> first_of_session_;
  std::optional<Header> newest_;
  Run again_;
  Run too_late_;
  int num_same_number_ = 0;  // messages with the newest number, but other times
};

}  // namespace airdos

#endif  // AIRDOS_PROCESSES_NODE_STRAY_WATCH_H_
