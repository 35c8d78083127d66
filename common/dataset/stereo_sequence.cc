#include "common/dataset/stereo_sequence.h"

#include <filesystem>

#include "common/dataset/kitti_sequence.h"
#include "common/dataset/kitti_tracking_sequence.h"
#include "common/dataset/shibuya_sequence.h"
#include "common/util/error.h"

namespace airdos {

std::unique_ptr<StereoSequence> OpenStereoSequence(const std::string& folder) {
  namespace fs = std::filesystem;
  if (!fs::is_directory(folder)) throw InputError(folder + ": is not a folder");
  if (IsKittiTrackingSequence(folder)) return OpenKittiTrackingSequence(folder);
  if (fs::exists(folder + "/calib.txt")) return OpenKittiSequence(folder);
  if (fs::is_directory(folder + "/image_0") && fs::is_directory(folder + "/image_1")) {
    return OpenShibuyaSequence(folder);
  }
  throw InputError(folder +
                   ": no known layout: neither calib.txt (KITTI odometry) nor image_0 and image_1 "
                   "(TartanAir-Shibuya) are there, nor is it image_02/NNNN of KITTI tracking");
}

}  // namespace airdos
