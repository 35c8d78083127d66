#include "common/dataset/oxts.h"

#include <cmath>

#include "common/util/error.h"
#include "common/util/text_file.h"

namespace airdos {
namespace {

constexpr std::size_t kNumColumns = 30;
constexpr double kEarthRadiusM = 6378137;
constexpr double kPi = 3.14159265358979323846;
constexpr double kMaxLatitudeDeg = 89;  // Mercator's projection excludes the poles

Eigen::Quaterniond Turn(double angle_rad, const Eigen::Vector3d& axis) {
  return Eigen::Quaterniond(Eigen::AngleAxisd(angle_rad, axis));
}

}  // namespace

std::vector<Se3> ReadOxts(const std::string& path) {
  std::vector<Se3> poses;
  double scale = 0;
  for (const TextLine& line : ReadTextLines(path)) {
    const std::vector<double> row = ParseNumbers(path, line, 0);
    const std::string where = path + ":" + std::to_string(line.number);
    if (row.size() != kNumColumns) {
      throw InputError(where + ": must hold 30 numbers (OXTS), holds " +
                       std::to_string(row.size()));
    }
    const double latitude_deg = row[0];
    if (std::abs(latitude_deg) > kMaxLatitudeDeg) {
      throw InputError(where + ": latitude '" + line.words[0] + "' is out of range");
    }
    if (poses.empty()) scale = std::cos(latitude_deg * kPi / 180);
    Se3 T_W_I;
    T_W_I.translation = {
        scale * kEarthRadiusM * kPi * row[1] / 180,
        scale * kEarthRadiusM * std::log(std::tan(kPi * (90 + latitude_deg) / 360)), row[2]};
    T_W_I.rotation = Turn(row[5], Eigen::Vector3d::UnitZ()) *
                     Turn(row[4], Eigen::Vector3d::UnitY()) *
                     Turn(row[3], Eigen::Vector3d::UnitX());
    poses.push_back(T_W_I);
  }
  return poses;
}

}  // namespace airdos
