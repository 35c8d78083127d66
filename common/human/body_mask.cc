#include "common/human/body_mask.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <optional>

namespace airdos {
namespace {

// Widths as fractions of the standing height: of a limb with its clothes, of trunk and head.
constexpr double kLimb = 0.10;
constexpr double kTrunk = 0.14;
constexpr double kHead = 0.17;
constexpr int kMinJoints = 3;
constexpr std::array<int, 4> kTrunkJoints = {kRightShoulder, kLeftShoulder, kLeftHip, kRightHip};

class Painter {
 public:
  Painter(const BodyKeypoints& person, double min_confidence, cv::Mat* mask)
      : person_(person), min_confidence_(min_confidence), mask_(mask) {}

  void Paint() {
    const std::optional<double> height_px = StandingHeight();
    if (!height_px) return;
    for (const Segment& segment : kSegments) {
      const bool is_trunk = IsTrunk(segment.joint_a) && IsTrunk(segment.joint_b);
      PaintLine(segment.joint_a, segment.joint_b, (is_trunk ? kTrunk : kLimb) * *height_px);
    }
    PaintTrunk();
    PaintDisc(kNose, kHead * *height_px);
    // Hands and feet extend beyond wrists and ankles.
    for (const int joint : {kRightWrist, kLeftWrist, kRightAnkle, kLeftAnkle})
      PaintDisc(joint, 1.3 * kLimb * *height_px);
  }

 private:
  static bool IsTrunk(int joint) {
    return joint == kNeck ||
           std::find(kTrunkJoints.begin(), kTrunkJoints.end(), joint) != kTrunkJoints.end();
  }
  bool IsSeen(int joint) const {
    return Keypoint(joint).confidence >= min_confidence_ && Keypoint(joint).uv_px().allFinite();
  }
  const BodyKeypoint& Keypoint(int joint) const { return person_[static_cast<std::size_t>(joint)]; }
  cv::Point At(int joint) const {
    // Points far outside the image paint nothing anyway, and OpenCV needs small coordinates.
    const auto pixel = [](double px) {
      return static_cast<int>(std::lround(std::clamp(px, -1e4, 1e4)));
    };
    return {pixel(Keypoint(joint).u_px), pixel(Keypoint(joint).v_px)};
  }

  /// From the visible limb that is longest relative to an adult's, and from the extent of the
  /// joints: foreshortening can only make each of them shorter.
  std::optional<double> StandingHeight() const {
    int num_seen = 0;
    double height_px = 0;
    double top_px = 0, bottom_px = 0;
    for (int joint = 0; joint < kNumJoints; ++joint) {
      if (!IsSeen(joint)) continue;
      const double v_px = Keypoint(joint).v_px;
      top_px = num_seen == 0 ? v_px : std::min(top_px, v_px);
      bottom_px = num_seen == 0 ? v_px : std::max(bottom_px, v_px);
      ++num_seen;
    }
    if (num_seen < kMinJoints) return std::nullopt;
    for (const Segment& segment : kSegments) {
      if (segment.typical_length_m < 0.3 || !IsSeen(segment.joint_a) || !IsSeen(segment.joint_b))
        continue;
      const double length_px =
          (Keypoint(segment.joint_a).uv_px() - Keypoint(segment.joint_b).uv_px()).norm();
      height_px = std::max(height_px, kPersonHeightM * length_px / segment.typical_length_m);
    }
    height_px = std::max(height_px, bottom_px - top_px);
    const double largest_px = 3.0 * std::max(mask_->rows, mask_->cols);
    if (!(height_px > 1 && height_px < largest_px)) return std::nullopt;
    return height_px;
  }

  void PaintLine(int a, int b, double width_px) {
    if (!IsSeen(a) || !IsSeen(b)) return;
    // OpenCV draws lines up to 32767 px thick, with round ends.
    const int thickness = std::max(1, static_cast<int>(std::lround(width_px)));
    cv::line(*mask_, At(a), At(b), cv::Scalar(255), thickness);
  }
  void PaintDisc(int joint, double diameter_px) {
    if (!IsSeen(joint)) return;
    const int radius = std::max(1, static_cast<int>(std::lround(0.5 * diameter_px)));
    cv::circle(*mask_, At(joint), radius, cv::Scalar(255), cv::FILLED);
  }
  void PaintTrunk() {
    std::vector<cv::Point> corners;
    for (const int joint : kTrunkJoints) {
      if (IsSeen(joint)) corners.push_back(At(joint));
    }
    if (corners.size() < 3) return;
    std::vector<cv::Point> hull;
    cv::convexHull(corners, hull);
    cv::fillConvexPoly(*mask_, hull, cv::Scalar(255));
  }

  const BodyKeypoints& person_;
  double min_confidence_;
  cv::Mat* mask_;
};

}  // namespace

cv::Mat DrawBodyMask(const std::vector<BodyKeypoints>& people, const cv::Size& size,
                     double min_confidence) {
  cv::Mat mask = cv::Mat::zeros(size, CV_8UC1);
  for (const BodyKeypoints& person : people) Painter(person, min_confidence, &mask).Paint();
  return mask;
}

}  // namespace airdos
