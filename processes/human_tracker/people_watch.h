#ifndef AIRDOS_PROCESSES_HUMAN_TRACKER_PEOPLE_WATCH_H_
#define AIRDOS_PROCESSES_HUMAN_TRACKER_PEOPLE_WATCH_H_

#include <string>
#include <vector>

#include "common/human/body_keypoints.h"
#include "processes/node/partner_watch.h"

namespace airdos {

/// Watches, while a session runs, whether the people of left and right images are those of a stereo
/// pair: who is seen on the left is seen on the right as well, further to the left there. Each
/// thing is said once.
class PeopleWatch {
 public:
  /// The people of one frame; returns what is to be said now, or an empty text.
  std::string Add(const std::vector<BodyKeypoints>& left, const std::vector<BodyKeypoints>& right);

 private:
  std::string Judge();

  LookSchedule schedule_;
  int num_left_ = 0;  // people, since the last look
  int num_right_ = 0;
  int num_pairs_ = 0;
  int num_negative_ = 0;  // of the pairs: their disparity
  int num_zero_ = 0;
  bool is_said_ = false;
};

}  // namespace airdos

#endif  // AIRDOS_PROCESSES_HUMAN_TRACKER_PEOPLE_WATCH_H_
