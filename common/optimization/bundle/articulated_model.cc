#include "common/optimization/bundle/articulated_model.h"

#include <algorithm>

#include "common/human/skeleton.h"

namespace airdos {
namespace {

std::shared_ptr<const ArticulatedModel> MakeCocoBody() {
  auto model = std::make_shared<ArticulatedModel>();
  model->num_points = kNumJoints;
  for (const Segment& segment : kSegments) {
    model->segments.push_back({segment.joint_a, segment.joint_b});
  }
  for (const RigidPart& part : kParts) {
    model->parts.emplace_back(part.joints.begin(), part.joints.begin() + part.num_joints);
  }
  model->body_points.assign(kBodyJoints.begin(), kBodyJoints.end());
  return model;
}

}  // namespace

bool ArticulatedModel::IsValid() const {
  const auto is_point = [this](int point) { return point >= 0 && point < num_points; };
  const auto are_points = [&](const std::vector<int>& points) {
    return std::all_of(points.begin(), points.end(), is_point);
  };
  const auto is_segment = [&](const Segment& segment) {
    return is_point(segment.point_a) && is_point(segment.point_b) &&
           segment.point_a != segment.point_b;
  };
  return std::all_of(segments.begin(), segments.end(), is_segment) &&
         std::all_of(parts.begin(), parts.end(), are_points) && are_points(body_points);
}

std::shared_ptr<const ArticulatedModel> CocoBodyModel() {
  static const std::shared_ptr<const ArticulatedModel> model = MakeCocoBody();
  return model;
}

}  // namespace airdos
