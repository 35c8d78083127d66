#ifndef AIRDOS_PROCESSES_HUMAN_TRACKER_HUMAN_TRACKER_NODE_H_
#define AIRDOS_PROCESSES_HUMAN_TRACKER_HUMAN_TRACKER_NODE_H_

#include <memory>
#include <optional>

#include "airdos/human_observations_t.hpp"
#include "airdos/image_t.hpp"
#include "airdos/person_keypoints_t.hpp"
#include "common/config/config_reader.h"
#include "common/human/human_tracker.h"
#include "processes/human_tracker/human_tracker_options.h"
#include "processes/human_tracker/people_watch.h"
#include "processes/node/frame_node.h"
#include "processes/node/partner_watch.h"

namespace airdos {

/// The messages of one frame.
struct HumanTrackerInputs {
  std::optional<image_t> left_image;
  std::optional<image_t> right_image;
  std::optional<person_keypoints_t> left_keypoints;
  std::optional<person_keypoints_t> right_keypoints;
};

/// CAMERA_LEFT, CAMERA_RIGHT, PERSON_KEYPOINTS_LEFT, PERSON_KEYPOINTS_RIGHT -> HUMAN_OBSERVATIONS:
/// one message per frame, empty if nobody was found. Works without an image that is missing, cannot
/// be decoded or differs in size from the calibration, and without missing keypoints. Watches the
/// keypoints and warns of anything doubtful.
class HumanTrackerNode : public FrameNode<HumanTrackerInputs> {
 public:
  explicit HumanTrackerNode(const HumanTrackerOptions& options);

 protected:
  void StartSession(const Header& header) override;
  void ProcessFrame(const Header& header, HumanTrackerInputs inputs) override;

 private:
  /// What is watched during one session.
  struct Watches {
    PartnerWatch left{channel::kPersonKeypointsLeft, "keypoints of the left image", true};
    PartnerWatch right{channel::kPersonKeypointsRight, "keypoints of the right image", true};
    PeopleWatch people;
  };
  void WatchKeypoints(const HumanTrackerInputs& inputs, const PeopleFrame& frame);

  HumanTrackerOptions options_;
  std::unique_ptr<HumanTracker> tracker_;
  Watches watches_;
};

std::unique_ptr<Node> MakeHumanTrackerNode(ConfigReader* config);

}  // namespace airdos

#endif  // AIRDOS_PROCESSES_HUMAN_TRACKER_HUMAN_TRACKER_NODE_H_
