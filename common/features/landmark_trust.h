#ifndef AIRDOS_COMMON_FEATURES_LANDMARK_TRUST_H_
#define AIRDOS_COMMON_FEATURES_LANDMARK_TRUST_H_

#include <Eigen/Core>
#include <map>
#include <utility>
#include <vector>

namespace airdos {

/// How likely it is that a landmark belongs to the static scene, learnt from the frames in which it
/// was searched for: a Beta distribution over "it was where the camera's pose predicts it". Older
/// frames count less and less, so somebody who stood still and now walks loses trust again.
class LandmarkTrust {
 public:
  LandmarkTrust() = default;
  /// `static_probability` is the belief before any observation, 0..1.
  explicit LandmarkTrust(double static_probability)
      : num_agreed_(kPriorFrames * static_probability),
        num_disagreed_(kPriorFrames * (1 - static_probability)) {}

  void Agree();
  void Disagree();

  double static_probability() const { return num_agreed_ / (num_agreed_ + num_disagreed_); }

 private:
  static constexpr double kPriorFrames = 2;

  double num_agreed_ = kPriorFrames;
  double num_disagreed_ = 0;
};

/// The verdicts on one frame's landmarks, over the image. They tell how far a new landmark can be
/// trusted before it has been seen again: next to a landmark that moved, other points at the same
/// depth probably belong to the same moving thing.
class TrustField {
 public:
  /// `base_probability` is used where there is no verdict nearby.
  explicit TrustField(double base_probability) : base_probability_(base_probability) {}

  void Add(const Eigen::Vector2d& uv_px, double depth_m, bool is_static);
  double At(const Eigen::Vector2d& uv_px, double depth_m) const;

 private:
  static constexpr double kRadius_px = 32;
  /// Whether one landmark turned out to be static.
  struct Verdict {
    Eigen::Vector2d uv_px;
    double depth_m;
    bool is_static;
  };
  static std::pair<int, int> CellOf(const Eigen::Vector2d& uv_px);

  double base_probability_;
  std::map<std::pair<int, int>, std::vector<Verdict>> cells_;
};

}  // namespace airdos

#endif  // AIRDOS_COMMON_FEATURES_LANDMARK_TRUST_H_
