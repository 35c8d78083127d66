#ifndef AIRDOS_COMMON_EVALUATION_IDENTITY_H_
#define AIRDOS_COMMON_EVALUATION_IDENTITY_H_

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <vector>

namespace airdos {

/// How well track ids stay with people over a sequence.
struct IdentityScore {
  int num_switches = 0;  ///< a person's track id differs from that person's last one
  int num_people = 0;    ///< people who were visible at any time
  double idf1 = 1;       ///< identity F1: 2 IDTP / (frames of people + frames of tracks)
  double id_precision = 1;
  double id_recall = 1;
};

/// Collects, frame by frame, which track was on which person. Score() then finds the one-to-one
/// assignment of tracks to people over the whole sequence that explains the most frames (Ristani et
/// al., 2016).
class IdentityEvaluator {
 public:
  /// Adds one frame: the visible people, and for each track the person it was on, or nothing if it
  /// was on nobody. A track on a person who was not visible counts as neither right nor wrong.
  void AddFrame(const std::set<std::int64_t>& visible_people,
                const std::map<std::int64_t, std::optional<std::int64_t>>& person_of_track);

  IdentityScore Score() const;

 private:
  std::map<std::int64_t, int> frames_of_person_;
  std::map<std::int64_t, int> frames_of_track_;
  std::map<std::int64_t, std::map<std::int64_t, int>> frames_of_both_;  // [person][track]
  std::map<std::int64_t, std::int64_t> last_track_;                     // of each person
  int num_switches_ = 0;
};

}  // namespace airdos

#endif  // AIRDOS_COMMON_EVALUATION_IDENTITY_H_
