#ifndef AIRDOS_PROCESSES_HUMAN_TRACKER_PEOPLE_WATCH_H_
#define AIRDOS_PROCESSES_HUMAN_TRACKER_PEOPLE_WATCH_H_

#include <string>
#include <vector>

#include "common/human/body_keypoints.h"
#include "processes/node/partner_watch.h"

namespace airdos {

/// Watches during a session whether the people in left and right images are those of stereo pairs:
/// whoever is visible on the left is also visible on the right, and farther left there. Reports
/// each problem once.
class PeopleWatch {
 public:
  /// Adds the people of one frame; returns a warning, or an empty text.
  std::string Add(const std::vector<BodyKeypoints>& left, const std::vector<BodyKeypoints>& right);

 private:
  std::string Judge();

  LookSchedule schedule_;
  int num_left_ = 0;  // people since the last judgement
  int num_right_ = 0;
  int num_pairs_ = 0;
  int num_negative_ = 0;  // pairs with a negative disparity
  int num_zero_ = 0;
  bool is_said_ = false;
};

}  // namespace airdos

#endif  // AIRDOS_PROCESSES_HUMAN_TRACKER_PEOPLE_WATCH_H_
