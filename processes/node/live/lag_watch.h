#ifndef AIRDOS_PROCESSES_NODE_LIVE_LAG_WATCH_H_
#define AIRDOS_PROCESSES_NODE_LIVE_LAG_WATCH_H_

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "airdos/process_status_t.hpp"
#include "processes/node/message/header.h"

namespace airdos {

/// For whoever publishes images as they come: tells when the processes fall behind. How far one is
/// behind is the capture time between the newest image published and the one that its STATUS says
/// it has done. Said for the one that is furthest behind, above a second and each time that another
/// second and a quarter of it have come on top; and when all have caught up. No clock, no network.
class LagWatch {
 public:
  void OnPublished(const Header& header) { newest_ = header; }
  /// A message that has passed Validate().
  void OnStatus(const process_status_t& status);

  /// One line each ("warning: 2.3 s behind, growing: …"); each returned once.
  std::vector<std::string> TakeNotes();

 private:
  std::optional<Header> newest_;
  std::map<std::string, double> lag_s_;  // by process, when it spoke last
  double said_s_ = 0;                    // 0: nothing to be caught up
  std::vector<std::string> notes_;
};

}  // namespace airdos

#endif  // AIRDOS_PROCESSES_NODE_LIVE_LAG_WATCH_H_
