#include "tests/support/people_street.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>
#include <vector>

#include "common/geometry/se3.h"
#include "common/human/skeleton.h"
#include "tests/support/synthetic_scene.h"

namespace airdos {
namespace {

const StereoCamera kCamera{640, 360, 772, 772, 320, 180, 0.25};

class Street {
 public:
  explicit Street(const PeopleStreetOptions& options) : options_(options), random_(options.seed) {}

  /// Makes the frames [0, num_frames). Random numbers are drawn in such an order that a longer
  /// street starts like a shorter one.
  BundleProblem Make(int num_frames) {
    BundleProblem problem;
    problem.camera = kCamera;
    MakeScene();
    problem.humans.resize(people_.size());
    for (std::size_t i = 0; i < people_.size(); ++i) {
      problem.humans[i].id = HumanId{static_cast<std::int64_t>(i)};
      for (std::size_t s = 0; s < kNumSegments; ++s) {
        problem.humans[i].segment_length_m[s] = kSegments[s].typical_length_m + Normal(0.02);
      }
    }
    Se3 T_W_C_start, T_W_C_before;
    for (int k = 0; k < num_frames; ++k) {
      const Se3 T_W_C = TrueCamera(k);
      if (k == 0) {
        T_W_C_start = T_W_C;
      } else {
        Vector6d noise;
        noise << Noise(options_.odometry_sigma_m), Noise(options_.odometry_sigma_rad);
        T_W_C_start = T_W_C_start * Boxplus(T_W_C_before.inverse() * T_W_C, noise);
      }
      T_W_C_before = T_W_C;
      problem.frames.push_back({FrameId{k}, options_.step_s * k, T_W_C_start, k == 0});
      AddFrame(k, T_W_C, &problem);
    }
    return problem;
  }

 private:
  struct Person {
    Eigen::Vector3d start_W, velocity;
    double heading_rad = 0, phase_rad = 0;
  };

  /// One draw a statement, or several in braces: a call's arguments have no order.
  double Uniform(double from, double to) {
    return std::uniform_real_distribution<double>(from, to)(random_);
  }
  double Normal(double sigma) { return std::normal_distribution<double>(0, sigma)(random_); }
  Eigen::Vector3d Noise(double sigma) { return {Normal(sigma), Normal(sigma), Normal(sigma)}; }

  static Se3 TrueCamera(int frame) {
    const double s = 0.03 * frame;
    return {ExpSo3({0.01 * std::sin(s), 0.05 * std::sin(2 * s), 0}), {0.2 * std::sin(s), 0, s}};
  }

  void MakeScene() {
    for (int i = 0; i < options_.num_landmarks; ++i) {
      const double z = Uniform(5, 20);
      const double y = Uniform(-0.4, 0.4) * z;
      const double x = Uniform(-0.6, 0.6) * z;
      landmarks_.emplace_back(x, y, z);
    }
    for (int i = 0; i < options_.num_people; ++i) {
      const double heading_rad = Uniform(0, 2 * M_PI);
      const Eigen::Vector3d direction = ExpSo3({0, heading_rad, 0}) * Eigen::Vector3d::UnitX();
      people_.push_back({{Uniform(-2, 2), 0.5, Uniform(6, 10)},
                         0.6 * direction,
                         heading_rad,
                         Uniform(0, 2 * M_PI)});
    }
  }

  void AddFrame(int k, const Se3& T_W_C, BundleProblem* problem) {
    const Se3& T_W_C_start = problem->frames.back().T_W_C;
    const Se3 T_C_W = T_W_C.inverse();
    for (int i = 0; i < options_.num_landmarks; ++i) {
      BundleProblem::LandmarkObservation seen;
      seen.frame = k;
      seen.landmark = i;
      seen.uvu_px = kCamera.ProjectStereo(T_C_W * landmarks_[static_cast<std::size_t>(i)]) +
                    Noise(options_.sigma_px);
      seen.sigma_px = options_.sigma_px;
      if (k == 0) {
        problem->landmarks.push_back(
            {LandmarkId{i}, T_W_C_start * Triangulate(seen.uvu_px), false});
      }
      problem->observations.push_back(seen);
    }
    for (std::size_t i = 0; i < people_.size(); ++i) {
      const Person& person = people_[i];
      const auto joints = WalkerJoints(person.phase_rad + 0.5 * k);
      for (int j = 0; j < kNumJoints; ++j) {
        const Eigen::Vector3d p_W =
            ExpSo3({0, person.heading_rad, 0}) * joints[static_cast<std::size_t>(j)] +
            person.start_W + options_.step_s * k * person.velocity;
        BundleProblem::JointState joint;
        joint.frame = k;
        joint.joint = j;
        joint.uvu_px = kCamera.ProjectStereo(T_C_W * p_W) + Noise(options_.joint_sigma_px);
        joint.covariance_px2 *= options_.joint_sigma_px * options_.joint_sigma_px;
        joint.p_W = T_W_C_start * Triangulate(joint.uvu_px);
        problem->humans[i].joints.push_back(joint);
      }
    }
  }

  static Eigen::Vector3d Triangulate(const Eigen::Vector3d& uvu_px) {
    const double disparity_px = std::max(uvu_px.x() - uvu_px.z(), 1.0);
    return *kCamera.Triangulate(uvu_px.x(), uvu_px.y(), uvu_px.x() - disparity_px);
  }

  PeopleStreetOptions options_;
  std::mt19937_64 random_;
  std::vector<Eigen::Vector3d> landmarks_;
  std::vector<Person> people_;
};

}  // namespace

BundleProblem MakePeopleStreet(const PeopleStreetOptions& options) {
  return Street(options).Make(options.num_frames);
}

BundleProblem SlideWindow(const BundleOptions& solver, const PeopleStreetOptions& options) {
  BundleProblem before = MakePeopleStreet(options);
  SolveBundle(solver, &before);
  BundleProblem problem = Street(options).Make(options.num_frames + 1);
  const Se3 T_last_new =
      problem.frames[before.frames.size() - 1].T_W_C.inverse() * problem.frames.back().T_W_C;
  const Se3 T_W_C_odometry = problem.frames.back().T_W_C;
  for (std::size_t i = 0; i < before.frames.size(); ++i) problem.frames[i] = before.frames[i];
  problem.frames.back().T_W_C = before.frames.back().T_W_C * T_last_new;
  const Se3 T_start_odometry = problem.frames.back().T_W_C * T_W_C_odometry.inverse();
  problem.landmarks = before.landmarks;
  for (std::size_t i = 0; i < problem.humans.size(); ++i) {
    BundleProblem::Human& human = problem.humans[i];
    human.segment_length_m = before.humans[i].segment_length_m;
    std::vector<BundleProblem::JointState> joints;
    for (std::size_t j = 0; j < human.joints.size(); ++j) {
      BundleProblem::JointState joint = human.joints[j];
      if (joint.frame == 0) continue;  // it has left the people's window
      const std::vector<BundleProblem::JointState>& solved = before.humans[i].joints;
      if (j < solved.size()) {
        joint.p_W = solved[j].p_W;
      } else {  // along its ray, at its depth in the previous frame
        const Se3& T_W_C = problem.frames.back().T_W_C;
        const Eigen::Vector3d p_C = T_W_C.inverse() * (T_start_odometry * joint.p_W);
        const Eigen::Vector3d before_C = T_W_C.inverse() * solved[j - kNumJoints].p_W;
        joint.p_W = T_W_C * Eigen::Vector3d(p_C * before_C.z() / p_C.z());
      }
      joints.push_back(joint);
    }
    human.joints = std::move(joints);
  }
  return problem;
}

}  // namespace airdos
