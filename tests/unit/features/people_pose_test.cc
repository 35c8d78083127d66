#include "common/features/people_pose.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace airdos {
namespace {

Se3 TruePose() {
  Se3 T_W_C;
  T_W_C.translation = {1.5, -0.4, 3.0};
  T_W_C.rotation = ExpSo3({0.2, -0.7, 0.1});
  return T_W_C;
}

Vector6d Off() {
  Vector6d off;
  off << 0.1, -0.05, 0.15, 0.02, -0.03, 0.025;
  return off;
}

PosePrior PriorOff() { return IsotropicPrior(Boxplus(TruePose(), Off()), 0.2, 0.05); }

/// A covariance as a prediction has it: each joint on its own, and all of them together.
Eigen::MatrixXd CovarianceOf(int num_joints, double sigma_own_m, double sigma_shared_m) {
  Eigen::MatrixXd covariance =
      sigma_own_m * sigma_own_m * Eigen::MatrixXd::Identity(3 * num_joints, 3 * num_joints);
  for (int a = 0; a < num_joints; ++a) {
    for (int b = 0; b < num_joints; ++b) {
      covariance.block<3, 3>(3 * a, 3 * b) +=
          sigma_shared_m * sigma_shared_m * Eigen::Matrix3d::Identity();
    }
  }
  return covariance;
}

/// Somebody of six joints around `place_C`, seen from TruePose() where predicted.
HumanConstraint Person(const Eigen::Vector3d& place_C, double sigma_own_m, double sigma_shared_m) {
  HumanConstraint person;
  for (const Eigen::Vector3d& offset :
       {Eigen::Vector3d(0, -0.5, 0), Eigen::Vector3d(0.18, -0.5, 0.02),
        Eigen::Vector3d(-0.18, -0.5, -0.02), Eigen::Vector3d(0.12, 0, 0),
        Eigen::Vector3d(-0.12, 0, 0.1), Eigen::Vector3d(0, -0.72, -0.1)}) {
    person.p_C.push_back(place_C + offset);
    person.p_W.push_back(TruePose() * person.p_C.back());
  }
  person.covariance_W = CovarianceOf(6, sigma_own_m, sigma_shared_m);
  return person;
}

std::vector<HumanConstraint> Three(double sigma_own_m, double sigma_shared_m) {
  return {Person({-1.5, 0, 4}, sigma_own_m, sigma_shared_m),
          Person({0.5, 0.2, 6}, sigma_own_m, sigma_shared_m),
          Person({2, 0, 5}, sigma_own_m, sigma_shared_m)};
}

double Error(const Se3& a, const Se3& b) { return Boxminus(a, b).norm(); }

TEST(PeoplePose, WithoutPeopleThePriorComesBack) {
  const PeoplePose pose = EstimatePoseFromPeople(PriorOff(), {});
  EXPECT_EQ(pose.prior.T_W_C.translation, PriorOff().T_W_C.translation);
  EXPECT_EQ(pose.prior.T_W_C.rotation.coeffs(), PriorOff().T_W_C.rotation.coeffs());
  EXPECT_EQ(pose.prior.covariance, PriorOff().covariance);
  EXPECT_EQ(pose.information, Matrix6d(Matrix6d::Zero()));
}

TEST(PeoplePose, PeopleWhoAreWellKnownTellWhereTheCameraIs) {
  const PeoplePose pose = EstimatePoseFromPeople(PriorOff(), Three(1e-5, 1e-5));
  EXPECT_LT(Error(pose.prior.T_W_C, TruePose()), 1e-5);
  for (int i = 0; i < 6; ++i) EXPECT_LT(pose.prior.covariance(i, i), 1e-8);
}

/// Whitened residuals of the prior and of everybody, at T_W_C.
Eigen::VectorXd Residuals(const PosePrior& prior, const std::vector<HumanConstraint>& people,
                          const Se3& T_W_C) {
  std::vector<double> all;
  const auto add = [&all](const Eigen::MatrixXd& covariance, const Eigen::VectorXd& r) {
    const Eigen::VectorXd whitened = covariance.llt().matrixL().solve(r);
    all.insert(all.end(), whitened.begin(), whitened.end());
  };
  add(prior.covariance, Boxminus(T_W_C, prior.T_W_C));
  for (const HumanConstraint& person : people) {
    Eigen::VectorXd r(static_cast<Eigen::Index>(3 * person.p_C.size()));
    for (std::size_t i = 0; i < person.p_C.size(); ++i)
      r.segment<3>(static_cast<Eigen::Index>(3 * i)) = T_W_C * person.p_C[i] - person.p_W[i];
    add(person.covariance_W, r);
  }
  return Eigen::Map<Eigen::VectorXd>(all.data(), static_cast<Eigen::Index>(all.size()));
}

Eigen::MatrixXd Derivative(const PosePrior& prior, const std::vector<HumanConstraint>& people,
                           const Se3& T_W_C) {
  constexpr double kDelta = 1e-6;
  Eigen::MatrixXd J(Residuals(prior, people, T_W_C).size(), 6);
  for (int i = 0; i < 6; ++i) {
    const Vector6d delta = kDelta * Vector6d::Unit(i);
    J.col(i) = (Residuals(prior, people, Boxplus(T_W_C, delta)) -
                Residuals(prior, people, Boxplus(T_W_C, -delta))) /
               (2 * kDelta);
  }
  return J;
}

/// The pose of the least sum of squares, by derivatives from central differences.
Se3 LeastSquares(const PosePrior& prior, const std::vector<HumanConstraint>& people) {
  Se3 T_W_C = prior.T_W_C;
  for (int iteration = 0; iteration < 30; ++iteration) {
    const Eigen::MatrixXd J = Derivative(prior, people, T_W_C);
    const Eigen::VectorXd r = Residuals(prior, people, T_W_C);
    T_W_C = Boxplus(T_W_C, -(J.transpose() * J).ldlt().solve(J.transpose() * r));
  }
  return T_W_C;
}

/// Where people are about as uncertain as the prior; nobody off by much.
std::vector<HumanConstraint> Noisy(std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal(0, 0.03);
  std::vector<HumanConstraint> people = Three(0.04, 0.08);
  for (HumanConstraint& person : people) {
    const Eigen::Vector3d shared{normal(random), normal(random), normal(random)};
    for (Eigen::Vector3d& p_W : person.p_W)
      p_W += shared + Eigen::Vector3d{normal(random), normal(random), normal(random)};
  }
  return people;
}

TEST(PeoplePose, ItIsTheLeastSquaresOfPriorAndPeople) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const std::vector<HumanConstraint> people = Noisy(seed);
    const PeoplePose pose = EstimatePoseFromPeople(PriorOff(), people);
    const Se3 reference = LeastSquares(PriorOff(), people);
    ASSERT_GT(Error(reference, PriorOff().T_W_C), 0.02);
    // In standard deviations of the result. The prior's derivative is taken as the identity, which
    // is off by as much as the rotation that it is corrected by: some hundredths.
    const Vector6d gap = Boxminus(pose.prior.T_W_C, reference);
    EXPECT_LT(std::sqrt(gap.dot(pose.prior.covariance.inverse() * gap)), 0.05) << "seed " << seed;
  }
}

TEST(PeoplePose, TheInformationIsThatOfThePeopleAlone) {
  const std::vector<HumanConstraint> people = Three(0.04, 0.08);
  const PosePrior prior = IsotropicPrior(TruePose(), 0.2, 0.05);
  const PeoplePose pose = EstimatePoseFromPeople(prior, people);
  const Eigen::MatrixXd J = Derivative(prior, people, TruePose()).bottomRows(3 * 18);
  const Matrix6d expected = J.transpose() * J;
  EXPECT_LT((pose.information - expected).norm(), 1e-6 * expected.norm());
  const Matrix6d covariance = (prior.covariance.inverse() + expected).inverse();
  EXPECT_LT((pose.prior.covariance - covariance).norm(), 1e-6 * covariance.norm());
}

TEST(PeoplePose, OneJointByHand) {
  // A joint straight ahead, 5 m; the prior knows the turn exactly. Prior and joint are both known
  // to 0.1 m, and the camera sees the joint 8 cm further left than predicted: the camera is 4 cm
  // further right.
  HumanConstraint person;
  person.p_C = {{-0.08, 0, 5}};
  person.p_W = {{0, 0, 5}};
  person.covariance_W = 0.01 * Eigen::Matrix3d::Identity();
  const PeoplePose pose = EstimatePoseFromPeople(IsotropicPrior(Se3(), 0.1, 1e-6), {person});
  EXPECT_NEAR(pose.prior.T_W_C.translation.x(), 0.04, 1e-6);
  EXPECT_NEAR(pose.prior.T_W_C.translation.y(), 0, 1e-9);
  EXPECT_NEAR(pose.prior.T_W_C.translation.z(), 0, 1e-6);
  EXPECT_NEAR(pose.prior.covariance(0, 0), 0.005, 1e-6);
  EXPECT_NEAR(pose.information(0, 0), 100, 1e-6);
}

TEST(PeoplePose, SomebodyWhoJumpsSaysLittle) {
  const PosePrior prior = IsotropicPrior(TruePose(), 0.2, 0.05);
  const auto error_m = [&prior](double jump_m) {
    std::vector<HumanConstraint> people = Three(0.03, 0.03);
    for (Eigen::Vector3d& p_W : people[1].p_W) p_W.x() += jump_m;
    const PeoplePose pose = EstimatePoseFromPeople(prior, people);
    return (pose.prior.T_W_C.translation - TruePose().translation).norm();
  };
  // As one of three, 1 m would move the camera by about 0.3 m if it counted fully.
  EXPECT_LT(error_m(1), 0.1);
  // From there on it hardly matters how far.
  EXPECT_LT(error_m(3), 1.2 * error_m(1));
  // A little off is believed.
  EXPECT_GT(error_m(0.03), 0.2 * 0.03);

  std::vector<HumanConstraint> people = Three(0.03, 0.03);
  const double before = EstimatePoseFromPeople(prior, people).information.trace();
  for (Eigen::Vector3d& p_W : people[1].p_W) p_W.x() += 1;
  const double after = EstimatePoseFromPeople(prior, people).information.trace();
  EXPECT_LT(after, 0.8 * before);
}

TEST(PeoplePose, ACovarianceThatIsNoneIsLeftOut) {
  std::vector<HumanConstraint> people = Three(0.03, 0.03);
  const PeoplePose good = EstimatePoseFromPeople(PriorOff(), people);
  people.push_back(Person({0, 0, 3}, 0.03, 0.03));
  people.back().p_W[0].x() += 2;
  people.back().covariance_W(0, 0) = -1;
  const PeoplePose with_bad = EstimatePoseFromPeople(PriorOff(), people);
  EXPECT_EQ(with_bad.prior.T_W_C.translation, good.prior.T_W_C.translation);
  EXPECT_EQ(with_bad.information, good.information);
}

TEST(PeoplePose, NumbersThatAreNoneGiveThePrior) {
  std::vector<HumanConstraint> people = Three(0.03, 0.03);
  people[0].p_W[2].y() = std::numeric_limits<double>::quiet_NaN();
  const PeoplePose pose = EstimatePoseFromPeople(PriorOff(), people);
  EXPECT_EQ(Error(pose.prior.T_W_C, PriorOff().T_W_C), 0);
  EXPECT_EQ(pose.prior.covariance, PriorOff().covariance);
  EXPECT_EQ(pose.information, Matrix6d(Matrix6d::Zero()));
}

}  // namespace
}  // namespace airdos
