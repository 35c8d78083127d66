#include "processes/node/message/types_fingerprint.h"

#include "airdos/frame_done_t.hpp"
#include "airdos/human_observations_t.hpp"
#include "airdos/image_t.hpp"
#include "airdos/map_update_t.hpp"
#include "airdos/person_keypoints_t.hpp"
#include "airdos/person_mask_t.hpp"
#include "airdos/pose_t.hpp"
#include "airdos/process_status_t.hpp"
#include "airdos/state_estimate_t.hpp"
#include "airdos/static_features_t.hpp"
#include "airdos/stereo_calibration_t.hpp"
#include "common/util/digest.h"

namespace airdos {
namespace {

template <class... Message>
std::map<std::string, std::int64_t> FingerprintsOf() {
  return {{Message::getTypeName(), Message::getHash()}...};
}

std::string ComputeFingerprint() {
  Digest digest;
  for (const auto& [name, fingerprint] : MessageTypes()) {
    const std::string line = name + " " + std::to_string(fingerprint) + "\n";
    digest.Add(line.data(), line.size());
  }
  return digest.Hex().substr(0, 16);
}

}  // namespace

const std::map<std::string, std::int64_t>& MessageTypes() {
  static const std::map<std::string, std::int64_t> types =
      FingerprintsOf<frame_done_t, human_observations_t, image_t, map_update_t, person_keypoints_t,
                     person_mask_t, pose_t, process_status_t, state_estimate_t, static_features_t,
                     stereo_calibration_t>();
  return types;
}

const std::string& TypesFingerprint() {
  static const std::string fingerprint = ComputeFingerprint();
  return fingerprint;
}

}  // namespace airdos
