#ifndef AIRDOS_TESTS_SUPPORT_HUMAN_SCORING_H_
#define AIRDOS_TESTS_SUPPORT_HUMAN_SCORING_H_

#include <string>
#include <vector>

#include "common/evaluation/identity.h"
#include "common/human/human_tracker.h"

namespace airdos {

/// The tracker's results on a sequence with known people.
struct HumanScore {
  std::string name;
  // Stereo pairing.
  int num_pairs = 0;
  int num_wrong_pairs = 0;
  int num_possible_pairs = 0;  ///< identities detected in both images
  // Output. A person is to be seen if both images show at least five joints, 45 px tall.
  int num_reported = 0;  ///< person-frames
  int num_false = 0;     ///< on nobody
  int num_visible = 0;   ///< person-frames to be seen
  int num_visible_found = 0;
  int num_joints = 0;
  int num_swapped_sides = 0;                      ///< person-frames with exchanged sides
  std::vector<double> joint_error_m;              ///< of every reported joint
  std::vector<double> joint_error_by_depth_m[3];  ///< true depth below 6 m, 6 to 12 m, 12 m or more
  std::vector<double> depth_bias_m;   ///< measured minus true z of visible joints within 6 m
  double sum_normalised_squared = 0;  ///< e' C^-1 e over reported joints, without outliers above 50
  int num_normalised = 0;
  IdentityScore identity;
  std::vector<double> frame_ms;  ///< CPU, including image decoding; for information only

  double PairPrecision() const;
  double PairRecall() const;
  double MeanJointError() const;
  double MedianJointError() const;
  std::string Table() const;  ///< one line, to go below TableHead()
  static std::string TableHead();
};

/// Runs the tracker on a crossing sequence (images and keypoints from disk) and compares the result
/// with the ground truth. Throws InputError if the folder cannot be used.
HumanScore ScoreCrossing(const HumanTrackerOptions& options, const std::string& folder);

}  // namespace airdos

#endif  // AIRDOS_TESTS_SUPPORT_HUMAN_SCORING_H_
