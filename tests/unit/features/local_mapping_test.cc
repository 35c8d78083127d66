#include "common/features/local_mapping.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "tests/support/walked_frame.h"

namespace airdos {
namespace {

const StereoCamera kCamera = SmallStereoCamera();
const Se3 kPose{ExpSo3({0.1, -0.7, 0.3}), {1, 2, -3}};

struct Created {
  std::vector<LandmarkSighting> sightings;
  LocalMap map{LocalMapOptions()};
};

Created Create(const StereoFrame& frame, const VisualOdometryOptions& options = {},
               const Matrix6d& pose_covariance = Matrix6d::Zero(),
               const TrustField& field = TrustField(0.7),
               std::vector<LandmarkSighting> before = {}) {
  Created created;
  created.sightings = std::move(before);
  CreateLandmarks(options, frame, kPose, pose_covariance, field, &created.sightings, &created.map);
  return created;
}

std::pair<int, int> CellOf(const Eigen::Vector3d& uvu_px, int size_px) {
  return {static_cast<int>(uvu_px.x()) / size_px, static_cast<int>(uvu_px.y()) / size_px};
}

TEST(CreateLandmarks, EachLiesWhereTheStereoPairSeesIt) {
  const WalkedFrame frame(5);
  const Created created = Create(*frame);
  ASSERT_GT(created.sightings.size(), 60u);
  EXPECT_EQ(created.map.landmarks().size(), created.sightings.size());
  std::vector<double> errors_px;
  for (const LandmarkSighting& sighting : created.sightings) {
    const LocalLandmark& landmark = created.map.landmarks().at(sighting.id);
    const auto p_C =
        kCamera.Triangulate(sighting.uvu_px.x(), sighting.uvu_px.y(), sighting.uvu_px.z());
    ASSERT_TRUE(p_C);
    EXPECT_TRUE(sighting.has_right);
    EXPECT_LT((landmark.p_C_reference - *p_C).norm(), 1e-12);
    EXPECT_LT((landmark.p_W - kPose * *p_C).norm(), 1e-12);
    EXPECT_FALSE(landmark.is_refined);
    const double depth_m =
        WalkedFrame::Scene().Depth_m(kCamera, SwayingPath(5), sighting.uvu_px.head<2>());
    errors_px.push_back(kCamera.fx_px * kCamera.baseline_m * std::abs(1 / depth_m - 1 / p_C->z()));
  }
  std::sort(errors_px.begin(), errors_px.end());
  EXPECT_LT(errors_px[errors_px.size() / 2], 0.2) << "of disparity";
}

TEST(CreateLandmarks, EachIsKnownByHowItLooksInThisFrame) {
  const WalkedFrame frame(5);
  VisualOdometryOptions options;
  options.aligned_sigma_px = 0.3;
  const Created created = Create(*frame, options);
  for (const LandmarkSighting& sighting : created.sightings) {
    const LocalLandmark& landmark = created.map.landmarks().at(sighting.id);
    EXPECT_EQ(landmark.reference_frame, frame->id());
    EXPECT_EQ(landmark.reference_image, frame->left());
    EXPECT_EQ(landmark.reference_uv_px, sighting.uvu_px.head<2>());
    const auto feature = std::find_if(
        frame->left_features().begin(), frame->left_features().end(), [&](const Feature& f) {
          return f.uv_px == landmark.reference_uv_px && f.level == landmark.reference_level;
        });
    ASSERT_NE(feature, frame->left_features().end());
    EXPECT_EQ(landmark.descriptor, feature->descriptor);
    EXPECT_DOUBLE_EQ(sighting.sigma_px, 0.3 * std::pow(ImagePyramid::kScaleFactor, feature->level));
    EXPECT_EQ(landmark.last_seen, frame->id());
    EXPECT_EQ(landmark.num_seen, 1);
    EXPECT_EQ(landmark.num_expected, 1);
  }
}

TEST(CreateLandmarks, TwoOfACellAndNoneWhereLandmarksAreSeenAlready) {
  const WalkedFrame frame(5);
  const int cell_px = VisualOdometryOptions().observation_cell_px;
  std::map<std::pair<int, int>, int> num_of_cell;
  for (const LandmarkSighting& sighting : Create(*frame).sightings) {
    ++num_of_cell[CellOf(sighting.uvu_px, cell_px)];
  }
  const auto [fullest, num] =
      *std::max_element(num_of_cell.begin(), num_of_cell.end(),
                        [](const auto& a, const auto& b) { return a.second < b.second; });
  EXPECT_EQ(num, kMaxObservationsPerCell);
  LandmarkSighting before;
  before.uvu_px = {(fullest.first + 0.5) * cell_px, (fullest.second + 0.5) * cell_px, 0};
  const std::vector<LandmarkSighting> full(2, before);
  const Created beside = Create(*frame, {}, Matrix6d::Zero(), TrustField(0.7), full);
  for (std::size_t i = 2; i < beside.sightings.size(); ++i) {
    EXPECT_NE(CellOf(beside.sightings[i].uvu_px, cell_px), fullest);
  }
  EXPECT_EQ(beside.map.landmarks().size(), beside.sightings.size() - 2)
      << "the two stay as they are";
}

TEST(CreateLandmarks, TheStrongestCornersUpToTheLimit) {
  const WalkedFrame frame(5);
  VisualOdometryOptions options;
  options.max_observations = 12;
  const Created few = Create(*frame, options);
  ASSERT_EQ(few.sightings.size(), 12u);
  const auto response_of = [&](const LandmarkSighting& sighting) {
    for (const Feature& feature : frame->left_features())
      if (feature.uv_px == sighting.uvu_px.head<2>()) return feature.response;
    return -1.0F;
  };
  for (std::size_t i = 1; i < few.sightings.size(); ++i) {
    EXPECT_GE(response_of(few.sightings[i - 1]), response_of(few.sightings[i]));
  }
  const Created all = Create(*frame);
  EXPECT_EQ(all.sightings[11].uvu_px, few.sightings[11].uvu_px) << "the same come first";
  EXPECT_TRUE(
      Create(*frame, options, Matrix6d::Zero(), TrustField(0.7), std::vector<LandmarkSighting>(12))
          .map.landmarks()
          .empty());
}

TEST(CreateLandmarks, BesideWhatMovedTheyAreDoubted) {
  const WalkedFrame frame(5);
  const LandmarkSighting first = Create(*frame).sightings.front();
  const auto p_C = kCamera.Triangulate(first.uvu_px.x(), first.uvu_px.y(), first.uvu_px.z());
  ASSERT_TRUE(p_C);
  TrustField field(0.7);
  for (int i = 0; i < 5; ++i) field.Add(first.uvu_px.head<2>(), p_C->z(), false);
  const Created doubted = Create(*frame, {}, Matrix6d::Zero(), field);
  EXPECT_NEAR(doubted.map.landmarks().begin()->second.trust.static_probability(),
              field.At(first.uvu_px.head<2>(), p_C->z()), 1e-12);
  EXPECT_LT(field.At(first.uvu_px.head<2>(), p_C->z()), 0.3);
}

TEST(CreateLandmarks, EachIsAsUncertainAsItsMeasurementAndTheFramesPose) {
  const WalkedFrame frame(5);
  VisualOdometryOptions options;
  options.aligned_sigma_px = 0.3;
  Matrix6d P = Matrix6d::Identity() * 1e-4;
  P(0, 4) = P(4, 0) = 3e-5;
  const Created created = Create(*frame, options, P);
  ASSERT_FALSE(created.map.landmarks().empty());
  for (const auto& [id, landmark] : created.map.landmarks()) {
    const double sigma_px = 0.3 * std::pow(ImagePyramid::kScaleFactor, landmark.reference_level);
    EXPECT_TRUE(landmark.created_covariance_W.isApprox(
        CreatedCovariance(kCamera, kPose, P, landmark.p_C_reference, sigma_px), 1e-12));
  }
}

// The point moves as the pose does, by differences.
TEST(CreatedCovariance, IsThatOfTheStereoMeasurementAndThatOfThePoseCarriedOver) {
  const Eigen::Vector3d p_C(0.7, -0.4, 6);
  const Eigen::Matrix3d R = kPose.rotation.toRotationMatrix();
  const Eigen::Matrix3d measured = R * kCamera.TriangulationCovariance(p_C, 0.25) * R.transpose();
  EXPECT_TRUE(CreatedCovariance(kCamera, kPose, Matrix6d::Zero(), p_C, 0.25).isApprox(measured));
  Matrix6d A;
  for (int i = 0; i < 36; ++i) A(i / 6, i % 6) = 0.01 * std::sin(1.7 * i + 0.3);
  const Matrix6d P = A * A.transpose();
  Eigen::Matrix<double, 3, 6> J;
  constexpr double kStep = 1e-6;
  for (int i = 0; i < 6; ++i) {
    const Vector6d delta = kStep * Vector6d::Unit(i);
    J.col(i) = (Boxplus(kPose, delta) * p_C - Boxplus(kPose, -delta) * p_C) / (2 * kStep);
  }
  const Eigen::Matrix3d expected = measured + J * P * J.transpose();
  EXPECT_TRUE(CreatedCovariance(kCamera, kPose, P, p_C, 0.25).isApprox(expected, 1e-6));
}

// ---- what happens to landmarks that are seen again

class UpdateLandmarksTest : public testing::Test {
 protected:
  /// A landmark made 10 m in front of the camera of frame 0, at a level.
  LandmarkId Add(int level) {
    LocalLandmark landmark;
    landmark.p_W = landmark.p_C_reference = {0.5, 0.2, 10};
    landmark.reference_level = level;
    landmark.num_seen = 4;
    return map_.Add(landmark);
  }
  /// Sees it from where it is so many times as far away.
  const LocalLandmark& Update(LandmarkId id, double depth_ratio) {
    LandmarkSighting sighting;
    sighting.id = id;
    sighting.uvu_px = {31, 17, 12};
    UpdateLandmarks(*frame_, {Eigen::Quaterniond::Identity(), {0, 0, 10 - 10 * depth_ratio}},
                    {sighting}, &map_);
    return map_.landmarks().at(id);
  }

  const WalkedFrame frame_{7};
  LocalMap map_{LocalMapOptions()};
};

TEST_F(UpdateLandmarksTest, TheSightingCounts) {
  const LandmarkId seen = Add(2), other = Add(2);
  const LocalLandmark& landmark = Update(seen, 1.05);
  EXPECT_EQ(landmark.num_seen, 5);
  EXPECT_EQ(landmark.last_seen.value, 7);
  EXPECT_EQ(map_.landmarks().at(other).num_seen, 4);
  EXPECT_EQ(map_.landmarks().at(other).last_seen.value, 0);
}

TEST_F(UpdateLandmarksTest, WhatLooksTheSameKeepsItsReference) {
  for (const double depth_ratio : {0.86, 1.17}) {
    const LocalLandmark& landmark = Update(Add(2), depth_ratio);
    EXPECT_EQ(landmark.reference_frame.value, 0);
    EXPECT_EQ(landmark.reference_image, nullptr);
    EXPECT_EQ(landmark.reference_level, 2);
    EXPECT_EQ(landmark.p_C_reference.z(), 10);
  }
}

TEST_F(UpdateLandmarksTest, WhatIsNearerOrFartherIsKnownByThisFrame) {
  for (const auto& [depth_ratio, level] :
       {std::pair{0.84, 3}, std::pair{0.6, 5}, std::pair{1.19, 1}, std::pair{3.0, 0}}) {
    const LocalLandmark& landmark = Update(Add(2), depth_ratio);
    EXPECT_EQ(landmark.reference_frame.value, 7);
    EXPECT_EQ(landmark.reference_image, frame_->left());
    EXPECT_EQ(landmark.reference_uv_px, Eigen::Vector2d(31, 17));
    EXPECT_LT((landmark.p_C_reference - Eigen::Vector3d(0.5, 0.2, 10 * depth_ratio)).norm(), 1e-9);
    EXPECT_EQ(landmark.reference_level, level) << depth_ratio;
    EXPECT_EQ(landmark.p_W, Eigen::Vector3d(0.5, 0.2, 10)) << "it stays where it is";
  }
  EXPECT_EQ(Update(Add(7), 0.4).reference_level, frame_->left()->num_levels() - 1);
}

}  // namespace
}  // namespace airdos
