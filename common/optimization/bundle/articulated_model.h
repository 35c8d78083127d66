#ifndef AIRDOS_COMMON_OPTIMIZATION_BUNDLE_ARTICULATED_MODEL_H_
#define AIRDOS_COMMON_OPTIMIZATION_BUNDLE_ARTICULATED_MODEL_H_

#include <memory>
#include <vector>

namespace airdos {

/// A moving object: its points, numbered from 0, and what stays constant while it moves. A rigid
/// object is one part with all its points.
struct ArticulatedModel {
  /// Two points at a fixed distance.
  struct Segment {
    int point_a = 0;
    int point_b = 0;
  };
  int num_points = 0;
  std::vector<Segment> segments;        ///< pairs of points at a constant distance (eq. 3)
  std::vector<std::vector<int>> parts;  ///< points of each rigid part (eq. 4, 5)
  std::vector<int> body_points;         ///< points that share the object's velocity; limbs swing

  /// Whether every index names a point and no segment joins a point with itself.
  bool IsValid() const;
};

/// A person as defined in common/human/skeleton.h: 14 joints, segments and rigid parts; torso and
/// head share the velocity.
std::shared_ptr<const ArticulatedModel> CocoBodyModel();

}  // namespace airdos

#endif  // AIRDOS_COMMON_OPTIMIZATION_BUNDLE_ARTICULATED_MODEL_H_
