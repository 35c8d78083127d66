#include "processes/human_tracker/people_watch.h"

#include <cmath>
#include <optional>
#include <utility>

namespace airdos {
namespace {

constexpr double kMinConfidence = 0.2;
constexpr int kMinJoints = 5;       // of a person, in both images
constexpr double kMaxError_px = 8;  // between the same joints, after a shift along the row
constexpr double kNoSign_px = 0.3;
constexpr int kMinPeople = 20;
constexpr double kMinShare = 0.7;

struct Likeness {
  double error_px = 0;
  double disparity_px = 0;
};

/// How well two detections match after a shift along the row. Nothing if they share too few joints.
std::optional<Likeness> Compare(const BodyKeypoints& left, const BodyKeypoints& right) {
  double sum_px = 0;
  double num = 0;
  const auto are_seen = [&](std::size_t i) {
    return left[i].confidence >= kMinConfidence && right[i].confidence >= kMinConfidence;
  };
  for (std::size_t i = 0; i < left.size(); ++i) {
    if (!are_seen(i)) continue;
    sum_px += left[i].u_px - right[i].u_px;
    ++num;
  }
  if (num < kMinJoints) return std::nullopt;
  Likeness likeness;
  likeness.disparity_px = sum_px / num;
  for (std::size_t i = 0; i < left.size(); ++i) {
    if (!are_seen(i)) continue;
    const double du_px = left[i].u_px - right[i].u_px - likeness.disparity_px;
    likeness.error_px += std::hypot(du_px, left[i].v_px - right[i].v_px) / num;
  }
  return likeness;
}

}  // namespace

std::string PeopleWatch::Add(const std::vector<BodyKeypoints>& left,
                             const std::vector<BodyKeypoints>& right) {
  const bool is_due = schedule_.IsDue();
  if (is_said_) return "";
  num_left_ += static_cast<int>(left.size());
  num_right_ += static_cast<int>(right.size());
  for (const BodyKeypoints& person : left) {
    std::optional<Likeness> best;
    for (const BodyKeypoints& other : right) {
      const std::optional<Likeness> likeness = Compare(person, other);
      if (likeness && (!best || likeness->error_px < best->error_px)) best = likeness;
    }
    if (!best || !(best->error_px < kMaxError_px)) continue;
    ++num_pairs_;
    num_negative_ += best->disparity_px < -kNoSign_px ? 1 : 0;
    num_zero_ += std::abs(best->disparity_px) <= 1e-3 && best->error_px <= 1e-3 ? 1 : 0;
  }
  return is_due ? Judge() : "";
}

std::string PeopleWatch::Judge() {
  const int num_left = std::exchange(num_left_, 0);
  const int num_right = std::exchange(num_right_, 0);
  const int num_pairs = std::exchange(num_pairs_, 0);
  const int num_negative = std::exchange(num_negative_, 0);
  const int num_zero = std::exchange(num_zero_, 0);
  const auto of_pairs = [&](int number) {
    return std::to_string(number) + " of " + std::to_string(num_pairs) + " people ";
  };
  std::string text;
  if (num_pairs >= kMinPeople && num_zero > kMinShare * num_pairs) {
    text = "left and right keypoints are the same: " + of_pairs(num_zero) +
           "have no disparity; the right ones must be detected in the right image";
  } else if (num_pairs >= kMinPeople && num_negative > kMinShare * num_pairs) {
    text = "left and right keypoints are exchanged: " + of_pairs(num_negative) +
           "have a negative disparity";
  } else if (num_left >= kMinPeople && num_right == 0) {
    text = "nobody in the right keypoints, " + std::to_string(num_left) +
           " people in the left ones: without the right ones their depth is searched for in the "
           "right image alone";
  } else if (num_right >= kMinPeople && num_left == 0) {
    text = "nobody in the left keypoints, " + std::to_string(num_right) +
           " people in the right ones: only people in the left image are tracked";
  }
  is_said_ = !text.empty();
  return text;
}

}  // namespace airdos
