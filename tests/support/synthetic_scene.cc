#include "tests/support/synthetic_scene.h"

#include <algorithm>
#include <cmath>
#include <random>

#include "common/util/check.h"

namespace airdos {
namespace {

using Generator = std::mt19937;

double Normal(Generator* generator, double sigma) {
  return sigma > 0 ? std::normal_distribution<double>(0, sigma)(*generator) : 0.0;
}

/// One draw a statement, or several in braces: the order of a call's arguments is the compiler's
/// choice, and so would be the scene.
double Uniform(Generator* generator, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(*generator);
}

Se3 CameraPose(const SyntheticSceneOptions& options, int frame) {
  const double s = options.speed_m_s * options.step_s * frame;
  Vector6d pose;
  pose << 0.3 * std::sin(0.5 * s), 0.05 * (1 - std::cos(s)), s, 0.02 * std::sin(1.1 * s),
      0.06 * std::sin(0.7 * s), 0.01 * std::sin(1.7 * s);
  return Boxplus(Se3(), pose);
}

Eigen::Vector3d RandomPoint(const SyntheticSceneOptions& options, Generator* generator) {
  const double z = Uniform(generator, options.nearest_m, options.farthest_m);
  return {Uniform(generator, -0.5, 0.5) * z, Uniform(generator, -0.25, 0.25) * z, z};
}

bool Project(const StereoCamera& camera, const Se3& T_W_C, const Eigen::Vector3d& p_W,
             Eigen::Vector3d* uvu_px) {
  const Eigen::Vector3d p_C = T_W_C.inverse() * p_W;
  if (p_C.z() < 0.5) return false;
  *uvu_px = camera.ProjectStereo(p_C);
  return camera.IsInImage(uvu_px->head<2>()) && uvu_px->z() >= 0;
}

Eigen::Vector3d Noise(Generator* generator, double sigma) {
  Eigen::Vector3d noise;
  for (int i = 0; i < 3; ++i) noise[i] = Normal(generator, sigma);
  return noise;
}

void ObserveStatic(const SyntheticSceneOptions& options, const SyntheticScene& scene, int frame,
                   Generator* generator, FrameInput* input) {
  for (std::size_t i = 0; i < scene.static_points_W.size(); ++i) {
    if (static_cast<int>(input->features.size()) >= options.max_static_per_frame) return;
    StaticObservation feature;
    feature.id.value = static_cast<std::int64_t>(i);
    if (!Project(scene.camera, scene.T_W_C[static_cast<std::size_t>(frame)],
                 scene.static_points_W[i], &feature.uvu_px)) {
      continue;
    }
    feature.uvu_px += Noise(generator, options.sigma_px);
    if (Uniform(generator, 0, 1) < options.outlier_ratio) {
      feature.uvu_px.x() += Uniform(generator, 5, 30);
      feature.uvu_px.y() += Uniform(generator, -30, 30);
    }
    feature.has_right = !(Uniform(generator, 0, 1) < options.mono_ratio);
    feature.sigma_px = options.sigma_px > 0 ? options.sigma_px : 1.0;
    input->features.push_back(feature);
  }
}

void ObservePeople(const SyntheticSceneOptions& options, const SyntheticScene& scene, int frame,
                   Generator* generator, FrameInput* input) {
  const auto k = static_cast<std::size_t>(frame);
  for (std::size_t person = 0; person < scene.joints_W.size(); ++person) {
    HumanObservation human;
    human.id.value = static_cast<std::int64_t>(person) + 1;
    for (int joint = 0; joint < kNumJoints; ++joint) {
      JointObservation observation;
      observation.joint = joint;
      const Eigen::Vector3d& p_W = scene.joints_W[person][k][static_cast<std::size_t>(joint)];
      if (!Project(scene.camera, scene.T_W_C[k], p_W, &observation.uvu_px)) continue;
      observation.uvu_px += Noise(generator, options.joint_sigma_px);
      if (options.joint_sigma_px > 0)
        observation.covariance_px2 *= options.joint_sigma_px * options.joint_sigma_px;
      human.joints.push_back(observation);
    }
    if (!human.joints.empty()) input->humans.push_back(human);
  }
}

void AddWalkers(const SyntheticSceneOptions& options, Generator* generator, SyntheticScene* scene) {
  for (int person = 0; person < options.num_people; ++person) {
    Eigen::Vector3d start(0, 1, 0);
    start.z() = Uniform(generator, 6, 12);
    start.x() = Uniform(generator, -3, 3);
    double heading_rad = Uniform(generator, 0, 2 * M_PI);
    const double phase_rad = Uniform(generator, 0, 2 * M_PI);
    const double turn_rad_s = Uniform(generator, -0.1, 0.1);
    Eigen::Vector3d root = start;
    std::vector<std::array<Eigen::Vector3d, kNumJoints>> track;
    for (int frame = 0; frame < options.num_frames; ++frame) {
      const double time_s = frame * options.step_s;
      const Eigen::Quaterniond R = ExpSo3({0, heading_rad, 0});
      auto joints = WalkerJoints(phase_rad + 2 * M_PI * 0.9 * time_s);
      for (Eigen::Vector3d& joint : joints) joint = R * joint + root;
      track.push_back(joints);
      root += options.step_s * options.person_speed_m_s * (R * Eigen::Vector3d::UnitX());
      heading_rad += options.step_s * turn_rad_s;
    }
    scene->joints_W.push_back(track);
  }
}

}  // namespace

std::array<Eigen::Vector3d, kNumJoints> WalkerJoints(double phase_rad) {
  std::array<Eigen::Vector3d, kNumJoints> p;
  const double sway = 0.02 * std::sin(2 * phase_rad);
  p[kNeck] = {0.03, -0.55 + sway, 0};
  p[kNose] = p[kNeck] + Eigen::Vector3d(0.1, -0.2, 0);
  for (const double side : {1.0, -1.0}) {  // right, then left
    const bool is_right = side > 0;
    const int shoulder = is_right ? kRightShoulder : kLeftShoulder;
    const int hip = is_right ? kRightHip : kLeftHip;
    const double swing = 0.5 * std::sin(phase_rad + (is_right ? 0 : M_PI));
    const auto hang = [](double angle, double length) {
      return Eigen::Vector3d(length * std::sin(angle), length * std::cos(angle), 0);
    };
    const auto at = [&p](int joint) -> Eigen::Vector3d& {
      return p[static_cast<std::size_t>(joint)];
    };
    at(shoulder) = p[kNeck] + Eigen::Vector3d(0, 0.04, 0.18 * side);
    at(shoulder + 1) = at(shoulder) + hang(-swing, 0.30);
    at(shoulder + 2) = at(shoulder + 1) + hang(-swing + 0.3, 0.26);
    at(hip) = {0, sway, 0.12 * side};
    at(hip + 1) = at(hip) + hang(swing, 0.43);
    at(hip + 2) = at(hip + 1) + hang(swing - 0.3 * (1 - std::cos(phase_rad)), 0.42);
  }
  return p;
}

SyntheticScene MakeSyntheticScene(const SyntheticSceneOptions& options) {
  Generator generator(options.seed);
  SyntheticScene scene;
  scene.camera = {640, 360, 700, 700, 320, 180, 0.25};
  for (int frame = 0; frame < options.num_frames; ++frame) {
    scene.T_W_C.push_back(CameraPose(options, frame));
  }
  for (int i = 0; i < options.num_static; ++i) {
    scene.static_points_W.push_back(RandomPoint(options, &generator));
  }
  AddWalkers(options, &generator, &scene);
  Se3 T_O_C;
  for (int frame = 0; frame < options.num_frames; ++frame) {
    const auto k = static_cast<std::size_t>(frame);
    if (frame > 0) {
      Vector6d noise;
      noise << Noise(&generator, options.odometry_sigma_m),
          Noise(&generator, options.odometry_sigma_rad);
      T_O_C = Boxplus(T_O_C * (scene.T_W_C[k - 1].inverse() * scene.T_W_C[k]), noise);
    }
    FrameInput input;
    input.id.value = frame;
    input.time_s = frame * options.step_s;
    input.T_O_C = T_O_C;
    ObserveStatic(options, scene, frame, &generator, &input);
    ObservePeople(options, scene, frame, &generator, &input);
    scene.frames.push_back(input);
  }
  return scene;
}

double RmsPositionError(const std::vector<Se3>& estimate, const std::vector<Se3>& truth) {
  AIRDOS_CHECK(estimate.size() == truth.size() && !truth.empty());
  double sum = 0;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    sum += (estimate[i].translation - truth[i].translation).squaredNorm();
  }
  return std::sqrt(sum / static_cast<double>(truth.size()));
}

}  // namespace airdos
