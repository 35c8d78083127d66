#ifndef AIRDOS_COMMON_SIMULATION_MOVING_OBJECT_H_
#define AIRDOS_COMMON_SIMULATION_MOVING_OBJECT_H_

#include <Eigen/Core>
#include <utility>
#include <vector>

#include "common/geometry/se3.h"
#include "common/simulation/random.h"

namespace airdos {

/// What a person does during a sequence.
enum class Behaviour {
  kCruise,  ///< keeps direction and speed, apart from small accelerations
  kTurn,    ///< turns by 60 to 120 degrees within about a second
  kStop,    ///< brakes within half a second, stands, walks on
  kSit,     ///< brakes and sits down
  kSwapped  ///< cruises, but is confused with another swapped person at some moment
};

/// A moving object as a set of points (ground truth).
struct MovingObject {
  bool is_person = false;
  Behaviour behaviour = Behaviour::kCruise;
  std::vector<std::pair<int, int>> segments;  ///< pairs of points at a constant distance
  std::vector<int> body_points;               ///< torso and head of a person; all points of a box
  std::vector<std::vector<Eigen::Vector3d>> points_W;  ///< [frame][point]
};

/// How an object's root moves over the ground (W: y down): position, heading about W's y axis (0 is
/// along x; negative angles turn towards z) and how far the person has sat down (0 .. 1).
struct RootState {
  Eigen::Vector3d position_W = Eigen::Vector3d::Zero();
  double heading_rad = 0;
  double sitting = 0;
  double speed_m_s = 0;
};

/// Parameters of a root's motion.
struct RootMotion {
  Behaviour behaviour = Behaviour::kCruise;
  Eigen::Vector3d velocity_W_m_s = Eigen::Vector3d::Zero();  ///< horizontal
  double turn_rad_s = 0;                                     ///< constant, for rigid objects
  double acceleration_m_s2 = 0.2;  ///< sigma per horizontal axis, drawn for every frame
  double velocity_memory_s = 2;    ///< decay time of a deviation from the mean velocity
};

/// The root relative to its pose at time zero, one entry per frame.
std::vector<RootState> SimulateRoot(const RootMotion& motion, int num_frames, double step_s,
                                    Random* random);

/// A person with `num_points` (14 .. 18, in COCO-18 order) on the given path. Limbs swing with the
/// pace, the body bobs and sways, and segments keep their lengths. The middle of the hips is at the
/// root.
MovingObject MakePerson(const std::vector<RootState>& root, double step_s, int num_points,
                        Random* random);

/// A box, 1 to 2.5 m in size, with `num_points` points on its surface.
MovingObject MakeBox(const std::vector<RootState>& root, int num_points, Random* random);

}  // namespace airdos

#endif  // AIRDOS_COMMON_SIMULATION_MOVING_OBJECT_H_
