#include "common/human/human_track.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "common/util/check.h"

namespace airdos {
namespace {

constexpr double kLimbMotion = 0.02;    // unpredicted motion of a joint per frame, of the height
constexpr double kMaxSquaredError = 9;  // of one joint, when the sides are judged
constexpr std::size_t kMinJoints = 3;   // needed to measure the distance between two people
constexpr int kMaxMissedForSwap = 2;    // later, limbs have moved too far to tell the sides
// A joint whose flow deviates from the person's by more than this fraction of the height follows
// somebody else.
constexpr double kMaxFlowSpread = 0.2;

std::optional<Eigen::Vector2d> MedianVector(const std::vector<Eigen::Vector2d>& vectors) {
  std::vector<double> x, y;
  for (const Eigen::Vector2d& vector : vectors) {
    x.push_back(vector.x());
    y.push_back(vector.y());
  }
  if (x.size() < kMinJoints) return std::nullopt;
  return Eigen::Vector2d(*Median(x), *Median(y));
}

}  // namespace

HumanTrack::HumanTrack(const HumanTrackOptions& options, HumanId id, const PersonDetection& first)
    : options_(options),
      id_(id),
      left_(first.left),
      previous_left_(first.left),
      disparity_px_(first.disparity_px.value_or(0)),
      height_px_(first.height_px) {
  AIRDOS_CHECK(first.disparity_px.has_value());
  if (first.appearance) {
    appearance_ = *first.appearance;
    has_appearance_ = true;
  }
}

Eigen::Vector2d HumanTrack::Guess(std::size_t joint, const Eigen::Vector2d& shift_px) const {
  return left_[joint].uv_px() + shift_px + velocity_px_;
}

void HumanTrack::Predict(const std::array<std::optional<Eigen::Vector2d>, kNumJoints>& flow_px,
                         const Eigen::Vector2d& shift_px) {
  previous_left_ = left_;
  std::vector<Eigen::Vector2d> moves;
  for (std::size_t joint = 0; joint < left_.size(); ++joint) {
    if (left_[joint].confidence > 0 && flow_px[joint]) {
      moves.push_back(*flow_px[joint] - left_[joint].uv_px());
    }
  }
  Eigen::Vector2d common_px = shift_px + velocity_px_;
  std::optional<Eigen::Vector2d> median = MedianVector(moves);
  // Whoever is hidden by now must not be dragged along by the person in front.
  if (median && num_missed_ > 0 && (*median - common_px).norm() > kMaxFlowSpread * height_px_) {
    median.reset();
  }
  if (median) common_px = *median;
  for (std::size_t joint = 0; joint < left_.size(); ++joint) {
    const Eigen::Vector2d from = left_[joint].uv_px();
    is_carried_[joint] =
        median && flow_px[joint] && left_[joint].confidence > 0 &&
        (*flow_px[joint] - from - common_px).norm() < kMaxFlowSpread * height_px_ + 2;
    const Eigen::Vector2d to = is_carried_[joint] ? *flow_px[joint] : from + common_px;
    left_[joint].u_px = to.x();
    left_[joint].v_px = to.y();
  }
}

std::optional<double> HumanTrack::MedianDistance(const BodyKeypoints& other) const {
  std::vector<double> distances;
  for (std::size_t joint = 0; joint < left_.size(); ++joint) {
    if (left_[joint].confidence < options_.min_confidence) continue;
    if (other[joint].confidence < options_.min_confidence) continue;
    distances.push_back((left_[joint].uv_px() - other[joint].uv_px()).norm());
  }
  if (distances.size() < kMinJoints) return std::nullopt;
  return Median(distances);
}

std::optional<double> HumanTrack::Cost(const PersonDetection& detection) const {
  const std::optional<double> distance_px = MedianDistance(detection.left);
  if (!distance_px) return std::nullopt;
  const double motion = *distance_px / height_px_;
  if (motion > options_.max_motion_per_height + options_.max_motion_growth_per_height * num_missed_)
    return std::nullopt;
  const double sigma =
      options_.motion_sigma_per_height + options_.motion_sigma_growth_per_height * num_missed_;
  return std::pow(motion / sigma, 2) + LooksCost(detection);
}

double HumanTrack::LooksCost(const PersonDetection& detection) const {
  double cost = 0;
  if (detection.disparity_px) {
    const double depth_sigma = options_.depth_sigma + options_.depth_sigma_growth * num_missed_;
    const double measured_sigma = std::sqrt(2.0) * options_.disparity_sigma_px /
                                  std::min(disparity_px_, *detection.disparity_px);
    const double change = std::log(*detection.disparity_px / disparity_px_);
    cost += std::pow(change / std::hypot(depth_sigma, measured_sigma), 2);
  }
  std::optional<double> appearance;
  if (has_appearance_ && detection.appearance) {
    appearance = AppearanceDistance(appearance_, *detection.appearance);
  }
  return cost + (appearance ? std::pow(*appearance / options_.appearance_sigma, 2)
                            : options_.unknown_appearance_cost);
}

std::optional<Eigen::Vector2d> HumanTrack::Displacement(const PersonDetection& detection) const {
  std::vector<Eigen::Vector2d> moves;
  for (std::size_t joint = 0; joint < left_.size(); ++joint) {
    if (left_[joint].confidence < options_.min_confidence) continue;
    if (detection.left[joint].confidence < options_.min_confidence) continue;
    moves.push_back(detection.left[joint].uv_px() - left_[joint].uv_px());
  }
  return MedianVector(moves);
}

bool HumanTrack::HasSwap(const BodyKeypoints& left, SideSwap swap, double min_gain) const {
  if (num_missed_ > kMaxMissedForSwap) return false;
  const BodyKeypoints swapped = SwapSides(left, swap);
  double gain = 0;
  for (std::size_t joint = 0; joint < left_.size(); ++joint) {
    // Joints that the swap leaves in place do not contribute.
    const double confidence =
        std::min({left_[joint].confidence, left[joint].confidence, swapped[joint].confidence});
    if (confidence < options_.min_confidence) continue;
    const double sigma_px = options_.noise.Sigma(confidence, height_px_) * std::sqrt(2.0) +
                            kLimbMotion * height_px_ * (1 + num_missed_);
    const auto squared_error = [&](const BodyKeypoint& seen) {
      const double squared = (left_[joint].uv_px() - seen.uv_px()).squaredNorm();
      return std::min(squared / (sigma_px * sigma_px), kMaxSquaredError);
    };
    gain += squared_error(left[joint]) - squared_error(swapped[joint]);
  }
  return gain > min_gain;
}

void HumanTrack::Observe(const PersonDetection& detection, const Eigen::Vector2d& shift_px) {
  std::vector<Eigen::Vector2d> moves;
  for (std::size_t joint = 0; joint < left_.size(); ++joint) {
    if (previous_left_[joint].confidence < options_.min_confidence) continue;
    if (detection.left[joint].confidence < options_.min_confidence) continue;
    moves.push_back(detection.left[joint].uv_px() - previous_left_[joint].uv_px() - shift_px);
  }
  const std::optional<Eigen::Vector2d> move = MedianVector(moves);
  if (move) velocity_px_ += options_.velocity_rate * (*move - velocity_px_);
  left_ = detection.left;
  if (detection.disparity_px) {
    disparity_px_ = *detection.disparity_px;
    height_px_ = detection.height_px;
  }
  if (detection.appearance) {
    appearance_.Update(*detection.appearance, has_appearance_ ? options_.appearance_rate : 1);
    has_appearance_ = true;
  }
  ++num_seen_;
  num_missed_ = 0;
}

}  // namespace airdos
