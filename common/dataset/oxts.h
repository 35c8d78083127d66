#ifndef AIRDOS_COMMON_DATASET_OXTS_H_
#define AIRDOS_COMMON_DATASET_OXTS_H_

#include <string>
#include <vector>

#include "common/geometry/se3.h"

namespace airdos {

/// Poses of KITTI's inertial unit from its GPS/IMU records: T_W_I, one per row, where I has x
/// forward, y left, z up and W has x east, y north, z up; in m. A row has 30 numbers, of which the
/// first six are latitude, longitude (deg), altitude (m), roll, pitch, yaw (rad; yaw 0 is east,
/// counter-clockwise). Positions use the Mercator projection, as in KITTI's development kit: with s
/// = cos(latitude of the first row) and r = 6378137 m,
/// and r = 6378137 m,
///
///   x = s r pi longitude / 180,  y = s r ln(tan(pi (90 + latitude) / 360)),  z = altitude,
///   R = Rz(yaw) Ry(pitch) Rx(roll)
///
/// Throws InputError naming file and line.
std::vector<Se3> ReadOxts(const std::string& path);

}  // namespace airdos

#endif  // AIRDOS_COMMON_DATASET_OXTS_H_
