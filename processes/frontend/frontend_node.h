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
#include "processes/frontend/frontend_options.h"
#include "processes/frontend/input_watch.h"
#include "processes/node/frame_node.h"
#include "processes/node/message/part_set.h"
#include "processes/node/partner_watch.h"

namespace airdos {

/// The messages of one frame.
struct FrontendInputs {
  std::optional<image_t> left;
  std::optional<image_t> right;
  std::optional<person_mask_t> mask;
  std::optional<human_observations_t> humans;
  std::optional<person_keypoints_t> keypoints;
};

/// Estimates static landmarks and the camera pose from stereo images. Inputs: CAMERA_LEFT,
/// CAMERA_RIGHT, CALIBRATION, PERSON_MASK (if masks are used), HUMAN_OBSERVATIONS and
/// PERSON_KEYPOINTS_LEFT (if people are used), and MAP_UPDATE; output: STATIC_FEATURES. The
/// optimizer's corrections are applied with a fixed lag in frames, so the result does not depend on
/// the optimizer's speed. A frame without its right image is tracked but creates no landmarks. A
/// frame without its left image coasts if it is later than the previous one; otherwise, and before
/// the first left image of a session, it has no pose (STATE_INVALID). Watches its input and warns
/// of anything doubtful.
class FrontendNode : public FrameNode<FrontendInputs> {
 public:
  explicit FrontendNode(const FrontendOptions& options);

 protected:
  std::vector<std::string> MissingFeedback(const Header& header) const override;
  void StartSession(const Header& header) override;
  void ProcessFrame(const Header& header, FrontendInputs inputs) override;
  /// Coasts if there are no images.
  static_features_t Track(const Header& header, const std::optional<StereoImagePair>& images);

 private:
  /// What is watched during one session.
  struct Watches {
    InputWatch input;
    PartnerWatch right{channel::kCameraRight, "right image", false};
    PartnerWatch mask{channel::kPersonMask, "person mask", true};
    PartnerWatch keypoints{channel::kPersonKeypointsLeft, "keypoints", true};
  };
  std::string ReceiveUpdate(map_update_t&& message);
  /// The frame whose update must arrive before the next frame can start.
  std::optional<std::int64_t> RequiredUpdate() const;
  void ApplyUpdates();
  /// Where people are, from masks or otherwise from keypoints; empty if there is neither.
  cv::Mat Mask(const FrontendInputs& inputs);
  std::optional<StereoImagePair> Images(const Header& header, const FrontendInputs& inputs);
  void WatchPair(const cv::Mat& left, const cv::Mat& right);
  void WatchNumbers(const FrontendInputs& inputs);

  const FrontendOptions options_;
  std::unique_ptr<VisualOdometry> odometry_;
  Header first_;  // first frame of the session, or since it had to start afresh
  std::optional<std::int64_t> newest_utime_;  // among frames with a pose
  Watches watches_;
  std::optional<std::int64_t> session_;
  std::vector<std::int64_t>
      published_;  // image numbers of the last feedback_lag_frames frames, oldest first
  std::map<std::int64_t, PartSet<map_update_t>> updates_;  // of this session, keyed by seq
  std::int64_t newest_update_ = -1;                        // complete
  bool is_feedback_silent_ =
      false;  // a frame had or has to start without an update: do not wait until one comes
};

std::unique_ptr<Node> MakeFrontendNode(ConfigReader* config);

}  // namespace airdos

#endif  // AIRDOS_PROCESSES_FRONTEND_FRONTEND_NODE_H_
