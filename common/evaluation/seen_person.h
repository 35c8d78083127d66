#ifndef AIRDOS_COMMON_EVALUATION_SEEN_PERSON_H_
#define AIRDOS_COMMON_EVALUATION_SEEN_PERSON_H_

#include <cstddef>
#include <cstdint>
#include <map>
#include <set>

#include "common/evaluation/detection_report.h"

namespace airdos {

/// A true person as one image shows them.
struct SeenPerson {
  Joints joints_C;        ///< of that image's camera
  std::set<int> visible;  ///< joints that the image shows
  bool is_to_be_seen = false;
  std::size_t band = 0;  ///< of the depth
  Sight sight = Sight::kWhole;
};
/// By identity.
using SeenPeople = std::map<std::int64_t, SeenPerson>;

/// What the left or the right image shows of a person, as EvaluateDetections() counts it.
SeenPerson See(const TruePersonState& person, const TrajectoryPose& T_W_C,
               const StereoCamera& camera, ImageSide side);

/// Whether a detection, joints with their directions, is on this person, wherever it has the
/// joints: at least half of them lie in the box around the person's joints in the image, enlarged
/// by a tenth of a standing height on each side, and its size, that of an adult `height_px` tall,
/// is less than twice and more than half the person's.
bool IsOn(const Joints& detected_C, double height_px, const SeenPerson& person,
          const StereoCamera& camera);

}  // namespace airdos

#endif  // AIRDOS_COMMON_EVALUATION_SEEN_PERSON_H_
