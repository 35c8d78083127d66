#ifndef AIRDOS_PROCESSES_NODE_MESSAGE_CHANNELS_H_
#define AIRDOS_PROCESSES_NODE_MESSAGE_CHANNELS_H_

// Installed as airdos/channels.h.

namespace airdos::channel {

// Each channel has one type and one publisher: lcmtypes/README.md.
inline constexpr char kCameraLeft[] = "CAMERA_LEFT";
inline constexpr char kCameraRight[] = "CAMERA_RIGHT";
inline constexpr char kCalibration[] = "CALIBRATION";
inline constexpr char kPersonKeypointsLeft[] = "PERSON_KEYPOINTS_LEFT";
inline constexpr char kPersonKeypointsRight[] = "PERSON_KEYPOINTS_RIGHT";
inline constexpr char kPersonMask[] = "PERSON_MASK";
inline constexpr char kStaticFeatures[] = "STATIC_FEATURES";
inline constexpr char kHumanObservations[] = "HUMAN_OBSERVATIONS";
inline constexpr char kStateEstimate[] = "STATE_ESTIMATE";
inline constexpr char kMapUpdate[] = "MAP_UPDATE";
inline constexpr char kGroundTruth[] = "GROUND_TRUTH";
inline constexpr char kFrameDone[] = "FRAME_DONE";
inline constexpr char kStatus[] = "STATUS";

}  // namespace airdos::channel

#endif  // AIRDOS_PROCESSES_NODE_MESSAGE_CHANNELS_H_
