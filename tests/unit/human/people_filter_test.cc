#include "common/human/people_filter.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <array>
#include <cmath>
#include <random>
#include <vector>

namespace airdos {
namespace {

constexpr double kStep_s = 0.1;
const Matrix6d kExactPose = Matrix6d::Zero();
using Body = std::array<Eigen::Vector3d, kNumBodyJoints>;

/// The body joints in W of a person at `place`.
Body Standing(const Eigen::Vector3d& place) {
  return {place + Eigen::Vector3d(0, -0.5, 0),     place + Eigen::Vector3d(0.18, -0.5, 0),
          place + Eigen::Vector3d(-0.18, -0.5, 0), place + Eigen::Vector3d(0.12, 0, 0.02),
          place + Eigen::Vector3d(-0.12, 0, 0.02), place + Eigen::Vector3d(0, -0.72, -0.05)};
}

Se3 CameraPose() {
  Se3 T_W_C;
  T_W_C.translation = {0.4, -0.2, -1};
  T_W_C.rotation = ExpSo3({0.1, -0.3, 0.05});
  return T_W_C;
}

HumanMeasurement Measure(const Body& body_W, const Se3& T_W_C, double sigma_m, int id = 1) {
  HumanMeasurement person;
  person.id = HumanId{id};
  for (std::size_t i = 0; i < body_W.size(); ++i) {
    person.joints.push_back({kBodyJoints[i], T_W_C.inverse() * body_W[i],
                             sigma_m * sigma_m * Eigen::Matrix3d::Identity()});
  }
  return person;
}

PeopleFilterOptions WithoutWobble() {
  PeopleFilterOptions options;
  options.wobble_m = 1e-6;
  return options;
}

/// A person of constant velocity in front of a camera that moves as well.
struct Walk {
  Eigen::Vector3d start_W{0.5, 0.2, 5};
  Eigen::Vector3d v_W{0.9, 0, -0.7};
  double sigma_m = 0.03;

  Eigen::Vector3d Place(int k) const { return start_W + kStep_s * k * v_W; }
  Body At(int k) const { return Standing(Place(k)); }
  Se3 Camera(int k) const {
    Vector6d step;
    step << 0.05 * k, 0, 0.1 * k, 0, 0.03 * k, 0;
    return Boxplus(CameraPose(), step);
  }
  HumanMeasurement See(int k) const { return Measure(At(k), Camera(k), sigma_m); }
  /// Frames 0 .. count - 1, each predicted and taken in.
  void Run(int count, PeopleFilter* filter) const {
    for (int k = 0; k < count; ++k) {
      filter->Predict(kStep_s);
      filter->Update({See(k)}, Camera(k), kExactPose);
    }
  }
};

TEST(PeopleFilter, AConstantVelocityIsPredicted) {
  Walk walk;
  walk.sigma_m = 1e-5;
  PeopleFilter filter(WithoutWobble());
  walk.Run(3, &filter);
  filter.Predict(4 * kStep_s);
  const auto constraints = filter.Constrain({walk.See(6)}, walk.Camera(6), kExactPose);
  ASSERT_EQ(constraints.size(), 1u);
  EXPECT_EQ(constraints[0].id, HumanId{1});
  ASSERT_EQ(constraints[0].p_W.size(), kBodyJoints.size());
  ASSERT_EQ(constraints[0].p_C.size(), kBodyJoints.size());
  ASSERT_EQ(constraints[0].covariance_W.rows(), 3 * kNumBodyJoints);
  for (std::size_t i = 0; i < kBodyJoints.size(); ++i) {
    EXPECT_LT((constraints[0].p_W[i] - walk.At(6)[i]).norm(), 1e-5) << "joint " << i;
    EXPECT_LT((walk.Camera(6) * constraints[0].p_C[i] - constraints[0].p_W[i]).norm(), 1e-5);
  }
}

TEST(PeopleFilter, LimbsSwingAndAreNotUsed) {
  Walk walk;
  PeopleFilter filter{PeopleFilterOptions()};
  HumanMeasurement person = walk.See(0);
  person.joints.push_back({kRightWrist, {0, 0, 4}, 1e-4 * Eigen::Matrix3d::Identity()});
  person.joints.push_back({99, {0, 0, 4}, 1e-4 * Eigen::Matrix3d::Identity()});
  for (int k = 0; k < 2; ++k) filter.Update({person}, walk.Camera(0), kExactPose);
  const auto constraints = filter.Constrain({person}, walk.Camera(0), kExactPose);
  ASSERT_EQ(constraints.size(), 1u);
  EXPECT_EQ(constraints[0].p_W.size(), kBodyJoints.size());
}

/// Of what is said of the frame after `count` of them.
Eigen::MatrixXd CovarianceAfter(int count, const Walk& walk, const PeopleFilterOptions& options) {
  PeopleFilter filter(options);
  walk.Run(count, &filter);
  filter.Predict(kStep_s);
  const auto constraints = filter.Constrain({walk.See(count)}, walk.Camera(count), kExactPose);
  EXPECT_EQ(constraints.size(), 1u);
  return constraints.at(0).covariance_W;
}

TEST(PeopleFilter, WhoIsSeenLongerIsKnownBetter) {
  const Walk walk;
  const PeopleFilterOptions options;
  const double once_m2 = CovarianceAfter(1, walk, options)(0, 0);
  const double twice_m2 = CovarianceAfter(2, walk, options)(0, 0);
  const double long_m2 = CovarianceAfter(10, walk, options)(0, 0);
  // By hand after one frame: the measurement twice, the wobble, the velocity not yet known.
  const double change_m_s = options.acceleration_m_s2 * kStep_s;
  const double speed_m2_s2 = options.initial_speed_m_s * options.initial_speed_m_s;
  EXPECT_NEAR(once_m2,
              2 * walk.sigma_m * walk.sigma_m + options.wobble_m * options.wobble_m +
                  kStep_s * kStep_s * (speed_m2_s2 + change_m_s * change_m_s),
              1e-9);
  EXPECT_LT(twice_m2, 0.7 * once_m2);
  EXPECT_LT(long_m2, twice_m2);
  EXPECT_GT(long_m2, walk.sigma_m * walk.sigma_m + options.wobble_m * options.wobble_m);
}

TEST(PeopleFilter, JointsShareTheirVelocity) {
  // What is not known of the velocity moves all joints alike: joints correlate, axes do not.
  const Walk walk;
  const PeopleFilterOptions options;
  const Eigen::MatrixXd covariance = CovarianceAfter(1, walk, options);
  const double change_m_s = options.acceleration_m_s2 * kStep_s;
  const double shared_m2 =
      kStep_s * kStep_s *
      (options.initial_speed_m_s * options.initial_speed_m_s + change_m_s * change_m_s);
  EXPECT_NEAR(covariance(0, 3), shared_m2, 1e-9);
  EXPECT_NEAR(covariance(4, 16), shared_m2, 1e-9);
  EXPECT_NEAR(covariance(0, 4), 0, 1e-12);
}

TEST(PeopleFilter, SomebodyElsewhereStartsAnew) {
  PeopleFilterOptions options;
  options.min_seen_frames = 3;
  Walk walk;
  PeopleFilter filter(options);
  walk.Run(6, &filter);
  filter.Predict(kStep_s);
  ASSERT_EQ(filter.Constrain({walk.See(6)}, walk.Camera(6), kExactPose).size(), 1u);
  Walk elsewhere = walk;
  elsewhere.start_W.x() -= 5;
  EXPECT_TRUE(filter.Constrain({elsewhere.See(6)}, walk.Camera(6), kExactPose).empty());
  filter.Update({elsewhere.See(6)}, walk.Camera(6), kExactPose);
  // From here on the frames count again, and so does what is said.
  for (int k = 7; k < 12; ++k) {
    filter.Predict(kStep_s);
    const auto constraints = filter.Constrain({elsewhere.See(k)}, walk.Camera(k), kExactPose);
    EXPECT_EQ(constraints.size(), k < 9 ? 0u : 1u) << "frame " << k;
    filter.Update({elsewhere.See(k)}, walk.Camera(k), kExactPose);
  }
  EXPECT_EQ(filter.num_people(), 1u);
}

TEST(PeopleFilter, AJointThatIsElsewhereIsLeftOut) {
  const Walk walk;
  PeopleFilter filter{PeopleFilterOptions()};
  PeopleFilter without{PeopleFilterOptions()};
  walk.Run(5, &filter);
  walk.Run(5, &without);
  HumanMeasurement wrong = walk.See(5);
  wrong.joints[2].p_C.z() += 1.5;
  HumanMeasurement missing = walk.See(5);
  missing.joints.erase(missing.joints.begin() + 2);
  filter.Predict(kStep_s);
  without.Predict(kStep_s);
  const auto constraints = filter.Constrain({wrong}, walk.Camera(5), kExactPose);
  ASSERT_EQ(constraints.size(), 1u);
  ASSERT_EQ(constraints[0].p_C.size(), 5u);
  for (const Eigen::Vector3d& p_C : constraints[0].p_C) EXPECT_NE(p_C, wrong.joints[2].p_C);
  // A camera that may be anywhere explains it.
  EXPECT_EQ(filter.Constrain({wrong}, walk.Camera(5), Matrix6d::Identity())[0].p_C.size(), 6u);
  // It has no effect on what follows either, and comes back.
  filter.Update({wrong}, walk.Camera(5), kExactPose);
  without.Update({missing}, walk.Camera(5), kExactPose);
  filter.Predict(kStep_s);
  without.Predict(kStep_s);
  const auto a = filter.Constrain({walk.See(6)}, walk.Camera(6), kExactPose);
  const auto b = without.Constrain({walk.See(6)}, walk.Camera(6), kExactPose);
  ASSERT_EQ(a[0].p_W.size(), 6u);
  EXPECT_EQ(a[0].p_W, b[0].p_W);
  EXPECT_EQ(a[0].covariance_W, b[0].covariance_W);
}

TEST(PeopleFilter, WhoIsNotSeenIsForgotten) {
  PeopleFilterOptions options;
  options.max_missed_frames = 3;
  const Walk walk;
  PeopleFilter filter(options);
  walk.Run(5, &filter);
  for (int k = 5; k < 8; ++k) {
    filter.Predict(kStep_s);
    filter.Update({}, walk.Camera(k), kExactPose);
    EXPECT_EQ(filter.num_people(), 1u);
  }
  filter.Predict(kStep_s);
  // Three frames later it is still where it was going.
  EXPECT_EQ(filter.Constrain({walk.See(8)}, walk.Camera(8), kExactPose).size(), 1u);
  filter.Update({}, walk.Camera(8), kExactPose);
  EXPECT_EQ(filter.num_people(), 0u);
  EXPECT_TRUE(filter.Constrain({walk.See(8)}, walk.Camera(8), kExactPose).empty());
}

TEST(PeopleFilter, NobodyHasASayBeforeItIsKnown) {
  const Walk walk;
  PeopleFilterOptions options;
  options.min_seen_frames = 2;
  PeopleFilter filter(options);
  for (int k = 0; k < 4; ++k) {
    filter.Predict(kStep_s);
    EXPECT_EQ(filter.Constrain({walk.See(k)}, walk.Camera(k), kExactPose).size(), k < 2 ? 0u : 1u);
    filter.Update({walk.See(k)}, walk.Camera(k), kExactPose);
  }
  EXPECT_TRUE(filter.Constrain({}, walk.Camera(4), kExactPose).empty());
  HumanMeasurement stranger = walk.See(4);
  stranger.id = HumanId{77};
  EXPECT_TRUE(filter.Constrain({stranger}, walk.Camera(4), kExactPose).empty());
}

TEST(PeopleFilter, ACorrectionOfTheWorldMovesEverything) {
  const Walk walk;
  Vector6d delta;
  delta << 1.2, -0.5, 3, 0.3, -0.8, 0.2;
  const Se3 T_new_old = Boxplus(Se3(), delta);
  const Matrix6d pose_covariance = 1e-4 * Matrix6d::Identity();
  PeopleFilter old_world{PeopleFilterOptions()};
  PeopleFilter new_world{PeopleFilterOptions()};
  Se3 T_now_old;  // of new_world, before the correction after frame 3
  for (int k = 0; k < 8; ++k) {
    old_world.Predict(kStep_s);
    new_world.Predict(kStep_s);
    // Noise, so that there is something to correct.
    HumanMeasurement person = walk.See(k);
    for (std::size_t i = 0; i < person.joints.size(); ++i)
      person.joints[i].p_C.x() += 0.02 * std::sin(static_cast<double>(3 * i) + k);
    const auto a = old_world.Constrain({person}, walk.Camera(k), pose_covariance);
    const auto b = new_world.Constrain({person}, T_now_old * walk.Camera(k), pose_covariance);
    ASSERT_EQ(a.size(), k > 0 ? 1u : 0u);
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t i = 0; k > 0 && i < a[0].p_W.size(); ++i) {
      EXPECT_LT((T_now_old * a[0].p_W[i] - b[0].p_W[i]).norm(), 1e-9);
      const Eigen::Matrix3d R = T_now_old.rotation.toRotationMatrix();
      const auto row = static_cast<Eigen::Index>(3 * i);
      EXPECT_LT((R * a[0].covariance_W.block<3, 3>(row, 0) * R.transpose() -
                 b[0].covariance_W.block<3, 3>(row, 0))
                    .norm(),
                1e-9);
    }
    old_world.Update({person}, walk.Camera(k), pose_covariance);
    new_world.Update({person}, T_now_old * walk.Camera(k), pose_covariance);
    if (k == 3) {
      new_world.Transform(T_new_old);
      T_now_old = T_new_old;
    }
  }
}

/// The learnt acceleration, from how uncertain the prediction is after a time in which it outweighs
/// all else.
double LearntAcceleration_m_s2(PeopleFilter filter, const Body& around_W) {
  constexpr double kLong_s = 100;
  filter.Predict(kLong_s);
  const auto constraints =
      filter.Constrain({Measure(around_W, CameraPose(), 1)}, CameraPose(), kExactPose);
  EXPECT_EQ(constraints.size(), 1u);
  if (constraints.empty()) return 0;
  return std::sqrt(constraints[0].covariance_W(0, 0)) / (kLong_s * kLong_s);
}

/// Walks to and fro with that acceleration.
double LearntFrom(double acceleration_m_s2, const PeopleFilterOptions& options) {
  PeopleFilter filter(options);
  Eigen::Vector3d place(0, 0, 5);
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();
  for (int k = 0; k < 80; ++k) {
    velocity.x() = k % 2 == 0 ? acceleration_m_s2 * kStep_s : 0;
    velocity.z() = k % 4 < 2 ? acceleration_m_s2 * kStep_s : 0;
    velocity.y() = k % 4 < 2 ? 0 : acceleration_m_s2 * kStep_s;
    place += kStep_s * velocity;
    filter.Predict(kStep_s);
    filter.Update({Measure(Standing(place), CameraPose(), 0.01)}, CameraPose(), kExactPose);
  }
  return LearntAcceleration_m_s2(filter, Standing(place));
}

TEST(PeopleFilter, HowMuchAPersonAcceleratesIsLearntWithinBounds) {
  PeopleFilterOptions options;
  options.wobble_m = 0.01;
  options.max_joint_sigmas = 1000;  // nobody is lost, however wild
  const double least = options.min_acceleration_factor * options.acceleration_m_s2;
  const double most = options.max_acceleration_factor * options.acceleration_m_s2;
  // 2 % for what else is uncertain after so long.
  EXPECT_NEAR(LearntFrom(0, options), least, 0.02 * least);
  const double lively = LearntFrom(8, options);
  EXPECT_GT(lively, 1.2 * options.acceleration_m_s2);
  EXPECT_LT(lively, most);
  EXPECT_NEAR(LearntFrom(5 * most, options), most, 0.02 * most);
}

/// A person who does what the filter expects, with noise on everything.
class RandomPerson {
 public:
  RandomPerson(const PeopleFilterOptions& options, std::uint64_t seed)
      : options_(options), random_(seed), body_W_(Standing({0.3, 0.1, 5})) {
    v_W_ = options.initial_speed_m_s * Normal3();
  }
  void Step(double step_s) {
    v_W_ += step_s * options_.acceleration_m_s2 * Normal3();
    const double wobble_m = options_.wobble_m * std::sqrt(step_s / 0.1);
    for (Eigen::Vector3d& joint : body_W_) joint += step_s * v_W_ + wobble_m * Normal3();
  }
  /// With the covariance of stereo: far less certain in depth.
  HumanMeasurement See(const Se3& T_W_C) {
    const Eigen::Vector3d sigma_m(0.01, 0.015, 0.08);
    HumanMeasurement person = Measure(body_W_, T_W_C, 1);
    for (HumanMeasurement::Joint& joint : person.joints) {
      joint.p_C += sigma_m.cwiseProduct(Normal3());
      joint.covariance_C = sigma_m.cwiseAbs2().asDiagonal();
    }
    return person;
  }

 private:
  Eigen::Vector3d Normal3() { return {normal_(random_), normal_(random_), normal_(random_)}; }

  PeopleFilterOptions options_;
  std::mt19937_64 random_;
  std::normal_distribution<double> normal_;
  Body body_W_;
  Eigen::Vector3d v_W_ = Eigen::Vector3d::Zero();
};

/// Mean over frames and dimensions of the squared residual against its covariance.
double MeanNis(const PeopleFilterOptions& options) {
  double sum = 0;
  int num = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    RandomPerson person(options, seed);
    PeopleFilter filter(options);
    for (int k = 0; k < 60; ++k) {
      const double step_s = k % 5 == 0 ? 0.2 : 0.1;
      person.Step(step_s);
      filter.Predict(step_s);
      const HumanMeasurement seen = person.See(CameraPose());
      for (const HumanConstraint& constraint : filter.Constrain({seen}, CameraPose(), kExactPose)) {
        const auto n = static_cast<Eigen::Index>(constraint.p_W.size());
        Eigen::VectorXd r(3 * n);
        for (Eigen::Index i = 0; i < n; ++i) {
          const auto index = static_cast<std::size_t>(i);
          r.segment<3>(3 * i) = CameraPose() * constraint.p_C[index] - constraint.p_W[index];
        }
        const Eigen::LLT<Eigen::MatrixXd> llt(constraint.covariance_W);
        EXPECT_EQ(llt.info(), Eigen::Success) << "seed " << seed << ", frame " << k;
        // Up to rounding.
        EXPECT_LT((constraint.covariance_W - constraint.covariance_W.transpose()).norm(),
                  1e-14 * constraint.covariance_W.norm());
        sum += r.dot(llt.solve(r));
        num += static_cast<int>(3 * n);
      }
      filter.Update({seen}, CameraPose(), kExactPose);
    }
  }
  EXPECT_GT(num, 20 * 50 * 18);
  return sum / num;
}

TEST(PeopleFilter, ItIsAsCertainAsItIsRight) {
  PeopleFilterOptions options;
  options.min_acceleration_factor = 1;
  options.max_acceleration_factor = 1;
  // 20000 dimensions: four standard deviations of their mean are 4 sqrt(2 / 20000) = 0.04.
  EXPECT_NEAR(MeanNis(options), 1, 0.04);
}

TEST(PeopleFilter, LearningLeavesItAboutAsCertainAsItIsRight) {
  // The learnt acceleration goes up and down around the true one.
  EXPECT_NEAR(MeanNis(PeopleFilterOptions()), 1, 0.1);
}

TEST(PeopleFilter, AnUncertainCameraLeavesThePersonUncertain) {
  const Walk walk;
  const auto variance_m2 = [&walk](double sigma_m) {
    Matrix6d pose_covariance = Matrix6d::Zero();
    pose_covariance.diagonal().head<3>().setConstant(sigma_m * sigma_m);
    PeopleFilter filter{PeopleFilterOptions()};
    filter.Update({walk.See(0)}, walk.Camera(0), pose_covariance);
    return filter.Constrain({walk.See(0)}, walk.Camera(0), kExactPose).at(0).covariance_W(0, 0);
  };
  EXPECT_NEAR(variance_m2(0.2) - variance_m2(0), 0.04, 1e-9);
}

}  // namespace
}  // namespace airdos
