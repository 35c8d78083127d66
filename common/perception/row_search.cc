#include "common/perception/row_search.h"

#include <algorithm>
#include <vector>

namespace airdos {
namespace {

constexpr double kMinExtent_px = 2;

}  // namespace

std::optional<PersonPose> FindInRightImage(const RowSearchOptions& options, const cv::Mat& left,
                                           const cv::Mat& right, const PersonPose& person) {
  const cv::Rect2d box = BoxOfJoints(person, options.min_score);
  const double height_px = std::max(box.width, box.height);
  const double half_range_px = options.max_disparity_per_height * height_px / 2;
  std::vector<double> disparities_px;
  for (const BodyKeypoint& joint : person.joints) {
    if (joint.confidence < options.min_score) continue;
    const auto disparity_px = RefineDisparity(options.refiner, left, right, joint.uv_px(),
                                              half_range_px, half_range_px, height_px);
    if (disparity_px) disparities_px.push_back(*disparity_px);
  }
  if (disparities_px.size() < static_cast<std::size_t>(options.min_joints)) return std::nullopt;
  const double middle_px = *Median(disparities_px);
  const double extent_px = std::max(kMinExtent_px, options.body_extent * middle_px);
  PersonPose found = person;
  int num_found = 0;
  for (BodyKeypoint& joint : found.joints) {
    if (joint.confidence <= 0) continue;
    const auto disparity_px = RefineDisparity(options.refiner, left, right, joint.uv_px(),
                                              middle_px, extent_px, height_px);
    if (!disparity_px) joint.confidence /= 2;
    if (disparity_px && joint.confidence >= options.min_score) ++num_found;
    joint.u_px -= disparity_px.value_or(middle_px);
  }
  if (num_found < options.min_joints) return std::nullopt;
  found.box_px.x -= middle_px;
  return found;
}

}  // namespace airdos
