#include "common/evaluation/seen_person.h"

#include <Eigen/Geometry>
#include <optional>

#include "common/evaluation/people_matching.h"

namespace airdos {
namespace {

constexpr double kMinJointDepthM = 0.2;
constexpr double kBoxMargin = 0.1;  // relative to the standing height
constexpr double kMostTimesSize = 2;

}  // namespace

SeenPerson See(const TruePersonState& person, const TrajectoryPose& T_W_C,
               const StereoCamera& camera, ImageSide side) {
  const bool is_left = side == kLeftImage;
  const std::optional<int>& num_told = is_left ? person.num_visible_left : person.num_visible_right;
  const std::set<int>& told = is_left ? person.visible_left : person.visible_right;
  SeenPerson seen;
  int num_inside = 0;
  for (auto [joint, p_C] : InCamera(person.joints, T_W_C)) {
    if (!is_left) p_C.x() -= camera.baseline_m;
    seen.joints_C[joint] = p_C;
    if (p_C.z() < kMinJointDepthM || !camera.IsInImage(camera.Project(p_C))) continue;
    ++num_inside;
    if (!num_told || told.count(joint) > 0) seen.visible.insert(joint);
  }
  const auto num_visible = static_cast<int>(seen.visible.size());
  const double depth_m = MiddleDepth(seen.joints_C);
  seen.band = DepthBand(depth_m);
  seen.is_to_be_seen = depth_m >= kMinPersonDepthM && depth_m <= kMaxPersonDepthM &&
                       num_told.value_or(num_visible) >= kMinVisibleJoints;
  if (num_inside < static_cast<int>(seen.joints_C.size())) {
    seen.sight = Sight::kCutOff;
  } else if (2 * num_visible < num_inside) {
    seen.sight = Sight::kHidden;
  }
  return seen;
}

bool IsOn(const Joints& detected_C, double height_px, const SeenPerson& person,
          const StereoCamera& camera) {
  const double depth_m = MiddleDepth(person.joints_C);
  if (depth_m < kMinPersonDepthM) return false;
  const double true_height_px = camera.fy_px * kPersonHeightM / depth_m;
  if (height_px >= kMostTimesSize * true_height_px) return false;
  if (height_px * kMostTimesSize <= true_height_px) return false;
  Eigen::AlignedBox2d box;
  for (const auto& [joint, p_C] : person.joints_C) {
    if (p_C.z() < kMinJointDepthM) continue;
    const Eigen::Vector2d uv_px = camera.Project(p_C);
    if (camera.IsInImage(uv_px)) box.extend(uv_px);
  }
  if (box.isEmpty()) return false;
  const Eigen::Vector2d margin = Eigen::Vector2d::Constant(kBoxMargin * true_height_px);
  box = Eigen::AlignedBox2d(box.min() - margin, box.max() + margin);
  std::size_t num_inside = 0;
  for (const auto& [joint, direction_C] : detected_C) {
    num_inside += box.contains(camera.Project(direction_C)) ? 1 : 0;
  }
  return 2 * num_inside >= detected_C.size();
}

}  // namespace airdos
