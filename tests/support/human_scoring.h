#ifndef AIRDOS_TESTS_SUPPORT_HUMAN_SCORING_H_
#define AIRDOS_TESTS_SUPPORT_HUMAN_SCORING_H_

#include <string>
#include <vector>

#include "common/evaluation/identity.h"
#include "common/human/human_tracker.h"

namespace airdos {

/// What the tracker reached on one sequence with known people.
struct HumanScore {
  std::string name;
  // Stereo pairing.
  int num_pairs = 0;
  int num_wrong_pairs = 0;
  int num_possible_pairs = 0;  ///< identities that both images detected
  // Output. A person is to be seen where both images show at least five joints, 45 px high.
  int num_reported = 0;  ///< people-frames
  int num_false = 0;     ///< on nobody
  int num_visible = 0;   ///< people-frames to be seen
  int num_visible_found = 0;
  int num_joints = 0;
  int num_swapped_sides = 0;                      ///< people-frames whose sides are exchanged
  std::vector<double> joint_error_m;              ///< of every reported joint
  std::vector<double> joint_error_by_depth_m[3];  ///< true depth below 6, 6 to 12, from 12 m
  std::vector<double> depth_bias_m;  ///< z measured minus true, of plainly seen joints within 6 m
  double sum_normalised_squared =
      0;  ///< e' C^-1 e over reported joints, outliers above 50 left out
  int num_normalised = 0;
  IdentityScore identity;
  std::vector<double> frame_ms;  ///< of CPU, decoding the images included; for information only

  double PairPrecision() const;
  double PairRecall() const;
  double MeanJointError() const;
  double MedianJointError() const;
  std::string Table() const;  ///< one line; TableHead() above it
  static std::string TableHead();
};

/// Runs the tracker over a crossing sequence (images and keypoints from disk) and compares with its
/// ground truth. Throws InputError where the folder cannot be used.
HumanScore ScoreCrossing(const HumanTrackerOptions& options, const std::string& folder);

}  // namespace airdos

#endif  // AIRDOS_TESTS_SUPPORT_HUMAN_SCORING_H_
