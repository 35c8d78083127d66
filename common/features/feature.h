#ifndef AIRDOS_COMMON_FEATURES_FEATURE_H_
#define AIRDOS_COMMON_FEATURES_FEATURE_H_

#include <Eigen/Core>
#include <array>
#include <cstdint>

namespace airdos {

/// 256 bits of an ORB descriptor.
using Descriptor = std::array<std::uint64_t, 4>;

/// Number of bits that differ, 0..256.
inline int HammingDistance(const Descriptor& a, const Descriptor& b) {
  int distance = 0;
  for (std::size_t i = 0; i < a.size(); ++i) distance += __builtin_popcountll(a[i] ^ b[i]);
  return distance;
}

/// A corner in one image.
struct Feature {
  Eigen::Vector2d uv_px = Eigen::Vector2d::Zero();  ///< at level 0
  int level = 0;                                    ///< pyramid level it was found at
  float response = 0;                               ///< FAST score
  Descriptor descriptor{};
};

}  // namespace airdos

#endif  // AIRDOS_COMMON_FEATURES_FEATURE_H_
