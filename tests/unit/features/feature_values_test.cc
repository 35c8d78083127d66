#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <set>
#include <vector>

#include "common/features/camera_motion_filter.h"
#include "common/features/feature_extractor.h"
#include "common/features/feature_stereo_matcher.h"
#include "common/features/landmark_judge.h"
#include "common/features/people_pose.h"
#include "tests/support/rendered_scene.h"

// Limits of the front end's parts: just below and just above.

namespace airdos {
namespace {

// ---- pairs of features at each level

constexpr double kDisparity_px = 7.3;

/// fx * baseline = 60 px m, and 48 with fy.
StereoCamera Camera() { return {320, 192, 240, 192, 160, 96, 0.25}; }

struct Rig {
  explicit Rig(std::vector<Feature> right_features, FeatureStereoMatcherOptions options = {},
               double other = 0)
      : left(NoisePicture(320, 192, 9), 8),
        right(Mixed(other), 8),
        features(std::move(right_features)),
        matcher(options, Camera(), left, right, features) {}

  /// The right picture, of which a share is another one.
  static cv::Mat Mixed(double other) {
    cv::Mat image;
    cv::addWeighted(NoisePicture(320, 192, 9, kDisparity_px), 1 - other, NoisePicture(320, 192, 77),
                    other, 0, image);
    return image;
  }

  ImagePyramid left, right;
  std::vector<Feature> features;
  FeatureStereoMatcher matcher;
};

/// A feature whose descriptor has so many bits set.
Feature At(double u_px, double v_px, int level, int num_bits = 0) {
  Feature feature;
  feature.uv_px = {u_px, v_px};
  feature.level = level;
  for (int bit = 0; bit < num_bits; ++bit) {
    feature.descriptor[static_cast<std::size_t>(bit / 64)] |= std::uint64_t{1} << (bit % 64);
  }
  return feature;
}

const Feature kLeft = At(160, 96, 0);

Feature Partner(double row_error_px = 0, int level = 0, int num_bits = 0) {
  return At(160 - kDisparity_px, 96 + row_error_px, level, num_bits);
}

bool Matches(const Feature& left, const Feature& right,
             const FeatureStereoMatcherOptions& options = {}) {
  const auto u_right_px = Rig({right}, options).matcher.Match(left);
  if (u_right_px) {
    EXPECT_NEAR(*u_right_px, 160 - kDisparity_px, 0.3);
  }
  return u_right_px.has_value();
}

TEST(StereoLevels, TheRowErrorGrowsWithTheLevel) {
  EXPECT_TRUE(Matches(kLeft, Partner(1)));
  EXPECT_FALSE(Matches(kLeft, Partner(3)));
  Feature high = kLeft;
  high.level = 5;  // 1.2^5 times 1.5 px
  EXPECT_TRUE(Matches(high, Partner(3, 5)));
  EXPECT_TRUE(Matches(high, Partner(-3, 5)));
  EXPECT_FALSE(Matches(high, Partner(5, 5)));
}

TEST(StereoLevels, PartnersAreALevelApartAtMost) {
  EXPECT_TRUE(Matches(kLeft, Partner(0, 1)));
  EXPECT_FALSE(Matches(kLeft, Partner(0, 2)));
}

TEST(StereoLevels, PartnersDifferBySoManyBitsAtMost) {
  FeatureStereoMatcherOptions options;
  options.max_hamming_bits = 75;
  EXPECT_TRUE(Matches(kLeft, Partner(0, 0, 75), options));
  EXPECT_FALSE(Matches(kLeft, Partner(0, 0, 76), options));
}

TEST(StereoLevels, WhoIsTooNearIsNoPartnerHoweverAlike) {
  FeatureStereoMatcherOptions options;
  options.min_depth_m = 2;  // 30 px
  const Feature near = At(160 - 30.1, 96, 0), there = Partner(0, 0, 10);
  const auto u_right_px = Rig({near, there}, options).matcher.Match(kLeft);
  ASSERT_TRUE(u_right_px);
  EXPECT_NEAR(*u_right_px, 160 - kDisparity_px, 0.3);
  // And the limit is that of the columns: 60 px m.
  options.min_depth_m = 60 / (kDisparity_px + 0.2);
  EXPECT_TRUE(Matches(kLeft, Partner(), options));
  options.min_depth_m = 60 / (kDisparity_px - 0.2);
  EXPECT_FALSE(Matches(kLeft, Partner(), options));
}

TEST(StereoLevels, APatchMustLookAlike) {
  FeatureStereoMatcherOptions options;
  EXPECT_FALSE(Rig({Partner()}, options, 0.45).matcher.Match(kLeft));
  options.min_correlation = 0.3;
  EXPECT_TRUE(Rig({Partner()}, options, 0.45).matcher.Match(kLeft));
}

// ---- descriptors

TEST(FeatureOrientation, ATurnedPictureHasTheSameDescriptors) {
  const cv::Mat image = NoisePicture(256, 256, 5);
  cv::Mat turned;
  cv::rotate(image, turned, cv::ROTATE_90_CLOCKWISE);
  FeatureExtractorOptions options;
  options.num_levels = 1;
  int num_masked = 0;
  const auto extract = [&](const cv::Mat& of) {
    return FeatureExtractor(options).Extract(ImagePyramid(of, 1), cv::Mat(), &num_masked);
  };
  const std::vector<Feature> before = extract(image), after = extract(turned);
  std::vector<int> distances;
  for (const Feature& feature : before) {
    const Eigen::Vector2d place(255 - feature.uv_px.y(), feature.uv_px.x());
    for (const Feature& other : after) {
      if ((other.uv_px - place).norm() > 0.5) continue;
      distances.push_back(HammingDistance(feature.descriptor, other.descriptor));
    }
  }
  ASSERT_GT(distances.size(), 50U);
  std::sort(distances.begin(), distances.end());
  // Two that have nothing in common differ in 128 bits or so.
  EXPECT_LT(distances[distances.size() / 2], 30);
}

// ---- people's part in the pose

TEST(PeoplePoseWeight, APersonCountsLessBeyondOneAndAHalfSigma) {
  const Se3 T_W_C{ExpSo3({0.3, -0.2, 0.5}), {1, 2, 3}};
  const PosePrior prior = IsotropicPrior(T_W_C, 1e-9, 1e-9);  // stays where it is
  // Two joints, each `sigmas` off in each axis.
  const auto information = [&](double sigmas) {
    HumanConstraint person;
    person.p_C = {{0.5, 0, 4}, {0.3, 0.6, 4.2}};
    for (const Eigen::Vector3d& p_C : person.p_C) {
      person.p_W.push_back(T_W_C * p_C + 0.1 * sigmas * Eigen::Vector3d(1, -1, 1));
    }
    person.covariance_W = 0.01 * Eigen::MatrixXd::Identity(6, 6);
    return EstimatePoseFromPeople(prior, {person}).information.trace();
  };
  EXPECT_NEAR(information(1.45) / information(0), 1, 1e-6);
  EXPECT_NEAR(information(3) / information(0), 0.5, 1e-6);
}

// ---- how the carrier accelerates

constexpr double kStep_s = 0.1;

/// Drives on at a velocity that changes by this acceleration every frame, to and fro.
void Shake(int num_frames, double acceleration_m_s2, const Matrix6d& information,
           CameraMotionFilter* filter, Se3* T_W_C) {
  for (int k = 0; k < num_frames; ++k) {
    const PosePrior prior = filter->Predict(*T_W_C, kStep_s);
    const double sign = k % 2 == 0 ? 1 : -1;
    Vector6d off = Vector6d::Zero();
    off[1] = sign * acceleration_m_s2 * kStep_s * kStep_s;
    *T_W_C = Boxplus(prior.T_W_C, off);
    filter->Update(prior, kStep_s, *T_W_C, information, true);
  }
}

TEST(CarrierNoise, TheLastTwentyFramesTell) {
  const Matrix6d exact = 1e12 * Matrix6d::Identity();
  CameraMotionFilter filter({});
  Se3 T_W_C;
  Shake(30, 2, exact, &filter, &T_W_C);
  EXPECT_NEAR(filter.linear_sigma_m_s2(), 6, 1e-6);  // three times the median
  EXPECT_EQ(filter.angular_sigma_rad_s2(), 3) << "at its floor";
  Shake(9, 5, exact, &filter, &T_W_C);
  EXPECT_NEAR(filter.linear_sigma_m_s2(), 6, 1e-6) << "nine of twenty";
  Shake(2, 5, exact, &filter, &T_W_C);
  EXPECT_NEAR(filter.linear_sigma_m_s2(), 15, 1e-6) << "eleven";
}

TEST(CarrierNoise, AFrameThatSeesLittleDoesNotTell) {
  const CameraMotionFilterOptions options;
  // A third of the variance of the acceleration's step, where a quarter is asked for.
  const auto information = [&options](double share) {
    const double linear = share * std::pow(options.linear_start_m_s2 * 0.01, 2);
    const double angular = share * std::pow(options.angular_start_rad_s2 * 0.01, 2);
    Vector6d diagonal;
    diagonal << 1 / linear, 1 / linear, 1 / linear, 1 / angular, 1 / angular, 1 / angular;
    return Matrix6d(diagonal.asDiagonal());
  };
  for (const double share : {0.33, 0.1}) {
    CameraMotionFilter filter(options);
    Se3 T_W_C;
    const Matrix6d exact = 1e12 * Matrix6d::Identity();
    for (int k = 0; k < 12; ++k) {
      Shake(1, 8, information(share), &filter, &T_W_C);
      // Known exactly in between, so that the next one is predicted well; but not told of.
      for (int i = 0; i < 3; ++i) {
        const PosePrior prior = filter.Predict(T_W_C, kStep_s);
        filter.Update(prior, kStep_s, prior.T_W_C, exact, false);
        T_W_C = prior.T_W_C;
      }
    }
    if (share > 0.25) {
      EXPECT_EQ(filter.linear_sigma_m_s2(), options.linear_start_m_s2);
    } else {
      EXPECT_GT(filter.linear_sigma_m_s2(), 10);
    }
  }
}

// ---- which landmarks are trusted

LandmarkId AddLandmark(const Eigen::Vector3d& p_W, int num_seen, LocalMap* map) {
  LocalLandmark landmark;
  landmark.p_W = p_W;
  landmark.trust = LandmarkTrust(0.5);
  landmark.num_seen = num_seen;
  landmark.num_expected = 1;
  return map->Add(landmark);
}

TEST(LandmarkJudgeLimits, OnlyLandmarksThatWereSeenOnceTellOfNewOnes) {
  LocalMap map{LocalMapOptions()};
  LandmarkJudge judge;
  const double before = judge.Unknown().At({10, 10}, 3);
  const LandmarkId old = AddLandmark({0, 0, 5}, 2, &map);
  judge.Judge(Camera(), Se3(), {old}, {}, &map);
  EXPECT_EQ(judge.Unknown().At({10, 10}, 3), before);
  const LandmarkId fresh = AddLandmark({0, 0, 5}, 1, &map);
  judge.Judge(Camera(), Se3(), {fresh}, {fresh}, &map);
  EXPECT_NEAR(judge.Unknown().At({10, 10}, 3), before + 0.005 * (1 - before), 1e-12);
}

TEST(LandmarkJudgeLimits, ATenthSetTheMeasure) {
  for (const int num_good : {2, 3}) {
    LocalMap map{LocalMapOptions()};
    LandmarkJudge judge;
    std::vector<LandmarkId> tried;
    std::set<LandmarkId> agreed;
    for (int i = 0; i < 20; ++i) {
      tried.push_back(AddLandmark({0.1 * i, 0, 5}, 2, &map));
      if (i < num_good) agreed.insert(tried.back());
    }
    judge.Judge(Camera(), Se3(), tried, agreed, &map);
    // After one verdict: 2 of 3 and 1 of 3. The third best is one of the good ones, or is not.
    const LandmarkTrust& bad = map.landmarks().at(tried.back()).trust;
    EXPECT_NEAR(bad.static_probability(), 1 / 3., 1e-12);
    EXPECT_NEAR(judge.RelativeTrust(bad), num_good == 3 ? 0.5 : 1, 1e-12);
  }
}

TEST(LandmarkJudgeLimits, DepthIsSeenFromTheCamera) {
  LocalMap map{LocalMapOptions()};
  LandmarkJudge judge;
  const Se3 T_W_C{Eigen::Quaterniond::Identity(), {0, 0, 10}};
  const LandmarkId id = AddLandmark({0, 0, 14}, 2, &map);
  const TrustField field = judge.Judge(Camera(), T_W_C, {id}, {}, &map);
  EXPECT_LT(field.At({160, 96}, 4), 0.5);
  EXPECT_NEAR(field.At({160, 96}, 14), 0.7, 1e-12);
}

TEST(LocalMapLimits, AReferenceFrameIsAsOldAsItsNewestLandmark) {
  LocalMap map{LocalMapOptions()};
  const auto add = [&map](std::int64_t reference, std::int64_t last_seen) {
    LocalLandmark landmark;
    landmark.reference_frame.value = reference;
    landmark.last_seen.value = last_seen;
    landmark.num_seen = 5;
    return map.Add(landmark);
  };
  const LandmarkId old = add(0, 10), recent = add(0, 900);
  const LandmarkId middle = add(1, 500);
  for (std::int64_t reference = 2; reference < 251; ++reference) add(reference, 600);
  map.Cull(FrameId{1000});
  EXPECT_EQ(map.landmarks().count(old), 1U);
  EXPECT_EQ(map.landmarks().count(recent), 1U);
  EXPECT_EQ(map.landmarks().count(middle), 0U);
  EXPECT_EQ(map.landmarks().size(), 251U);
}

}  // namespace
}  // namespace airdos
