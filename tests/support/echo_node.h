#ifndef AIRDOS_TESTS_SUPPORT_ECHO_NODE_H_
#define AIRDOS_TESTS_SUPPORT_ECHO_NODE_H_

#include <memory>
#include <optional>

#include "airdos/image_t.hpp"
#include "airdos/pose_t.hpp"
#include "common/config/config_reader.h"
#include "common/config/option_table.h"
#include "processes/node/frame_node.h"

namespace airdos {

/// The messages of one frame.
struct EchoInputs {
  std::optional<image_t> left;
  std::optional<image_t> right;
};

/// The smallest frame node: publishes on ECHO what it received, as (bytes of the left image, bytes
/// of the right image, baseline), with -1 for a missing image.
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

struct EchoOptions {
  double scale = 1;
};

inline OptionTable TableOf(EchoOptions* options) {
  OptionTable table("echo", "airdos-echo: for tests.");
  table.AddSection("echo");
  table.Add("echo.scale", &options->scale, {0, 10}, "times", "factor on the bytes of the images");
  table.SetRenamed({{"echo.factor", "echo.scale"}});
  return table;
}

inline std::unique_ptr<Node> MakeEchoNode(ConfigReader* config) {
  return std::make_unique<EchoNode>(ReadOptions<EchoOptions>(config).scale);
}

}  // namespace airdos

#endif  // AIRDOS_TESTS_SUPPORT_ECHO_NODE_H_
