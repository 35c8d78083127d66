#ifndef AIRDOS_COMMON_FEATURES_LANDMARK_TRUST_H_
#define AIRDOS_COMMON_FEATURES_LANDMARK_TRUST_H_

#include <Eigen/Core>
#include <map>
#include <utility>
#include <vector>

namespace airdos {

/// How sure it is that a landmark belongs to the static scene, learnt from the frames in which it
/// was looked for: a Beta distribution over "it was where the camera's pose says", old frames
/// counting ever less, so that somebody who stood and now walks loses the trust again.
class LandmarkTrust {
 public:
  LandmarkTrust() = default;
  /// `static_probability` is believed before anything was seen, 0..1.
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

/// What the landmarks of one frame turned out to be, over the image: from it follows how much a new
/// landmark can be trusted before it was ever seen again. Beside a landmark that moved, and as far
/// away, there are other points of whatever moved.
class TrustField {
 public:
  /// `base_probability` stands in where nothing is near.
  explicit TrustField(double base_probability) : base_probability_(base_probability) {}

  void Add(const Eigen::Vector2d& uv_px, double depth_m, bool is_static);
  double At(const Eigen::Vector2d& uv_px, double depth_m) const;

 private:
  static constexpr double kRadius_px = 32;
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
