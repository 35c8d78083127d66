#include "processes/optimizer/optimizer_node.h"

#include <algorithm>
#include <exception>
#include <string>
#include <utility>
#include <vector>

#include "processes/optimizer/optimizer_messages.h"

namespace airdos {
namespace {

/// What is published for a frame.
struct Answer {
  state_estimate_t state;
  MapChanges changes;
};

Answer UnknownAnswer(const Header& header) { return {UnknownStateEstimate(header), MapChanges()}; }

/// Whether receivers would accept it.
bool IsValid(const Header& header, const Answer& answer) {
  const std::vector<map_update_t> updates = ToMapUpdates(header, answer.changes);
  return Validate(answer.state).empty() &&
         std::all_of(updates.begin(), updates.end(),
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
  DeclareOutput(channel::kStateEstimate);
  DeclareOutput(channel::kMapUpdate);
}

void OptimizerNode::StartSession(const Header&) {
  window_.reset();
  archive_ = LandmarkArchive();
  newest_utime_.reset();
}

void OptimizerNode::ProcessFrame(const Header& header, OptimizerInputs inputs) {
  Answer answer = UnknownAnswer(header);
  if (inputs.features && inputs.features->tracking_state == static_features_t::STATE_INVALID) {
    inputs.features.reset();  // the frontend knows nothing about the frame
  }
  // Only the frontend can tell where W is: if this process was restarted in the middle of a
  // session, starting at the origin would define a different W. And a frame that nothing was
  // measured in can only be predicted, which makes no sense backwards in time.
  const bool is_later = newest_utime_ && header.utime > *newest_utime_;
  if (inputs.features || (window_ != nullptr && is_later)) {
    newest_utime_ = header.utime;
    FrameResult result = Adjust(header, inputs);
    answer = {ToStateEstimate(header, result.estimate), std::move(result.changes)};
    if (!IsValid(header,
                 answer)) {  // misled, as by a frontend that jumps by thousands of kilometres
      window_.reset();
      answer = UnknownAnswer(header);
    }
  }
  Publish(channel::kStateEstimate, answer.state);
  if (inputs.features) tally_.Take(*inputs.features);
  tally_.Take(answer.state);
  if (archive_.Add(answer.changes)) {
    Warn("the map has more than " + std::to_string(LandmarkArchive::kMaxLandmarks) +
         " landmarks: the oldest are not repeated for receivers that join late; the recorder has "
         "them");
  }
  for (const map_update_t& part : ToMapUpdates(header, answer.changes, archive_.NextRepeated())) {
    Publish(channel::kMapUpdate, part);
  }
}

std::string OptimizerNode::summary() const {
  const RunTally::Counts counts = tally_.Count();
  return counts.num_frames == 0 ? "" : "poses: " + ToText(counts);
}

std::string OptimizerNode::why_in_vain() const {
  const std::int64_t num_incomplete = frames().num_incomplete;
  if (frames().num_done == 0 && num_incomplete > 0) {
    return "none of " + std::to_string(num_incomplete) +
           " frames has a pose: no CALIBRATION came for their session";
  }
  return WhyInVain(tally_.Count());
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
    window_.reset();  // it may be half updated; the frontend knows where to continue
    throw;
  }
}

std::unique_ptr<Node> MakeOptimizerNode(ConfigReader* config) {
  return std::make_unique<OptimizerNode>(ReadOptimizerOptions(config));
}

}  // namespace airdos
