#include "tests/support/random_bundle.h"

#include <cmath>
#include <memory>
#include <random>

#include "common/geometry/se3.h"
#include "common/human/skeleton.h"
#include "tests/support/synthetic_scene.h"

namespace airdos {
namespace {

constexpr double kStep_s = 0.1;
constexpr double kNearest_m = 1;
constexpr double kPixelSigma = 1.0;
constexpr double kPointSigma_m = 0.03;
const StereoCamera kCamera{640, 360, 500, 500, 320, 180, 0.5};

std::shared_ptr<const ArticulatedModel> BoxModel() {
  auto model = std::make_shared<ArticulatedModel>();
  model->num_points = 6;
  model->parts = {{0, 1, 2, 3, 4, 5}};
  model->body_points = model->parts[0];
  model->segments = {{0, 1}, {1, 2}, {2, 3}, {3, 4}, {0, 5}, {2, 5}};
  return model;
}

class Maker {
 public:
  explicit Maker(const RandomBundleOptions& options) : options_(options), random_(options.seed) {}

  BundleProblem Make() {
    problem_.camera = kCamera;
    for (int k = 0; k < options_.num_frames; ++k) {
      const Se3 T_W_C{ExpSo3({0.01 * k, 0.03 * k, 0}), {0.02 * k, 0, 0.12 * k}};
      truth_.push_back(T_W_C);
      const bool is_fixed = k == 0 && options_.num_fixed_frames > 0;
      problem_.frames.push_back({FrameId{k}, kStep_s * k, Perturbed(T_W_C, is_fixed), is_fixed});
    }
    for (int i = 1; i < options_.num_fixed_frames; ++i) {
      const auto k = static_cast<std::size_t>(Uniform(0, options_.num_frames - 1e-9));
      problem_.frames[k].is_fixed = true;
      problem_.frames[k].T_W_C = truth_[k];
    }
    for (int i = 0; i < options_.num_landmarks; ++i) AddLandmark(i);
    for (int i = 0; i < options_.num_people; ++i) AddPerson(i);
    for (int i = 0; i < options_.num_objects; ++i) AddObject(options_.num_people + i);
    for (int k = 2; options_.has_accelerations && k < options_.num_frames; ++k) {
      problem_.accelerations.push_back({{k - 2, k - 1, k}, {1.0, 0.5}});
    }
    return problem_;
  }

 private:
  double Uniform(double from, double to) {
    return std::uniform_real_distribution<double>(from, to)(random_);
  }
  /// Drawn one after the other, z first: the order of a call's arguments would be the compiler's.
  Eigen::Vector3d InBox(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
    Eigen::Vector3d p = from;
    for (const int axis : {2, 1, 0}) {
      if (from[axis] < to[axis]) p[axis] = Uniform(from[axis], to[axis]);
    }
    return p;
  }
  bool Happens(double share) { return Uniform(0, 1) < share; }
  Eigen::Vector3d Noise(double sigma) {
    std::normal_distribution<double> normal(0, sigma);
    return {normal(random_), normal(random_), normal(random_)};
  }
  Se3 Perturbed(const Se3& T_W_C, bool is_fixed) {
    if (is_fixed) return T_W_C;
    Vector6d delta;
    delta << Noise(0.03), Noise(0.005);
    return Boxplus(T_W_C, delta);
  }

  /// Fills in the measurement of any kind of observation.
  template <class Observation>
  void Measure(const Eigen::Vector3d& p_W, Observation* observation) {
    const Eigen::Vector3d p_C =
        truth_[static_cast<std::size_t>(observation->frame)].inverse() * p_W;
    const double factor = Happens(options_.outliers) ? 8 : 1;
    if (options_.has_point_measurements) {
      observation->point = {p_C + Noise(factor * kPointSigma_m), kPointSigma_m};
    } else {
      observation->uvu_px = kCamera.ProjectStereo(p_C) + Noise(factor * kPixelSigma);
    }
  }

  void AddLandmark(int id) {
    const Eigen::Vector3d p_W = InBox({-4, -2, 4}, {4, 2, 15});
    const bool is_fixed = Happens(options_.fixed_landmarks);
    problem_.landmarks.push_back(
        {LandmarkId{id}, is_fixed ? p_W : Eigen::Vector3d(p_W + Noise(0.1)), is_fixed});
    for (int k = 0; k < options_.num_frames; ++k) {
      const bool is_behind = (truth_[static_cast<std::size_t>(k)].inverse() * p_W).z() < kNearest_m;
      if (Happens(0.3) || is_behind) continue;
      BundleProblem::LandmarkObservation observation;
      observation.frame = k;
      observation.landmark = id;
      observation.has_right = !Happens(options_.mono);
      Measure(p_W, &observation);
      problem_.observations.push_back(observation);
    }
  }

  void AddSighting(int frame, const std::vector<Eigen::Vector3d>& points_W,
                   BundleProblem::Human* human) {
    if (Happens(options_.gaps)) return;
    for (std::size_t i = 0; i < points_W.size(); ++i) {
      const double depth_m = (truth_[static_cast<std::size_t>(frame)].inverse() * points_W[i]).z();
      if (Happens(options_.missing_joints) || depth_m < kNearest_m) continue;
      BundleProblem::JointState joint;
      joint.frame = frame;
      joint.joint = static_cast<int>(i);
      joint.p_W = points_W[i] + Noise(0.04);
      joint.covariance_px2 = kPixelSigma * kPixelSigma * Eigen::Matrix3d::Identity();
      joint.covariance_px2(0, 1) = joint.covariance_px2(1, 0) = 0.3 * kPixelSigma * kPixelSigma;
      Measure(points_W[i], &joint);
      human->joints.push_back(joint);
    }
  }

  void SetLengths(double length_m, BundleProblem::Human* human) {
    const std::size_t num = human->model->segments.size();
    human->segment_length_m.assign(num, std::nullopt);
    human->known_length_m.assign(num, std::nullopt);
    human->known_length_sigma_m.assign(num, 0.02);
    for (std::size_t i = 0; i < num; ++i) {
      if (Happens(0.1)) continue;
      human->segment_length_m[i] = length_m + Uniform(-0.05, 0.05);
      if (options_.has_known_lengths && Happens(0.5)) human->known_length_m[i] = length_m;
    }
  }

  void AddPerson(int id) {
    BundleProblem::Human human;
    human.id = HumanId{id};
    human.motion_form = options_.person_motion;
    SetLengths(0.3, &human);
    const Eigen::Vector3d start_W = InBox({-3, 0.5, 5}, {3, 0.5, 9});
    const Eigen::Vector3d velocity = InBox({-1, 0, -1}, {1, 0, 1});
    for (int k = 0; k < options_.num_frames; ++k) {
      std::vector<Eigen::Vector3d> points_W;
      for (const Eigen::Vector3d& joint : WalkerJoints(0.5 * k)) {
        points_W.push_back(start_W + joint + kStep_s * k * velocity);
      }
      AddSighting(k, points_W, &human);
    }
    if (options_.has_track_breaks) human.track_breaks = {options_.num_frames / 2};
    problem_.humans.push_back(human);
  }

  void AddObject(int id) {
    BundleProblem::Human object;
    object.id = HumanId{id};
    object.model = BoxModel();
    object.motion_form = options_.object_motion;
    object.motion_noise = MotionNoise{0.02, 1.0, 1.0};
    SetLengths(1.0, &object);
    std::vector<Eigen::Vector3d> points_W;
    const Eigen::Vector3d centre_W = InBox({-3, 0.5, 6}, {3, 0.5, 9});
    for (int i = 0; i < 6; ++i) {
      points_W.emplace_back(
          centre_W + Eigen::Vector3d(i & 1 ? 0.8 : -0.8, i & 2 ? 0.5 : -0.5, i & 4 ? 0.9 : -0.4));
    }
    const Eigen::Matrix3d R = ExpSo3({0, 0.03, 0.01}).toRotationMatrix();
    for (int k = 0; k < options_.num_frames; ++k) {
      AddSighting(k, points_W, &object);
      for (Eigen::Vector3d& p_W : points_W) {
        p_W = R * (p_W - centre_W) + centre_W + Eigen::Vector3d(0.05, 0, 0.08);
      }
    }
    if (options_.has_track_breaks) object.track_breaks = {options_.num_frames / 2};
    problem_.humans.push_back(object);
  }

  RandomBundleOptions options_;
  std::mt19937_64 random_;
  std::vector<Se3> truth_;
  BundleProblem problem_;
};

}  // namespace

BundleProblem MakeRandomBundle(const RandomBundleOptions& options) { return Maker(options).Make(); }

}  // namespace airdos
