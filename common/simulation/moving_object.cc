#include "common/simulation/moving_object.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "common/human/skeleton.h"
#include "common/util/check.h"

namespace airdos {
namespace {

// Points of the face in COCO-18, after the body's joints.
enum FacePoint : int { kRightEye = 14, kLeftEye = 15, kRightEar = 16, kLeftEar = 17 };
constexpr int kMaxPersonPoints = 18;

double SmoothStep(double x) {
  const double t = std::clamp(x, 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

/// A limb that hangs down (y) and swings in the walking plane (x forward).
Eigen::Vector3d Hang(double angle_rad, double length_m) {
  return {length_m * std::sin(angle_rad), length_m * std::cos(angle_rad), 0};
}

/// A person in local axes: x forward, y down, z to the right, with the origin midway between the
/// hips.
std::array<Eigen::Vector3d, kMaxPersonPoints> Pose(double phase_rad, double swing_rad,
                                                   double sitting, double scale) {
  std::array<Eigen::Vector3d, kMaxPersonPoints> p;
  const double bob_m = 0.2 * swing_rad * 0.15 * std::cos(2 * phase_rad);
  p[kNeck] = {0.03, -0.52, 0};
  p[kNose] = p[kNeck] + Eigen::Vector3d(0.10, -0.20, 0);
  p[kRightEye] = p[kNose] + Eigen::Vector3d(-0.02, -0.04, 0.03);
  p[kLeftEye] = p[kNose] + Eigen::Vector3d(-0.02, -0.04, -0.03);
  p[kRightEar] = p[kNose] + Eigen::Vector3d(-0.11, -0.02, 0.07);
  p[kLeftEar] = p[kNose] + Eigen::Vector3d(-0.11, -0.02, -0.07);
  for (const double side : {1.0, -1.0}) {
    const bool is_right = side > 0;
    const auto at = [&p](int joint) -> Eigen::Vector3d& {
      return p[static_cast<std::size_t>(joint)];
    };
    const int shoulder = is_right ? kRightShoulder : kLeftShoulder;
    const int hip = is_right ? kRightHip : kLeftHip;
    const double swing = swing_rad * std::sin(phase_rad + (is_right ? 0 : M_PI));
    const double lifted = 0.5 * swing_rad * (1 - std::cos(phase_rad + (is_right ? 0 : M_PI)));
    at(shoulder) = p[kNeck] + Eigen::Vector3d(0, 0.04, 0.18 * side);
    at(shoulder + 1) = at(shoulder) + Hang(-swing, 0.30);
    at(shoulder + 2) = at(shoulder + 1) + Hang(-swing + 0.3, 0.26);
    at(hip) = {0, 0, 0.12 * side};
    at(hip + 1) = at(hip) + Hang(swing + 1.5 * sitting, 0.43);
    at(hip + 2) = at(hip + 1) + Hang(swing - lifted, 0.42);
  }
  const Eigen::Vector3d shift(0, bob_m + 0.43 * sitting, 0);
  for (Eigen::Vector3d& point : p) point = scale * (point + shift);
  return p;
}

/// Speed, as a fraction of the cruising speed, and rotation at a given time.
struct Manoeuvre {
  double speed = 1;
  double heading_rad = 0;
  double sitting = 0;
};

Manoeuvre At(Behaviour behaviour, double time_s, double start_s, double turn_rad, double pause_s) {
  const double since_s = time_s - start_s;
  Manoeuvre now;
  switch (behaviour) {
    case Behaviour::kTurn:
      now.heading_rad = turn_rad * SmoothStep(since_s / 1.0);
      break;
    case Behaviour::kStop:
      now.speed = 1 - SmoothStep(since_s / 0.5) + SmoothStep((since_s - pause_s) / 0.5);
      break;
    case Behaviour::kSit:
      now.speed = 1 - SmoothStep(since_s / 0.5);
      now.sitting = SmoothStep((since_s - 0.3) / 1.0);
      break;
    case Behaviour::kCruise:
    case Behaviour::kSwapped:
      break;
  }
  return now;
}

}  // namespace

std::vector<RootState> SimulateRoot(const RootMotion& motion, int num_frames, double step_s,
                                    Random* random) {
  const double duration_s = num_frames * step_s;
  const double start_s = random->Uniform(0.25, 0.6) * duration_s;
  const double turn_sign = random->Sign();
  const double turn_rad = turn_sign * random->Uniform(M_PI / 3, 2 * M_PI / 3);
  const double pause_s = random->Uniform(1.0, 2.0);
  const double keep = std::exp(-step_s / motion.velocity_memory_s);
  const double cruise_m_s = motion.velocity_W_m_s.norm();
  const double heading_rad = std::atan2(-motion.velocity_W_m_s.z(), motion.velocity_W_m_s.x());

  std::vector<RootState> path;
  RootState state;
  Eigen::Vector3d deviation_m_s = Eigen::Vector3d::Zero();
  for (int frame = 0; frame < num_frames; ++frame) {
    const double time_s = frame * step_s;
    const Manoeuvre now = At(motion.behaviour, time_s, start_s, turn_rad, pause_s);
    state.heading_rad = heading_rad + motion.turn_rad_s * time_s + now.heading_rad;
    state.sitting = now.sitting;
    state.speed_m_s = now.speed * cruise_m_s;
    path.push_back(state);
    const Eigen::Vector3d forward(std::cos(state.heading_rad), 0, -std::sin(state.heading_rad));
    state.position_W += step_s * (state.speed_m_s * forward + now.speed * deviation_m_s);
    Eigen::Vector3d push = random->Normal3(motion.acceleration_m_s2);
    push.y() = 0;
    deviation_m_s = keep * deviation_m_s + step_s * push;
  }
  return path;
}

MovingObject MakePerson(const std::vector<RootState>& root, double step_s, int num_points,
                        Random* random) {
  AIRDOS_CHECK(num_points >= kNumJoints && num_points <= kMaxPersonPoints);
  MovingObject person;
  person.is_person = true;
  for (const Segment& segment : kSegments) {
    person.segments.emplace_back(segment.joint_a, segment.joint_b);
  }
  person.body_points = {kNeck, kRightShoulder, kLeftShoulder, kRightHip, kLeftHip, kNose};
  for (int point = kNumJoints; point < num_points; ++point) {
    person.segments.emplace_back(kNose, point);
    person.segments.emplace_back(kNeck, point);
    person.body_points.push_back(point);
  }
  const double scale = random->Uniform(0.9, 1.1);
  const double stride_m = 1.4 * scale;  // two steps
  double phase_rad = random->Uniform(0, 2 * M_PI);
  for (const RootState& state : root) {
    const double swing_rad = std::min(0.45 * state.speed_m_s, 0.6);
    const auto pose = Pose(phase_rad, swing_rad, state.sitting, scale);
    const double sway_rad = 0.1 * swing_rad * std::sin(phase_rad);
    const Eigen::Quaterniond R_W_H = ExpSo3({0, state.heading_rad + sway_rad, 0});
    std::vector<Eigen::Vector3d> points_W;
    for (int i = 0; i < num_points; ++i) {
      points_W.push_back(state.position_W + R_W_H * pose[static_cast<std::size_t>(i)]);
    }
    person.points_W.push_back(std::move(points_W));
    phase_rad += 2 * M_PI * step_s * state.speed_m_s / stride_m;
  }
  return person;
}

MovingObject MakeBox(const std::vector<RootState>& root, int num_points, Random* random) {
  MovingObject box;
  Eigen::Vector3d half_m;
  half_m.z() = random->Uniform(0.5, 0.9);
  half_m.y() = random->Uniform(0.5, 0.9);
  half_m.x() = random->Uniform(0.5, 1.25);
  std::vector<Eigen::Vector3d> shape;
  for (int i = 0; i < num_points; ++i) {
    Eigen::Vector3d point;
    for (int axis = 0; axis < 3; ++axis) point[axis] = random->Uniform(-1, 1) * half_m[axis];
    const int side = i % 3;
    point[side] = random->Sign() * half_m[side];
    shape.push_back(point);
    box.body_points.push_back(i);
    // Three distances to earlier points fix a point.
    for (int other = std::max(0, i - 3); other < i; ++other) box.segments.emplace_back(other, i);
  }
  for (const RootState& state : root) {
    const Eigen::Quaterniond R_W_H = ExpSo3({0, state.heading_rad, 0});
    std::vector<Eigen::Vector3d> points_W;
    for (const Eigen::Vector3d& point : shape) points_W.push_back(state.position_W + R_W_H * point);
    box.points_W.push_back(std::move(points_W));
  }
  return box;
}

}  // namespace airdos
