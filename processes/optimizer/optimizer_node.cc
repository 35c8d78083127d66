#include "processes/optimizer/optimizer_node.h"

#include <algorithm>
#include <exception>
#include <vector>

#include "processes/optimizer/optimizer_messages.h"

namespace airdos {
namespace {

/// What is published of a frame.
struct Answer {
  state_estimate_t state;
  std::vector<map_update_t> updates;
};

Answer UnknownAnswer(const Header& header) {
  return {UnknownStateEstimate(header), ToMapUpdates(header, MapChanges())};
}

/// Whether others would take it.
bool IsValid(const Answer& answer) {
  return Validate(answer.state).empty() &&
         std::all_of(answer.updates.begin(), answer.updates.end(),
                     [](const map_update_t& update) { return Validate(update).empty(); });
}

}  // namespace

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
  Answer answer = UnknownAnswer(header);
  // Where W is only the front end can say: to begin at its origin would be another W when this
  // process was started again in the middle.
  if (window_ != nullptr || inputs.features) {
    const FrameResult result = Adjust(header, inputs);
    answer = {ToStateEstimate(header, result.estimate), ToMapUpdates(header, result.changes)};
    if (!IsValid(answer)) {  // led astray, as by a front end that jumps by thousands of kilometres
      window_.reset();
      answer = UnknownAnswer(header);
    }
  }
  Publish(channel::kStateEstimate, answer.state);
  for (const map_update_t& part : answer.updates) Publish(channel::kMapUpdate, part);
}

FrameResult OptimizerNode::Adjust(const Header& header, const OptimizerInputs& inputs) {
  if (window_ == nullptr) {
    window_ = std::make_unique<SlidingWindowOptimizer>(options_.window, camera());
  }
  try {
    return window_->Process(ToFrameInput(header, camera(),
                                         inputs.features ? &*inputs.features : nullptr,
                                         inputs.humans ? &*inputs.humans : nullptr));
  } catch (const std::exception&) {
    window_.reset();  // it may be halfway through; the front end knows where to go on
    throw;
  }
}

std::unique_ptr<Node> MakeOptimizerNode(ConfigReader* config) {
  return std::make_unique<OptimizerNode>(ReadOptimizerOptions(config));
}

}  // namespace airdos
