#include "processes/optimizer/optimizer_node.h"

#include <exception>

#include "processes/optimizer/optimizer_messages.h"

namespace airdos {

OptimizerNode::OptimizerNode(const OptimizerOptions& options)
    : FrameNode("optimizer"), options_(options) {
  Join(channel::kStaticFeatures, &OptimizerInputs::features);
  if (options_.people == PeopleMode::kOn) {
    Join(channel::kHumanObservations, &OptimizerInputs::humans);
  }
  JoinCalibration();
}

void OptimizerNode::StartSession(const Header&) { window_.reset(); }

void OptimizerNode::ProcessFrame(const Header& header, OptimizerInputs inputs) {
  if (window_ == nullptr && !inputs.features) {
    // Where W is only the front end can say: to begin at its origin would be another W when this
    // process was started again in the middle.
    Publish(channel::kStateEstimate, UnknownStateEstimate(header));
    Publish(channel::kMapUpdate, ToMapUpdates(header, MapChanges()).front());
    return;
  }
  if (window_ == nullptr) {
    window_ = std::make_unique<SlidingWindowOptimizer>(options_.window, camera());
  }
  const FrameInput input =
      ToFrameInput(header, camera(), inputs.features ? &*inputs.features : nullptr,
                   inputs.humans ? &*inputs.humans : nullptr);
  FrameResult result;
  try {
    result = window_->Process(input);
  } catch (const std::exception&) {
    window_.reset();  // it may be halfway through; the front end knows where to go on
    throw;
  }
  Publish(channel::kStateEstimate, ToStateEstimate(header, result.estimate));
  for (const map_update_t& part : ToMapUpdates(header, result.changes)) {
    Publish(channel::kMapUpdate, part);
  }
}

std::unique_ptr<Node> MakeOptimizerNode(ConfigReader* config) {
  return std::make_unique<OptimizerNode>(ReadOptimizerOptions(config));
}

}  // namespace airdos
