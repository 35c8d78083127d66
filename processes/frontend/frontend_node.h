#ifndef AIRDOS_PROCESSES_FRONTEND_FRONTEND_NODE_H_
#define AIRDOS_PROCESSES_FRONTEND_FRONTEND_NODE_H_

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "airdos/human_observations_t.hpp"
#include "airdos/image_t.hpp"
#include "airdos/map_update_t.hpp"
#include "airdos/person_keypoints_t.hpp"
#include "airdos/person_mask_t.hpp"
#include "airdos/static_features_t.hpp"
#include "common/config/config_reader.h"
#include "common/features/visual_odometry.h"
#include "processes/frontend/input_watch.h"
#include "processes/node/frame_node.h"
#include "processes/node/message/part_set.h"
#include "processes/node/partner_watch.h"

namespace airdos {

struct FrontendOptions {
  VisualOdometryOptions odometry;
  bool use_masks = true;
  bool use_people = true;                ///< in the pose of a frame that sees little else
  double min_keypoint_confidence = 0.1;  ///< of joints that mark where people are without a mask
  int mask_dilation_px =
      8;  ///< masks are ragged: a border of so many px around people is left out as well
  /// MAP_UPDATE of the frame so many frames back must be there before a frame starts; 0 = no
  /// feedback.
  int feedback_lag = 2;
};

FrontendOptions ReadFrontendOptions(ConfigReader* config);

struct FrontendInputs {
  std::optional<image_t> left;
  std::optional<image_t> right;
  std::optional<person_mask_t> mask;
  std::optional<human_observations_t> humans;
  std::optional<person_keypoints_t> keypoints;
};

/// Static landmarks and camera pose from stereo images: CAMERA_LEFT, CAMERA_RIGHT, CALIBRATION,
/// PERSON_MASK (if masks are used), HUMAN_OBSERVATIONS and PERSON_KEYPOINTS_LEFT (if people are
/// used) and MAP_UPDATE in, STATIC_FEATURES out. The optimizer's corrections are applied at a fixed
/// lag of frames, so that the result does not depend on how fast the optimizer is. A frame without
/// its right image is tracked, but makes no landmarks; one without its left image coasts, if it is
/// later than the one before. Else, and before the first left image of a session, it has no pose
/// (STATE_INVALID). It watches its input and warns of what is doubtful.
class FrontendNode : public FrameNode<FrontendInputs> {
 public:
  explicit FrontendNode(const FrontendOptions& options);

 protected:
  std::vector<std::string> MissingFeedback(const Header& header) const override;
  void StartSession(const Header& header) override;
  void ProcessFrame(const Header& header, FrontendInputs inputs) override;
  /// Coasts without images.
  static_features_t Track(const Header& header, const std::optional<StereoImagePair>& images);

 private:
  /// What is watched of one session.
  struct Watches {
    InputWatch input;
    PartnerWatch right{channel::kCameraRight, "right image", false};
    PartnerWatch mask{channel::kPersonMask, "person mask", true};
    PartnerWatch keypoints{channel::kPersonKeypointsLeft, "keypoints", true};
  };
  std::string ReceiveUpdate(map_update_t&& message);
  /// Frame whose update must be there before the next frame starts.
  std::optional<std::int64_t> RequiredUpdate() const;
  void ApplyUpdates();
  static std::vector<PersonMeasurement> People(const FrontendInputs& inputs);
  /// Where people are, from masks, or else from keypoints; empty if nothing says.
  cv::Mat Mask(const FrontendInputs& inputs);
  std::optional<StereoImagePair> Images(const Header& header, const FrontendInputs& inputs);
  void WatchNumbers(const FrontendInputs& inputs);

  const FrontendOptions options_;
  std::unique_ptr<VisualOdometry> odometry_;
  Header first_;                              // of the session, or since it had to begin again
  std::optional<std::int64_t> newest_utime_;  // of a frame that has a pose
  Watches watches_;
  std::optional<std::int64_t> session_;
  std::vector<std::int64_t>
      published_;  // image numbers of the last feedback_lag frames, oldest first
  std::map<std::int64_t, PartSet<map_update_t>> updates_;  // of this session, by seq
  std::int64_t newest_update_ = -1;                        // complete
  bool is_feedback_silent_ =
      false;  // a frame had to start without, or must: do not wait until an update comes
};

std::unique_ptr<Node> MakeFrontendNode(ConfigReader* config);

}  // namespace airdos

#endif  // AIRDOS_PROCESSES_FRONTEND_FRONTEND_NODE_H_
