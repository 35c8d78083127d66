#ifndef AIRDOS_PROCESSES_HUMAN_TRACKER_HUMAN_TRACKER_NODE_H_
#define AIRDOS_PROCESSES_HUMAN_TRACKER_HUMAN_TRACKER_NODE_H_

#include <memory>
#include <optional>

#include "airdos/human_observations_t.hpp"
#include "airdos/image_t.hpp"
#include "airdos/person_keypoints_t.hpp"
#include "common/config/config_reader.h"
#include "common/human/human_tracker.h"
#include "processes/human_tracker/people_watch.h"
#include "processes/node/frame_node.h"
#include "processes/node/partner_watch.h"

namespace airdos {

struct HumanTrackerInputs {
  std::optional<image_t> left_image;
  std::optional<image_t> right_image;
  std::optional<person_keypoints_t> left_keypoints;
  std::optional<person_keypoints_t> right_keypoints;
};

/// CAMERA_LEFT, CAMERA_RIGHT, PERSON_KEYPOINTS_LEFT, PERSON_KEYPOINTS_RIGHT -> HUMAN_OBSERVATIONS:
/// one message a frame, empty if nobody was found. An image that is missing, does not decode or has
/// another size than the calibration says is done without; so are keypoints. It watches the
/// keypoints and warns of what is doubtful.
class HumanTrackerNode : public FrameNode<HumanTrackerInputs> {
 public:
  explicit HumanTrackerNode(const HumanTrackerOptions& options);

 protected:
  void StartSession(const Header& header) override;
  void ProcessFrame(const Header& header, HumanTrackerInputs inputs) override;

 private:
  /// What is watched of one session.
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

/// Reads the options of launch_scripts/config/human_tracker.yaml; Finish() is left to the caller.
HumanTrackerOptions ReadHumanTrackerOptions(ConfigReader* config);
std::unique_ptr<Node> MakeHumanTrackerNode(ConfigReader* config);

}  // namespace airdos

#endif  // AIRDOS_PROCESSES_HUMAN_TRACKER_HUMAN_TRACKER_NODE_H_
