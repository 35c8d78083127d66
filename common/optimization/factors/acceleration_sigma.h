#ifndef AIRDOS_COMMON_OPTIMIZATION_FACTORS_ACCELERATION_SIGMA_H_
#define AIRDOS_COMMON_OPTIMIZATION_FACTORS_ACCELERATION_SIGMA_H_

namespace airdos {

/// How hard the camera's carrier may accelerate: one standard deviation per axis.
struct AccelerationSigma {
  double linear_m_s2 = 2.0;
  double angular_rad_s2 = 5.0;
};

}  // namespace airdos

#endif  // AIRDOS_COMMON_OPTIMIZATION_FACTORS_ACCELERATION_SIGMA_H_
