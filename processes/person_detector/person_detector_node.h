#ifndef AIRDOS_PROCESSES_PERSON_DETECTOR_PERSON_DETECTOR_NODE_H_
#define AIRDOS_PROCESSES_PERSON_DETECTOR_PERSON_DETECTOR_NODE_H_

#include <memory>
#include <optional>
#include <string>

#include "airdos/image_t.hpp"
#include "common/config/config_reader.h"
#include "common/perception/person_detector.h"
#include "processes/node/frame_node.h"
#include "processes/person_detector/person_detector_options.h"

namespace airdos {

/// The messages of one frame.
struct PersonDetectorInputs {
  std::optional<image_t> left_image;
  std::optional<image_t> right_image;
};

/// CAMERA_LEFT, CAMERA_RIGHT -> PERSON_KEYPOINTS_LEFT, PERSON_KEYPOINTS_RIGHT, PERSON_MASK: one
/// message on each per frame, empty if nobody was found or the image is missing or cannot be
/// decoded. Needs no calibration.
class PersonDetectorNode : public FrameNode<PersonDetectorInputs> {
 public:
  /// Throws InputError if a network cannot be used.
  explicit PersonDetectorNode(const PersonDetectorOptions& options);

 protected:
  void StartSession(const Header& header) override;
  void ProcessFrame(const Header& header, PersonDetectorInputs inputs) override;

 private:
  /// The image, or an empty one.
  cv::Mat Pixels(const std::string& channel, const std::optional<image_t>& message, bool is_gray);

  bool is_right_gray_;
  PersonDetector detector_;
};

std::unique_ptr<Node> MakePersonDetectorNode(ConfigReader* config);

}  // namespace airdos

#endif  // AIRDOS_PROCESSES_PERSON_DETECTOR_PERSON_DETECTOR_NODE_H_
