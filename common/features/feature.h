#ifndef AIRDOS_COMMON_FEATURES_FEATURE_H_
#define AIRDOS_COMMON_FEATURES_FEATURE_H_

#include <Eigen/Core>
#include <array>
#include <cstdint>

namespace airdos {

/// A 256-bit ORB descriptor.
using Descriptor = std::array<std::uint64_t, 4>;

/// Number of differing bits, 0..256. The counts of all words are summed in parallel, which takes
/// half as long as four calls to the compiler's library, for processors whose own instruction may
/// not be used.
inline int HammingDistance(const Descriptor& a, const Descriptor& b) {
  constexpr std::uint64_t kPairs = 0x5555555555555555;
  constexpr std::uint64_t kNibbles = 0x3333333333333333;
  constexpr std::uint64_t kBytes = 0x0f0f0f0f0f0f0f0f;
  constexpr std::uint64_t kShorts = 0x00ff00ff00ff00ff;
  std::array<std::uint64_t, 4> counts{};  // one count per four bits
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::uint64_t bits = a[i] ^ b[i];
    bits -= (bits >> 1) & kPairs;
    counts[i] = (bits & kNibbles) + ((bits >> 2) & kNibbles);
  }
  const std::uint64_t front = counts[0] + counts[1];  // at most 8, which fits into four bits
  const std::uint64_t back = counts[2] + counts[3];
  const std::uint64_t bytes =
      (front & kBytes) + ((front >> 4) & kBytes) + (back & kBytes) + ((back >> 4) & kBytes);
  const std::uint64_t shorts = (bytes & kShorts) + ((bytes >> 8) & kShorts);
  return static_cast<int>((shorts * 0x0001000100010001) >> 48);
}

/// A corner in one image.
struct Feature {
  Eigen::Vector2d uv_px = Eigen::Vector2d::Zero();  ///< at level 0
  int level = 0;                                    ///< pyramid level at which it was found
  float response = 0;                               ///< FAST score
  Descriptor descriptor{};
};

}  // namespace airdos

#endif  // AIRDOS_COMMON_FEATURES_FEATURE_H_
