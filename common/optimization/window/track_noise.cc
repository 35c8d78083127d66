#include "common/optimization/window/track_noise.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <vector>

#include "common/geometry/covariance.h"

namespace airdos {
namespace {

struct MeasuredPoint {
  Eigen::Vector3d p_W;
  Eigen::Matrix3d covariance_W;
};

/// The body points seen in one frame.
struct Sighting {
  int frame = 0;
  double time_s = 0;
  std::map<int, MeasuredPoint> points;
};

/// The point as measured, in W; nothing if it has no depth.
std::optional<MeasuredPoint> Measured(const BundleProblem& problem,
                                      const BundleProblem::JointState& joint) {
  const Se3& T_W_C = problem.frames[static_cast<std::size_t>(joint.frame)].T_W_C;
  const Eigen::Matrix3d R = T_W_C.rotation.toRotationMatrix();
  if (joint.point) {
    const double variance = joint.point->sigma_m * joint.point->sigma_m;
    return MeasuredPoint{T_W_C * joint.point->p_C, variance * Eigen::Matrix3d::Identity()};
  }
  const auto p_C = problem.camera.Triangulate(joint.uvu_px.x(), joint.uvu_px.y(), joint.uvu_px.z());
  if (!p_C) return std::nullopt;
  const Eigen::Matrix3d J_inverse = problem.camera.ProjectStereoJacobian(*p_C).inverse();
  const Eigen::Matrix3d RJ = R * J_inverse;
  return MeasuredPoint{T_W_C * *p_C, Propagated(RJ, joint.covariance_px2)};
}

std::vector<Sighting> BodySightings(const BundleProblem& problem,
                                    const BundleProblem::Human& human) {
  const std::vector<int>& body = human.model->body_points;
  std::map<int, Sighting> by_frame;
  for (const BundleProblem::JointState& joint : human.joints) {
    if (joint.is_rejected || std::count(body.begin(), body.end(), joint.joint) == 0) continue;
    const auto point = Measured(problem, joint);
    if (!point) continue;
    Sighting& sighting = by_frame[joint.frame];
    sighting.frame = joint.frame;
    sighting.time_s = problem.frames[static_cast<std::size_t>(joint.frame)].time_s;
    sighting.points.emplace(joint.joint, *point);
  }
  std::vector<Sighting> sightings;
  for (auto& [frame, sighting] : by_frame) sightings.push_back(std::move(sighting));
  return sightings;
}

/// The rotation that maps the points `before` to `after`, each set about its mean.
Eigen::Matrix3d TurnBetween(const std::vector<Eigen::Vector3d>& before,
                            const std::vector<Eigen::Vector3d>& after) {
  Eigen::Matrix3Xd a(3, static_cast<Eigen::Index>(before.size())), b = a;
  for (std::size_t i = 0; i < before.size(); ++i) {
    a.col(static_cast<Eigen::Index>(i)) = before[i];
    b.col(static_cast<Eigen::Index>(i)) = after[i];
  }
  return Eigen::umeyama(a, b, false).topLeftCorner<3, 3>();
}

double LogDensity(const Eigen::Vector3d& error, const Eigen::Matrix3d& S, double largest_chi2) {
  const double chi2 = std::min(SquaredMahalanobis(error, S), largest_chi2);
  return -0.5 * (chi2 + std::log(std::max(S.determinant(), 1e-60)));
}

/// Posterior mean of log sigma over a grid, given the log likelihood; returns its exponential.
double PosteriorMean(double prior, double prior_log_sigma, double least, double largest,
                     const std::function<double(double)>& log_likelihood) {
  constexpr int kSteps = 24;
  std::vector<double> log_sigmas, log_posteriors;
  for (int i = 0; i <= kSteps; ++i) {
    const double log_sigma = std::log(least) + i * std::log(largest / least) / kSteps;
    const double off = (log_sigma - std::log(prior)) / prior_log_sigma;
    log_sigmas.push_back(log_sigma);
    log_posteriors.push_back(log_likelihood(std::exp(log_sigma)) - 0.5 * off * off);
  }
  const double best = *std::max_element(log_posteriors.begin(), log_posteriors.end());
  double sum = 0, weights = 0;
  for (std::size_t i = 0; i < log_sigmas.size(); ++i) {
    const double weight = std::exp(log_posteriors[i] - best);
    sum += weight * log_sigmas[i];
    weights += weight;
  }
  return std::exp(sum / weights);
}

/// How each point's step deviates from the body's mean step, over all pairs of frames.
struct Scatter {
  std::vector<Eigen::Vector3d> errors;
  std::vector<Eigen::Matrix3d> covariances;  // of the measurements only
  std::vector<double> shares;  // of a point's variance left after subtracting the mean
};

Scatter ScatterAboutBody(const std::vector<Sighting>& sightings, const std::set<int>& breaks,
                         bool turns) {
  Scatter scatter;
  for (std::size_t i = 1; i < sightings.size(); ++i) {
    if (breaks.count(sightings[i].frame) > 0) continue;
    std::vector<Eigen::Vector3d> before, after;
    std::vector<Eigen::Matrix3d> covariances;
    Eigen::Vector3d mean_before = Eigen::Vector3d::Zero(), mean_after = Eigen::Vector3d::Zero();
    for (const auto& [index, point] : sightings[i - 1].points) {
      const auto next = sightings[i].points.find(index);
      if (next == sightings[i].points.end()) continue;
      before.push_back(point.p_W);
      after.push_back(next->second.p_W);
      mean_before += point.p_W;
      mean_after += next->second.p_W;
      covariances.push_back(point.covariance_W + next->second.covariance_W);
    }
    const double num = static_cast<double>(before.size());
    const double num_free = turns ? 6 : 3;
    if (3 * num <= num_free) continue;
    const Eigen::Matrix3d R =
        turns ? TurnBetween(before, after) : Eigen::Matrix3d(Eigen::Matrix3d::Identity());
    for (std::size_t j = 0; j < before.size(); ++j) {
      scatter.errors.push_back(after[j] - mean_after / num - R * (before[j] - mean_before / num));
      scatter.covariances.push_back(covariances[j]);
      scatter.shares.push_back(1 - num_free / (3 * num));
    }
  }
  return scatter;
}

/// The body's centre at each sighting, as if the same points were always seen: each point stands
/// for the centre through its mean offset from it.
struct Centre {
  int frame = 0;
  double time_s = 0;
  Eigen::Vector3d p_W;
  Eigen::Matrix3d covariance_W;
};

/// Mean offset of each point from the body's centre, over the sightings with the most points.
std::map<int, Eigen::Vector3d> Offsets(const std::vector<Sighting>& sightings) {
  std::size_t most = 0;
  for (const Sighting& sighting : sightings) most = std::max(most, sighting.points.size());
  std::map<int, Eigen::Vector3d> sums;
  std::map<int, int> counts;
  for (const Sighting& sighting : sightings) {
    if (sighting.points.size() < most) continue;  // the centre of fewer points is another point
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (const auto& [index, point] : sighting.points) mean += point.p_W;
    mean /= static_cast<double>(most);
    for (const auto& [index, point] : sighting.points) {
      sums.emplace(index, Eigen::Vector3d::Zero()).first->second += point.p_W - mean;
      ++counts[index];
    }
  }
  for (auto& [index, offset] : sums) offset /= counts[index];
  return sums;
}

std::vector<Centre> Centres(const std::vector<Sighting>& sightings, double camera_sigma_m) {
  const std::map<int, Eigen::Vector3d> offsets = Offsets(sightings);
  std::vector<Centre> centres;
  for (const Sighting& sighting : sightings) {
    Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
    Eigen::Vector3d weighted = Eigen::Vector3d::Zero();
    for (const auto& [index, point] : sighting.points) {
      const auto offset = offsets.find(index);
      if (offset == offsets.end()) continue;
      const Eigen::Matrix3d weight = Inverse(point.covariance_W);
      information += weight;
      weighted += weight * (point.p_W - offset->second);
    }
    if (information.isZero()) continue;
    const Eigen::Matrix3d covariance = Inverse(information);
    centres.push_back({sighting.frame, sighting.time_s, covariance * weighted,
                       covariance + camera_sigma_m * camera_sigma_m * Eigen::Matrix3d::Identity()});
  }
  return centres;
}

/// Constant-velocity filter of a body's centre.
class CentreFilter {
 public:
  void Start(const Centre& centre) {
    constexpr double kStartSigma_m_s = 2;
    x_ << centre.p_W, Eigen::Vector3d::Zero();
    P_.setZero();
    P_.topLeftCorner<3, 3>() = centre.covariance_W;
    P_.bottomRightCorner<3, 3>().diagonal().setConstant(kStartSigma_m_s * kStartSigma_m_s);
  }

  /// The velocity changes by sigma_m_s2 * step_s and the centre strays by step_sigma_m.
  void Predict(double step_s, double sigma_m_s2, double step_sigma_m) {
    Matrix6d F = Matrix6d::Identity();
    F.topRightCorner<3, 3>().diagonal().setConstant(step_s);
    const double sigma_m_s = sigma_m_s2 * step_s;
    P_.bottomRightCorner<3, 3>().diagonal().array() += sigma_m_s * sigma_m_s;
    x_ = F * x_;
    P_ = Propagated(F, P_);
    P_.topLeftCorner<3, 3>().diagonal().array() += step_sigma_m * step_sigma_m;
  }

  Eigen::Vector3d Innovation(const Centre& centre) const { return centre.p_W - x_.head<3>(); }
  Eigen::Matrix3d InnovationCovariance(const Centre& centre) const {
    return P_.topLeftCorner<3, 3>() + centre.covariance_W;
  }

  void Update(const Centre& centre) {
    const Eigen::Matrix<double, 6, 3> gain =
        P_.leftCols<3>() * Inverse(InnovationCovariance(centre));
    x_ += gain * Innovation(centre);
    P_ -= (gain * P_.topRows<3>()).eval();
    P_ = 0.5 * (P_ + P_.transpose()).eval();
  }

 private:
  Vector6d x_ = Vector6d::Zero();  // position, velocity
  Matrix6d P_ = Matrix6d::Zero();
};

constexpr double kMaxGap_s = 0.5;
constexpr double kGap = 1.5;  // in usual steps: a longer step is a gap

double CentreLogLikelihood(const std::vector<Centre>& centres, const std::set<int>& breaks,
                           double step_sigma_m, double sigma_m_s2, double largest_chi2) {
  double sum = 0;
  CentreFilter filter;
  for (std::size_t i = 0; i < centres.size(); ++i) {
    const double step_s = i > 0 ? centres[i].time_s - centres[i - 1].time_s : 0;
    if (i == 0 || step_s > kMaxGap_s || breaks.count(centres[i].frame) > 0) {
      filter.Start(centres[i]);
      continue;
    }
    filter.Predict(step_s, sigma_m_s2, step_sigma_m);
    sum += LogDensity(filter.Innovation(centres[i]), filter.InnovationCovariance(centres[i]),
                      largest_chi2);
    filter.Update(centres[i]);
  }
  return sum;
}

}  // namespace

MotionNoise EstimateMotionNoise(const TrackNoiseOptions& options, const BundleProblem& problem,
                                const BundleProblem::Human& human) {
  const std::vector<Sighting> sightings = BodySightings(problem, human);
  const bool turns = human.motion_form && *human.motion_form != MotionForm::kVelocity &&
                     *human.motion_form != MotionForm::kVelocityTrack;
  const Scatter scatter = ScatterAboutBody(sightings, human.track_breaks, turns);
  const std::vector<Centre> centres = Centres(sightings, options.camera_sigma_m);
  MotionNoise noise = options.prior;
  noise.motion_sigma_m = PosteriorMean(
      options.prior.motion_sigma_m, options.prior_log_sigma, options.least.motion_sigma_m,
      options.largest.motion_sigma_m, [&](double sigma_m) {
        double sum = 0;
        for (std::size_t i = 0; i < scatter.errors.size(); ++i) {
          const Eigen::Matrix3d S =
              scatter.shares[i] *
              (scatter.covariances[i] + sigma_m * sigma_m * Eigen::Matrix3d::Identity());
          // Consecutive steps of a point share an end, so only half of them are independent.
          sum += 0.5 * LogDensity(scatter.errors[i], S, options.largest_chi2);
        }
        return sum;
      });
  const double step_sigma_m =
      noise.motion_sigma_m / std::sqrt(static_cast<double>(human.model->body_points.size()));
  noise.acceleration_m_s2 = PosteriorMean(
      options.prior.acceleration_m_s2, options.prior_log_sigma, options.least.acceleration_m_s2,
      options.largest.acceleration_m_s2, [&](double sigma_m_s2) {
        return CentreLogLikelihood(centres, human.track_breaks, step_sigma_m, sigma_m_s2,
                                   options.largest_chi2);
      });
  return noise;
}

std::set<int> FindTrackBreaks(const TrackBreakOptions& options, const BundleProblem& problem,
                              const BundleProblem::Human& human) {
  std::set<int> breaks;
  const std::vector<Centre> centres =
      Centres(BodySightings(problem, human), options.camera_sigma_m);
  CentreFilter filter;
  double usual_step_s = kMaxGap_s;
  for (std::size_t i = 1; i < centres.size(); ++i) {
    usual_step_s = std::min(usual_step_s, centres[i].time_s - centres[i - 1].time_s);
  }
  double step_before_s = 0;
  for (std::size_t i = 0; i < centres.size(); ++i) {
    const double step_s = i > 0 ? centres[i].time_s - centres[i - 1].time_s : 0;
    if (i > 0 && step_s <= kMaxGap_s) {
      // Over a gap, changes of velocity add up like a random walk.
      filter.Predict(step_s, options.acceleration_m_s2 * std::sqrt(usual_step_s / step_s), 0);
      const Eigen::Vector3d innovation = filter.Innovation(centres[i]);
      const Eigen::Matrix3d S = filter.InnovationCovariance(centres[i]);
      if (SquaredMahalanobis(innovation, S) <= options.largest_chi2) {
        filter.Update(centres[i]);
        step_before_s = step_s;
        continue;
      }
      breaks.insert(centres[i].frame);
      // Right after a gap, the switch may have happened in it, with the filter too uncertain to
      // notice.
      if (step_before_s > kGap * usual_step_s) breaks.insert(centres[i - 1].frame);
    }
    filter.Start(centres[i]);
    step_before_s = 0;
  }
  return breaks;
}

}  // namespace airdos
