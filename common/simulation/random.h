#ifndef AIRDOS_COMMON_SIMULATION_RANDOM_H_
#define AIRDOS_COMMON_SIMULATION_RANDOM_H_

#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <random>

namespace airdos {

/// Seeded random numbers that are the same with every standard library: the standard specifies the
/// engine exactly, but not its distributions. Never make two draws in one expression: the compiler
/// would choose which one comes first.
class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}

  double Uniform(double low, double high) {
    constexpr double kUnit = 1.0 / 9007199254740992.0;  // 2^-53
    return low + (high - low) * kUnit * static_cast<double>(engine_() >> 11);
  }
  double Sign() { return Uniform(-1, 1) < 0 ? -1.0 : 1.0; }
  /// Box-Muller transform, using one value of the pair.
  double Normal(double sigma) {
    const double radius = std::sqrt(-2 * std::log(1 - Uniform(0, 1)));
    return sigma * radius * std::cos(2 * M_PI * Uniform(0, 1));
  }
  Eigen::Vector3d Normal3(double sigma) {
    Eigen::Vector3d v;
    for (int i = 0; i < 3; ++i) v[i] = Normal(sigma);
    return v;
  }

 private:
  std::mt19937_64 engine_;
};

}  // namespace airdos

#endif  // AIRDOS_COMMON_SIMULATION_RANDOM_H_
