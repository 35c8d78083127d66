#include "common/evaluation/ground_truth_axes.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>

#include "common/geometry/se3.h"
#include "common/util/format.h"

namespace airdos {
namespace {

constexpr double kDegPerRad = 180.0 / 3.14159265358979323846;
constexpr double kMinRotationRmsDeg = 0.5;
constexpr double kMinTranslationRmsM = 0.05;
constexpr double kMinAgreement = 0.7;
constexpr double kLeastMargin = 0.01;
constexpr double kMostMargin = 0.1;
constexpr std::size_t kLongestStride = 10;

Eigen::Vector3d RotationVector(const TrajectoryPose& pose) {
  return LogSo3(Eigen::Quaterniond(pose.rotation).normalized());
}

/// Motions in body axes, one per column: rotation vectors and displacements.
struct Motions {
  Eigen::Matrix3Xd rotation;
  Eigen::Matrix3Xd translation;
};

Motions MotionsOf(const std::vector<TrajectoryPose>& poses, std::size_t stride) {
  const std::size_t num = poses.size() > stride ? poses.size() - stride : 0;
  Motions motions = {Eigen::Matrix3Xd(3, num), Eigen::Matrix3Xd(3, num)};
  for (std::size_t i = 0; i < num; ++i) {
    const TrajectoryPose motion = RelativePose(poses[i], poses[i + stride]);
    motions.rotation.col(static_cast<Eigen::Index>(i)) = RotationVector(motion);
    motions.translation.col(static_cast<Eigen::Index>(i)) = motion.position_m;
  }
  return motions;
}

double Rms(const Eigen::Matrix3Xd& vectors) {
  return vectors.cols() > 0 ? vectors.norm() / std::sqrt(static_cast<double>(vectors.cols())) : 0;
}

/// Cosine of the angle between two series of vectors.
double Cosine(const Eigen::Matrix3Xd& a, const Eigen::Matrix3Xd& b) {
  const double norm = a.norm() * b.norm();
  return norm > 0 ? a.cwiseProduct(b).sum() / norm : 0;
}

double AgreementOf(const Motions& estimate, const Motions& truth, const GroundTruthAxes& axes,
                   const AxesDecision& uses) {
  const Eigen::Matrix3d& S = axes.matrix();
  double sum = 0;
  if (uses.uses_rotation) {
    sum += Cosine(estimate.rotation, S.determinant() * S.transpose() * truth.rotation);
  }
  if (uses.uses_translation) sum += Cosine(estimate.translation, S.transpose() * truth.translation);
  return uses.uses_rotation && uses.uses_translation ? 0.5 * sum : sum;
}

/// The motions of both trajectories, and whether the ground truth moves enough to draw conclusions
/// from them.
struct ComparedMotions {
  Motions estimate;
  Motions truth;
  AxesDecision uses;
};

ComparedMotions Compare(const MatchedTrajectories& matched) {
  const std::size_t stride =
      std::clamp<std::size_t>(matched.estimate.size() / 4, 1, kLongestStride);
  ComparedMotions compared = {
      MotionsOf(matched.estimate, stride), MotionsOf(matched.ground_truth, stride), {}};
  compared.uses.uses_rotation = kDegPerRad * Rms(compared.truth.rotation) >= kMinRotationRmsDeg;
  compared.uses.uses_translation = Rms(compared.truth.translation) >= kMinTranslationRmsM;
  return compared;
}

/// The axis named by "y", "+y" or "-y".
std::optional<Eigen::Vector3d> ParseAxis(std::string text) {
  const double sign = !text.empty() && text[0] == '-' ? -1 : 1;
  if (!text.empty() && (text[0] == '-' || text[0] == '+')) text.erase(0, 1);
  if (text.size() != 1 || text[0] < 'x' || text[0] > 'z') return std::nullopt;
  return sign * Eigen::Vector3d::Unit(text[0] - 'x');
}

}  // namespace

GroundTruthAxes GroundTruthAxes::Ned() { return *Parse("y,z,x"); }

std::vector<GroundTruthAxes> GroundTruthAxes::All() {
  std::vector<GroundTruthAxes> all = {Optical(), Ned()};
  for (const double handedness : {1.0, -1.0}) {
    std::array<int, 3> axis = {0, 1, 2};
    do {
      for (int signs = 0; signs < 8; ++signs) {
        Eigen::Matrix3d S;
        for (int i = 0; i < 3; ++i) {
          S.col(i) = ((signs >> i) & 1 ? -1.0 : 1.0) *
                     Eigen::Vector3d::Unit(axis[static_cast<std::size_t>(i)]);
        }
        const GroundTruthAxes axes(S);
        if (S.determinant() * handedness > 0 && !axes.is_optical_or_ned()) all.push_back(axes);
      }
    } while (std::next_permutation(axis.begin(), axis.end()));
  }
  return all;
}

std::optional<GroundTruthAxes> GroundTruthAxes::Parse(const std::string& text) {
  std::string small = text;
  std::transform(small.begin(), small.end(), small.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (small == "optical") return Optical();
  if (small == "ned") return Ned();
  Eigen::Matrix3d S;
  for (int i = 0; i < 3; ++i) {
    const std::size_t comma = i < 2 ? small.find(',') : small.size();
    if (comma == std::string::npos) return std::nullopt;
    const std::optional<Eigen::Vector3d> axis = ParseAxis(small.substr(0, comma));
    if (!axis) return std::nullopt;
    S.col(i) = *axis;
    small.erase(0, comma + 1);
  }
  if (std::abs(S.determinant()) < 0.5) return std::nullopt;  // names an axis twice
  return GroundTruthAxes(S);
}

std::string GroundTruthAxes::Name() const {
  if (*this == Optical()) return "optical";
  if (*this == Ned()) return "NED";
  std::string name;
  for (int i = 0; i < 3; ++i) {
    int axis = 0;
    S_.col(i).cwiseAbs().maxCoeff(&axis);
    if (i > 0) name += ",";
    if (S_(axis, i) < 0) name += "-";
    name += static_cast<char>('x' + axis);
  }
  return name;
}

bool GroundTruthAxes::is_right_handed() const { return S_.determinant() > 0; }

TrajectoryPose ToOptical(const TrajectoryPose& pose, const GroundTruthAxes& axes) {
  const Eigen::Matrix3d& S = axes.matrix();
  TrajectoryPose optical = pose;
  optical.rotation = S.transpose() * pose.rotation * S;
  optical.position_m = S.transpose() * pose.position_m;
  return optical;
}

AxesDecision DetectAxes(const MatchedTrajectories& matched) {
  const ComparedMotions compared = Compare(matched);
  AxesDecision decision = compared.uses;
  const std::vector<GroundTruthAxes> all = GroundTruthAxes::All();
  std::vector<double> agreement;
  for (const GroundTruthAxes& axes : all) {
    agreement.push_back(AgreementOf(compared.estimate, compared.truth, axes, decision));
  }
  const double best = *std::max_element(agreement.begin(), agreement.end());
  decision.best_agreement = best;
  const double margin = std::clamp(3 * (1 - best), kLeastMargin, kMostMargin);
  bool is_found = false;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (agreement[i] < best - margin) {
      decision.best_other = std::max(decision.best_other, agreement[i]);
    } else if (!is_found) {
      is_found = true;
      decision.axes = all[i];
      decision.agreement = agreement[i];
    } else {
      decision.alternatives.push_back(all[i]);
    }
  }
  const bool is_optical_and_ned = std::count(decision.alternatives.begin(),
                                             decision.alternatives.end(), GroundTruthAxes::Ned());
  decision.is_known = best >= kMinAgreement && !is_optical_and_ned;
  return decision;
}

double AgreementIn(const GroundTruthAxes& axes, const MatchedTrajectories& matched) {
  const ComparedMotions compared = Compare(matched);
  return AgreementOf(compared.estimate, compared.truth, axes, compared.uses);
}

std::string AxesDecision::Explain() const {
  const char* const what = uses_rotation && uses_translation ? "rotations and displacements"
                           : uses_rotation                   ? "rotations"
                           : uses_translation                ? "displacements"
                                                             : "motions (there are hardly any)";
  return Format(
      "%s of estimate and ground truth in body axes agree by %.3f if it is %s (%s), by "
      "%.3f at most in other axes%s (1 = same, 0 = unrelated)",
      what, agreement, axes.Name().c_str(), axes.is_right_handed() ? "right-handed" : "left-handed",
      best_other, alternatives.empty() ? "" : " but the alternatives named");
}

}  // namespace airdos
