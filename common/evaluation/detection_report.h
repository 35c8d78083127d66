#ifndef AIRDOS_COMMON_EVALUATION_DETECTION_REPORT_H_
#define AIRDOS_COMMON_EVALUATION_DETECTION_REPORT_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "common/evaluation/people_files.h"
#include "common/evaluation/people_report.h"
#include "common/evaluation/trajectory.h"
#include "common/geometry/stereo_camera.h"
#include "common/human/body_keypoints.h"

namespace airdos {

// How good the people are that a detector finds in the images, each image by itself. All lengths in
// images are px, all distances m. Joints are in camera coordinates (C left, Cr right).

enum ImageSide : std::size_t { kLeftImage = 0, kRightImage = 1 };
inline constexpr std::size_t kNumImages = 2;

/// The people found in the images of a pair; nothing for an image of which nothing is known.
using PeopleOfPair = std::array<std::optional<std::vector<BodyKeypoints>>, kNumImages>;

/// Who there really was in one frame, and where the camera was.
struct TrueScene {
  std::map<std::int64_t, TruePersonState> people;  ///< by identity, joints in W
  TrajectoryPose T_W_C;
};

struct DetectionFrame {
  PeopleOfPair detected;
  PeopleOfPair given;  ///< what came with the data set: a second detector, to compare with
  std::optional<TrueScene> truth;
};

/// How many of those who were to be found were found.
struct Recall {
  std::size_t num_people = 0;  ///< summed over images, as all counts here
  std::size_t num_found = 0;
  double percent() const;  ///< 0 if there was nobody
};

/// Of errors without sign; all 0 if there are none.
struct ErrorSpread {
  std::size_t count = 0;
  double median = 0;
  double percentile_90 = 0;
};

/// What there is to see of a person who is to be seen: all joints lie in the image and at least
/// half of them are visible; or more than half of them are hidden; or some lie outside the image.
enum class Sight : std::size_t { kWhole, kHidden, kCutOff };
inline constexpr std::size_t kNumSights = 3;
inline constexpr std::array<const char*, kNumSights> kSightNames = {
    "in full view", "half hidden or more", "cut off by the border"};

/// A detector's people in the left or the right images, compared with the true ones.
struct ImageScore {
  std::size_t num_images = 0;
  std::size_t num_detections = 0;  ///< that can be used, see EvaluateDetections()
  std::size_t num_unusable = 0;    ///< that have too few joints; they count nowhere else
  Recall recall;
  std::array<Recall, kNumDepthBands> recall_by_depth;
  std::array<Recall, kNumSights> recall_by_sight;
  std::size_t num_on_others = 0;  ///< on people who are not to be seen: neither right nor wrong
  std::size_t num_false = 0;      ///< on nobody, or on a person who has a detection already
  std::size_t num_doubles = 0;    ///< of these, the latter
  std::size_t num_astray = 0;     ///< of these, on somebody, but with joints elsewhere (see IsOn())
  std::size_t num_exchanged = 0;  ///< found people with their left and right sides exchanged
  ErrorSpread joint_px;           ///< distance in the image
  std::array<ErrorSpread, kNumDepthBands> joint_px_by_depth;

  /// Of the false ones, those on nobody at all.
  std::size_t num_on_nobody() const { return num_false - num_doubles - num_astray; }
  double false_per_image() const;
};

/// A detector's people, compared with the true ones.
struct DetectorScore {
  std::array<ImageScore, kNumImages> images;
  std::size_t num_pairs = 0;  ///< people who are to be seen, and found, in both images
  ErrorSpread disparity_px;   ///< of their joints
  std::array<ErrorSpread, kNumDepthBands> disparity_px_by_depth;
};

/// A detector's people in the left or the right images, compared with those of another detector.
struct AgreementScore {
  std::size_t num_images = 0;
  Recall recall;  ///< of the other's people
  std::array<Recall, kNumDepthBands> recall_by_depth;
  std::size_t num_detections = 0;
  std::size_t num_without_partner = 0;  ///< detections of whom the other knows nothing

  double without_partner_per_image() const;
};

/// All figures about detections.
struct DetectionReport {
  std::size_t num_frames = 0;
  std::size_t num_frames_with_truth = 0;
  std::optional<DetectorScore> detected;  ///< nothing if no frame has a truth
  std::optional<DetectorScore> given;     ///< of the given people; also nothing if there are none
  /// Detected against given people, by image; nothing if no frame has given ones.
  std::optional<std::array<AgreementScore, kNumImages>> agreement;
};

/// What the human tracker can use counts as a detection: joints with a confidence of at least
/// PersonPairingOptions::min_confidence, at least PersonPairingOptions::min_joints of them.
///
/// A true person is to be seen in an image as IsToBeSeen() says, but by that image alone: at least
/// kMinVisibleJoints joints visible in it (of all 18, if the file tells; else of the body model,
/// within the image), at a depth from kMinPersonDepthM to kMaxPersonDepthM. Detections are matched
/// with these people first (MatchPeople()), and the remaining ones with everybody else: somebody
/// who is hidden or too far away may be found, but need not be.
///
/// Errors are those of joints that are visible, by the names that the detector gave them: if it
/// exchanged the sides of a person, the errors are large. Disparities (u left - u right) are those
/// of joints visible in both images. The others' people have no true depth: their size in the image
/// says at which depth they would be adults, and how far off a partner may be.
DetectionReport EvaluateDetections(const StereoCamera& camera,
                                   const std::vector<DetectionFrame>& frames);

/// Height (px) of an adult standing upright where this person is: the upper quartile of what the
/// limbs say, since they may point anywhere. Nothing if no limb has both of its joints.
std::optional<double> StandingHeight(const BodyKeypoints& person, double min_confidence);

/// A warning if hardly any detection is where somebody is: these may be people of other images.
Remarks DoubtsAbout(const DetectionReport& report);

std::string ToTable(const DetectionReport& report);
nlohmann::json ToJson(const DetectionReport& report);

}  // namespace airdos

#endif  // AIRDOS_COMMON_EVALUATION_DETECTION_REPORT_H_
