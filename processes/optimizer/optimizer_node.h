#ifndef AIRDOS_PROCESSES_OPTIMIZER_OPTIMIZER_NODE_H_
#define AIRDOS_PROCESSES_OPTIMIZER_OPTIMIZER_NODE_H_

#include <memory>
#include <optional>
#include <string>

#include "airdos/human_observations_t.hpp"
#include "airdos/static_features_t.hpp"
#include "common/config/config_reader.h"
#include "common/optimization/window/sliding_window.h"
#include "processes/node/frame_node.h"
#include "processes/node/run_tally.h"
#include "processes/optimizer/landmark_archive.h"
#include "processes/optimizer/optimizer_options.h"

namespace airdos {

/// The messages of one frame.
struct OptimizerInputs {
  std::optional<static_features_t> features;
  std::optional<human_observations_t> humans;  ///< only where people are on
};

/// STATIC_FEATURES and, with `people: on`, HUMAN_OBSERVATIONS in; STATE_ESTIMATE and MAP_UPDATE
/// (one or more parts) out, once per frame. A frame whose inputs never arrived is predicted if it
/// is later than the previous one; otherwise, and for frames before the first STATIC_FEATURES,
/// nothing is known (STATUS_INVALID). W is defined by the frontend's first message, so a restarted
/// process continues in the same W. It also starts afresh after an estimate that exceeds the bounds
/// of its message, which is not published. Each MAP_UPDATE repeats some landmarks, so that
/// receivers that start late get the map as well.
class OptimizerNode final : public FrameNode<OptimizerInputs> {
 public:
  explicit OptimizerNode(const OptimizerOptions& options);

  /// How many frames have a pose, and where these came from.
  std::string summary() const override;
  std::string why_in_vain() const override;

 private:
  void StartSession(const Header& header) override;
  void ProcessFrame(const Header& header, OptimizerInputs inputs) override;
  FrameResult Adjust(const Header& header, const OptimizerInputs& inputs);

  OptimizerOptions options_;
  std::unique_ptr<SlidingWindowOptimizer> window_;  // of the session; null before its first frame
  RunTally tally_;                                  // over all sessions
  LandmarkArchive archive_;                         // of the session
  std::optional<std::int64_t> newest_utime_;        // of the session, among frames with a pose
};

std::unique_ptr<Node> MakeOptimizerNode(ConfigReader* config);

}  // namespace airdos

#endif  // AIRDOS_PROCESSES_OPTIMIZER_OPTIMIZER_NODE_H_
