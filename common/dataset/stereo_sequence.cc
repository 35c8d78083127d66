#include "common/dataset/stereo_sequence.h"

#include <filesystem>

#include "common/dataset/folder_survey.h"
#include "common/dataset/kitti_sequence.h"
#include "common/dataset/kitti_tracking_sequence.h"
#include "common/dataset/recording/euroc_sequence.h"
#include "common/dataset/shibuya_sequence.h"
#include "common/util/error.h"

namespace airdos {
namespace {

namespace fs = std::filesystem;

enum class Layout { kNone, kKittiTracking, kKittiOdometry, kShibuya, kEuroc };

Layout FindLayout(const std::string& folder) {
  if (IsKittiTrackingSequence(folder)) return Layout::kKittiTracking;
  if (fs::exists(folder + "/calib.txt")) return Layout::kKittiOdometry;
  const bool has_images =
      fs::is_directory(folder + "/image_0") && fs::is_directory(folder + "/image_1");
  if (has_images) return Layout::kShibuya;
  return IsEurocSequence(folder) ? Layout::kEuroc : Layout::kNone;
}

void CheckCalibrationName(const std::string& folder, Layout layout, const std::string& name) {
  if (name.empty()) return;
  if (name != kPublicCalibration) {
    throw InputError("calibration '" + name + "': is unknown; the only known one is '" +
                     kPublicCalibration +
                     "' (640 x 360 px), any other belongs in calib.json of the data set");
  }
  if (layout != Layout::kShibuya) {
    throw InputError(folder + ": has its own calibration; calibration '" + name +
                     "' is for the TartanAir-Shibuya layout");
  }
}

}  // namespace

bool HasSequenceLayout(const std::string& folder) { return FindLayout(folder) != Layout::kNone; }

std::unique_ptr<StereoSequence> OpenStereoSequence(const std::string& given,
                                                   const SequenceOptions& options) {
  std::string folder = given;  // without trailing slashes, which messages would show
  while (folder.size() > 1 && folder.back() == '/') folder.pop_back();
  if (!fs::is_directory(folder)) throw InputError(folder + ": is not a folder");
  const Layout layout = FindLayout(folder);
  if (layout == Layout::kNone) throw InputError(folder + ": " + ExplainFolder(folder));
  CheckCalibrationName(folder, layout, options.calibration);
  if (layout == Layout::kKittiTracking) return OpenKittiTrackingSequence(folder);
  if (layout == Layout::kKittiOdometry) return OpenKittiSequence(folder);
  if (layout == Layout::kEuroc) return OpenEurocSequence(folder);
  return OpenShibuyaSequence(folder, options);
}

}  // namespace airdos
