// What the visual odometry says of its frames and landmarks, value by value, on a rendered walk.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "common/features/image_pyramid.h"
#include "common/features/visual_odometry.h"
#include "tests/support/rendered_scene.h"

namespace airdos {
namespace {

const StereoCamera kCamera = SmallStereoCamera();

const StereoPair& Walk(int k) {
  static std::map<int, StereoPair> pairs;
  if (pairs.count(k) == 0) pairs[k] = RenderedScene(11).Render(kCamera, SwayingPath(k));
  return pairs.at(k);
}

StereoImagePair Frame(int k, double step_s = 0.1) {
  return {FrameId{k}, step_s * k, Walk(k).left, Walk(k).right, {}, {}};
}

cv::Mat Blank(int grey) {
  return cv::Mat(kCamera.height, kCamera.width, CV_8UC1, cv::Scalar(grey));
}

/// Whether it is `base` times a power of the pyramid's factor.
bool IsOfSomeLevel(double sigma_px, double base_px) {
  const double level = std::log(sigma_px / base_px) / std::log(ImagePyramid::kScaleFactor);
  return level > -1e-6 && level < 7 + 1e-6 && std::abs(level - std::round(level)) < 1e-6;
}

TEST(OdometryValues, ThePriorGrowsWithTheSquareOfTheStep) {
  VisualOdometryOptions options;
  options.motion.linear_start_m_s2 = 5;
  options.motion.angular_start_rad_s2 = 11;
  VisualOdometry odometry(options);
  odometry.Process(kCamera, Frame(0, 0.25));
  const OdometryFrame frame = odometry.Process(kCamera, Frame(1, 0.25));
  EXPECT_NEAR(frame.prior_sigma_position_m, 5 * 0.0625, 1e-12);
  EXPECT_NEAR(frame.prior_sigma_orientation_rad, 11 * 0.0625, 1e-12);
  // A clock that jumps by more than ten steps counts as one more of these.
  StereoImagePair late = Frame(2);
  late.time_s = 0.25 + 3;
  const OdometryFrame jumped = odometry.Process(kCamera, late);
  EXPECT_NEAR(jumped.prior_sigma_position_m, 5 * 0.0625, 1e-12);
}

TEST(OdometryValues, CornersOnPeopleCountAsDetectedToo) {
  StereoImagePair images = Frame(0);
  const OdometryFrame plain = VisualOdometry({}).Process(kCamera, images);
  images.mask = Blank(0);
  images.mask.colRange(90, 200) = cv::Scalar(1);
  const OdometryFrame masked = VisualOdometry({}).Process(kCamera, images);
  EXPECT_EQ(plain.num_masked, 0);
  EXPECT_GT(masked.num_masked, 20);
  // About two thirds of the image are as they were.
  EXPECT_LT(masked.num_detected - masked.num_masked, plain.num_detected);
  EXPECT_GT(masked.num_detected - masked.num_masked, 0.4 * plain.num_detected);
  images.mask = Blank(255);
  const OdometryFrame hidden = VisualOdometry({}).Process(kCamera, images);
  EXPECT_GT(hidden.num_masked, 100);
  EXPECT_EQ(hidden.num_detected, hidden.num_masked);
  EXPECT_TRUE(hidden.sightings.empty());
}

TEST(OdometryValues, SigmasGrowWithTheLevelFromThatOfTheirKind) {
  for (const bool aligns : {true, false}) {
    VisualOdometryOptions options;
    options.aligned_sigma_px = 0.23;
    options.corner_sigma_px = 0.71;
    if (!aligns) options.min_correlation = 1;
    VisualOdometry odometry(options);
    std::set<std::int64_t> known;
    std::set<long> sigmas;
    int num_again = 0, num_corners = 0;
    for (int k = 0; k < 5; ++k) {
      const OdometryFrame frame = odometry.Process(kCamera, Frame(k));
      for (const LandmarkSighting& sighting : frame.sightings) {
        const bool is_new = known.insert(sighting.id.value).second;
        const bool is_aligned = IsOfSomeLevel(sighting.sigma_px, 0.23);
        const bool is_corner = IsOfSomeLevel(sighting.sigma_px, 0.71);
        EXPECT_TRUE(is_aligned || (is_corner && !is_new)) << sighting.sigma_px;
        EXPECT_TRUE(aligns || is_new || is_corner) << sighting.sigma_px;
        if (!is_new) sigmas.insert(std::lround(1e4 * sighting.sigma_px));
        num_again += is_new ? 0 : 1;
        num_corners += is_corner && !is_new ? 1 : 0;
      }
    }
    EXPECT_GT(num_again, 100);
    EXPECT_GE(sigmas.size(), 3u) << "of landmarks that were seen again, on several levels";
    EXPECT_EQ(num_corners > num_again / 2, !aligns);
  }
}

TEST(OdometryValues, EachLandmarkKnowsInHowManyFramesItWasSeen) {
  VisualOdometry odometry({});
  std::map<LandmarkId, int> num_seen;
  std::map<LandmarkId, int> last_seen;
  for (int k = 0; k < 8; ++k) {
    for (const LandmarkSighting& sighting : odometry.Process(kCamera, Frame(k)).sightings) {
      ++num_seen[sighting.id];
      last_seen[sighting.id] = k;
    }
  }
  int num_checked = 0;
  for (const auto& [id, landmark] : odometry.map().landmarks()) {
    EXPECT_EQ(landmark.num_seen, num_seen[id]);
    EXPECT_EQ(landmark.last_seen.value, last_seen[id]);
    EXPECT_GE(landmark.num_expected, landmark.num_seen);
    num_checked += landmark.num_seen > 2 ? 1 : 0;
  }
  EXPECT_GT(num_checked, 50);
}

TEST(OdometryValues, TheRightColumnIsThatOfTheDepthAndMissingWhereThereIsNone) {
  const RenderedScene scene(11);
  VisualOdometry odometry({});
  std::set<std::int64_t> known;
  int num_again = 0, num_again_with_right = 0;
  for (int k = 0; k < 4; ++k) {
    StereoImagePair images = Frame(k);
    if (k == 3) images.right = Blank(0);
    const OdometryFrame frame = odometry.Process(kCamera, images);
    ASSERT_GT(frame.sightings.size(), 60u);
    std::vector<double> errors_px;
    for (const LandmarkSighting& sighting : frame.sightings) {
      EXPECT_EQ(sighting.has_right && k == 3, false);
      if (!known.insert(sighting.id.value).second && k < 3) {
        ++num_again;
        num_again_with_right += sighting.has_right ? 1 : 0;
      }
      if (!sighting.has_right) {
        EXPECT_EQ(sighting.uvu_px.z(), 0);
        continue;
      }
      const double depth_m = scene.Depth_m(kCamera, SwayingPath(k), sighting.uvu_px.head<2>());
      const double disparity_px = kCamera.fx_px * kCamera.baseline_m / depth_m;
      errors_px.push_back(std::abs(sighting.uvu_px.x() - sighting.uvu_px.z() - disparity_px));
    }
    if (k == 3) continue;
    ASSERT_GT(errors_px.size(), 50u);
    std::nth_element(errors_px.begin(), errors_px.begin() + 30, errors_px.end());
    EXPECT_LT(errors_px[30], 0.3);
  }
  EXPECT_GT(num_again, 100);
  EXPECT_GT(num_again_with_right, 0.8 * num_again);
}

// Of the two bounds the stricter one counts where landmarks abound.
TEST(OdometryValues, WhereLandmarksAboundNoBoundIsLowered) {
  const auto num_new = [](double min_correlation, double rich_min_correlation) {
    VisualOdometryOptions options;
    options.rich_observations = 30;
    options.stereo.min_correlation = min_correlation;
    options.rich_min_correlation = rich_min_correlation;
    VisualOdometry odometry(options);
    std::size_t before = 0;
    for (int k = 0; k < 3; ++k) {
      before = odometry.map().landmarks().size();
      odometry.Process(kCamera, Frame(k));
    }
    return odometry.map().landmarks().size() - before;
  };
  const std::size_t as_usual = num_new(0.9, 0.9);
  EXPECT_GT(as_usual, 20u);
  EXPECT_LT(num_new(0.9, 0.9995), as_usual / 2);
  EXPECT_GT(num_new(0.9, 0.5), as_usual - 5) << "a lower one changes nothing";
  EXPECT_LT(num_new(0.9, 0.5), as_usual + 5);
}

// Walking towards things they grow: a landmark that looks too different is known anew by how it
// looks now, on a higher level of the pyramid; walking away, on a lower one.
TEST(OdometryValues, AnApproachedLandmarkGoesToAHigherLevel) {
  const RenderedScene scene(11);
  for (const int direction : {1, -1}) {
    VisualOdometry odometry({});
    std::map<LandmarkId, std::pair<FrameId, int>> reference;  // frame, level
    int num_up = 0, num_down = 0;
    for (int k = 0; k < 14; ++k) {
      Se3 T_W_C = SwayingPath(0);
      T_W_C.translation += T_W_C.rotation * Eigen::Vector3d(0, 0, direction * (0.08 * k - 0.5));
      const StereoPair pair = scene.Render(kCamera, T_W_C);
      odometry.Process(kCamera, {FrameId{k}, 0.1 * k, pair.left, pair.right, {}, {}});
      for (const auto& [id, landmark] : odometry.map().landmarks()) {
        const auto [known, is_new] =
            reference.try_emplace(id, landmark.reference_frame, landmark.reference_level);
        if (is_new || known->second.first == landmark.reference_frame) continue;
        num_up += landmark.reference_level > known->second.second ? 1 : 0;
        num_down += landmark.reference_level < known->second.second ? 1 : 0;
        EXPECT_LT(std::abs(landmark.reference_level - known->second.second), 3);
        known->second = {landmark.reference_frame, landmark.reference_level};
        const Eigen::Vector2d uv_px = kCamera.Project(landmark.p_C_reference);
        EXPECT_LT((uv_px - landmark.reference_uv_px).norm(), 3) << "where it is in that image";
      }
    }
    EXPECT_GT(direction > 0 ? num_up : num_down, 5);
    EXPECT_LT(direction > 0 ? num_down : num_up, 2);
  }
}

// In the first frame, which defines W, only the stereo measurement errs; a landmark's covariance
// later on is that and what the pose adds.
TEST(OdometryValues, ALandmarkIsAsUncertainAsItsMeasurementAndItsPose) {
  VisualOdometryOptions options;
  VisualOdometry odometry(options);
  std::set<LandmarkId> known;
  for (int k = 0; k < 6; ++k) {
    const OdometryFrame frame = odometry.Process(kCamera, Frame(k));
    int num_new = 0;
    for (const auto& [id, landmark] : odometry.map().landmarks()) {
      if (!known.insert(id).second) continue;
      ++num_new;
      const double sigma_px =
          options.aligned_sigma_px * std::pow(ImagePyramid::kScaleFactor, landmark.reference_level);
      const Eigen::Matrix3d R = frame.T_W_C.rotation.toRotationMatrix();
      const Eigen::Matrix3d measured =
          R * kCamera.TriangulationCovariance(landmark.p_C_reference, sigma_px) * R.transpose();
      const Eigen::Matrix3d added = landmark.created_covariance_W - measured;
      if (k == 0) {
        EXPECT_LT(added.norm(), 1e-9 * measured.norm());
        EXPECT_LT((landmark.p_W - landmark.p_C_reference).norm(), 1e-12);
      } else {
        EXPECT_GT(added.trace(), 0);
        EXPECT_LT((landmark.p_W - frame.T_W_C * landmark.p_C_reference).norm(), 1e-9);
      }
    }
    EXPECT_GT(num_new, 3) << k;
  }
}

// People help out where the frame before saw nothing; where this one does they have no say.
TEST(OdometryValues, PeopleHaveNoSayWhereLandmarksAreFoundAgain) {
  VisualOdometry odometry({});
  OdometryFrame frame;
  for (int k = 0; k < 8; ++k) {
    StereoImagePair images = Frame(k);
    if (k == 5 || k == 6) images.mask = Blank(255);
    HumanMeasurement person{HumanId{3}, {}};
    for (const int joint : {1, 2, 5, 8, 11}) {
      HumanMeasurement::Joint at;
      at.joint = joint;
      at.p_C = (SwayingPath(0).inverse() * SwayingPath(k)).inverse() *
               Eigen::Vector3d(0.1 * joint - 0.5, joint < 6 ? -0.4 : 0.1, 4);
      at.covariance_C = 1e-4 * Eigen::Matrix3d::Identity();
      person.joints.push_back(at);
    }
    images.people = {person};
    frame = odometry.Process(kCamera, images);
    EXPECT_EQ(frame.num_people, k == 6 ? 1 : 0) << k;
  }
  EXPECT_EQ(frame.state, TrackingState::kTracking);
  EXPECT_EQ(frame.num_people, 0);
}

TEST(OdometryValues, NothingIsSeenOnPeopleEvenIfALandmarkWasThereBefore) {
  VisualOdometry odometry({});
  for (int k = 0; k < 4; ++k) odometry.Process(kCamera, Frame(k));
  StereoImagePair images = Frame(4);
  images.mask = Blank(0);
  images.mask.colRange(100, 220) = cv::Scalar(255);
  const OdometryFrame frame = odometry.Process(kCamera, images);
  ASSERT_GT(frame.sightings.size(), 30u);
  for (const LandmarkSighting& sighting : frame.sightings) {
    const long u = std::lround(sighting.uvu_px.x());
    EXPECT_TRUE(u < 100 || u >= 220) << u;
  }
}

}  // namespace
}  // namespace airdos
