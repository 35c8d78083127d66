#ifndef AIRDOS_TESTS_SUPPORT_ECHO_NODE_H_
#define AIRDOS_TESTS_SUPPORT_ECHO_NODE_H_

#include <memory>
#include <optional>

#include "airdos/image_t.hpp"
#include "airdos/pose_t.hpp"
#include "common/config/config_reader.h"
#include "processes/node/frame_node.h"

namespace airdos {

struct EchoInputs {
  std::optional<image_t> left;
  std::optional<image_t> right;
};

/// The smallest frame node: says on ECHO what it was given, as (bytes of the left image, bytes of
/// the right image, baseline), -1 where an image was missing.
class EchoNode : public FrameNode<EchoInputs> {
 public:
  static constexpr char kEcho[] = "ECHO";
  explicit EchoNode(double scale = 1) : FrameNode("echo"), scale_(scale) {
    Join<image_t>(channel::kCameraLeft, &EchoInputs::left);
    Join<image_t>(channel::kCameraRight, &EchoInputs::right);
    JoinCalibration();
    DeclareOutput(kEcho);
  }

 protected:
  void StartSession(const Header&) override {}
  void ProcessFrame(const Header& header, EchoInputs inputs) override {
    auto message = MessageOf<pose_t>(header);
    message.axes = pose_t::AXES_UNKNOWN;
    message.orientation[0] = 1;
    message.position[0] = inputs.left ? scale_ * inputs.left->num_bytes : -1;
    message.position[1] = inputs.right ? scale_ * inputs.right->num_bytes : -1;
    message.position[2] = camera().baseline_m;
    Publish(kEcho, message);
  }

 private:
  double scale_;
};

inline std::unique_ptr<Node> MakeEchoNode(ConfigReader* config) {
  double scale = 1;
  config->Read("echo.scale", &scale, 0, 10);
  return std::make_unique<EchoNode>(scale);
}

}  // namespace airdos

#endif  // AIRDOS_TESTS_SUPPORT_ECHO_NODE_H_
