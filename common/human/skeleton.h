#ifndef AIRDOS_COMMON_HUMAN_SKELETON_H_
#define AIRDOS_COMMON_HUMAN_SKELETON_H_

#include <array>

namespace airdos {

/// The body model of the paper in COCO-18 numbering: 14 joints, 14 segments of constant length (eq.
/// 3), 9 rigid parts (eq. 4 and 5). The same tables are in lcmtypes/README.md.
enum Joint : int {
  kNose = 0,
  kNeck = 1,
  kRightShoulder = 2,
  kRightElbow = 3,
  kRightWrist = 4,
  kLeftShoulder = 5,
  kLeftElbow = 6,
  kLeftWrist = 7,
  kRightHip = 8,
  kRightKnee = 9,
  kRightAnkle = 10,
  kLeftHip = 11,
  kLeftKnee = 12,
  kLeftAnkle = 13,
};
inline constexpr int kNumJoints = 14;

/// Two joints at a constant distance.
struct Segment {
  int joint_a;
  int joint_b;
  double typical_length_m;  ///< of an adult, for gating only
};
inline constexpr int kNumSegments = 14;
inline constexpr std::array<Segment, kNumSegments> kSegments = {
    {{kNeck, kRightShoulder, 0.18},
     {kNeck, kLeftShoulder, 0.18},
     {kRightShoulder, kRightHip, 0.50},
     {kLeftShoulder, kLeftHip, 0.50},
     {kRightHip, kLeftHip, 0.25},
     {kRightShoulder, kRightElbow, 0.30},
     {kRightElbow, kRightWrist, 0.26},
     {kLeftShoulder, kLeftElbow, 0.30},
     {kLeftElbow, kLeftWrist, 0.26},
     {kRightHip, kRightKnee, 0.43},
     {kRightKnee, kRightAnkle, 0.42},
     {kLeftHip, kLeftKnee, 0.43},
     {kLeftKnee, kLeftAnkle, 0.42},
     {kNeck, kNose, 0.25}}};

/// A rigid part: joints that share one motion. Unused places hold -1.
struct RigidPart {
  int num_joints;
  std::array<int, 5> joints;
};
inline constexpr int kNumParts = 9;
inline constexpr int kTorsoPart = 0;
inline constexpr std::array<RigidPart, kNumParts> kParts = {
    {{5, {kNeck, kRightShoulder, kLeftShoulder, kRightHip, kLeftHip}},
     {2, {kRightShoulder, kRightElbow, -1, -1, -1}},
     {2, {kRightElbow, kRightWrist, -1, -1, -1}},
     {2, {kLeftShoulder, kLeftElbow, -1, -1, -1}},
     {2, {kLeftElbow, kLeftWrist, -1, -1, -1}},
     {2, {kRightHip, kRightKnee, -1, -1, -1}},
     {2, {kRightKnee, kRightAnkle, -1, -1, -1}},
     {2, {kLeftHip, kLeftKnee, -1, -1, -1}},
     {2, {kLeftKnee, kLeftAnkle, -1, -1, -1}}}};

/// The joints that share one velocity: torso and head. Limbs swing.
inline constexpr int kNumBodyJoints = 6;
inline constexpr std::array<int, kNumBodyJoints> kBodyJoints = {
    kNeck, kRightShoulder, kLeftShoulder, kRightHip, kLeftHip, kNose};

}  // namespace airdos

#endif  // AIRDOS_COMMON_HUMAN_SKELETON_H_
