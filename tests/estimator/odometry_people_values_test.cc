// People in the visual odometry: what they add to what is known, and that they move along with W.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
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

Se3 Truth(int k) { return SwayingPath(0).inverse() * SwayingPath(k); }

/// Three who walk, each at its own steady pace, measured to a few millimetres.
std::vector<HumanMeasurement> People(int k) {
  std::vector<HumanMeasurement> people;
  const Eigen::Vector3d places_W[] = {{-1, 0, 4}, {1.2, 0.1, 5}, {0.2, -0.1, 6}};
  const Eigen::Vector3d velocities_W[] = {{0.6, 0, 0.2}, {0, 0, -0.4}, {-0.5, 0, 0.3}};
  for (int person = 0; person < 3; ++person) {
    HumanMeasurement measurement{HumanId{person + 1}, {}};
    for (const int joint : {0, 1, 2, 5, 8, 11}) {
      const Eigen::Vector3d offset(0.15 * (joint % 3 - 1), joint < 8 ? -0.5 : 0,
                                   0.05 * (joint % 2));
      HumanMeasurement::Joint at;
      at.joint = joint;
      at.p_C = Truth(k).inverse() * (places_W[person] + 0.1 * k * velocities_W[person] + offset);
      at.covariance_C = Eigen::Vector3d(1e-5, 2e-5, 4e-5).asDiagonal();
      measurement.joints.push_back(at);
    }
    people.push_back(measurement);
  }
  return people;
}

StereoImagePair Frame(int k, bool has_people, bool is_hidden) {
  StereoImagePair images{FrameId{k}, 0.1 * k, Walk(k).left, Walk(k).right, {}, {}};
  if (has_people) images.people = People(k);
  if (is_hidden) images.mask = cv::Mat(kCamera.height, kCamera.width, CV_8UC1, cv::Scalar(255));
  return images;
}

// Where few static landmarks are seen, what people say makes the pose better known, and so the
// landmarks that are made in such a frame.
TEST(OdometryPeopleValues, TheyMakeThePoseBetterKnown) {
  const auto added_variance_m2 = [](bool has_people) {
    VisualOdometryOptions options;
    options.max_observations = 12;
    options.min_inliers_tracking = 3;
    options.max_static_for_people = 10000;
    options.aligned_sigma_px = 3;  // people are better known than the static scene
    options.people.acceleration_m_s2 = 0.2;
    options.people.wobble_m = 0.005;
    VisualOdometry odometry(options);
    double sum = 0;
    for (int k = 0; k < 8; ++k) {
      std::map<LandmarkId, bool> known;
      for (const auto& [id, landmark] : odometry.map().landmarks()) known[id] = true;
      const OdometryFrame frame = odometry.Process(kCamera, Frame(k, has_people, false));
      EXPECT_EQ(frame.num_people, has_people && k > 0 ? 3 : 0) << k;
      for (const auto& [id, landmark] : odometry.map().landmarks()) {
        if (known.count(id) > 0 || k < 3) continue;
        const double sigma_px = options.aligned_sigma_px *
                                std::pow(ImagePyramid::kScaleFactor, landmark.reference_level);
        const Eigen::Matrix3d measured =
            kCamera.TriangulationCovariance(landmark.p_C_reference, sigma_px);
        sum += landmark.created_covariance_W.trace() - measured.trace();
      }
    }
    return sum;
  };
  const double without = added_variance_m2(false);
  EXPECT_GT(without, 0);
  EXPECT_LT(added_variance_m2(true), 0.9 * without);
}

// A landmark is better known the more often it was seen, and so are the poses, and what is made in
// such a frame: though the way from the start grows, what they add does not.
TEST(OdometryPeopleValues, LandmarksThatWereSeenOftenHoldThePose) {
  VisualOdometryOptions options;
  options.max_observations = 14;
  options.min_inliers_tracking = 3;
  options.map.max_frames_unconfirmed = 1000;
  VisualOdometry odometry(options);
  std::map<int, double> sum_m2, num;  // by frame
  std::map<LandmarkId, bool> known;
  for (int k = 0; k < 14; ++k) {
    odometry.Process(kCamera, Frame(k, false, false));
    for (const auto& [id, landmark] : odometry.map().landmarks()) {
      if (!known.try_emplace(id, true).second) continue;
      const double sigma_px =
          options.aligned_sigma_px * std::pow(ImagePyramid::kScaleFactor, landmark.reference_level);
      const Eigen::Matrix3d measured =
          kCamera.TriangulationCovariance(landmark.p_C_reference, sigma_px);
      sum_m2[k] += landmark.created_covariance_W.trace() - measured.trace();
      num[k] += 1;
    }
  }
  double early_m2 = 0, num_early = 0, late_m2 = 0, num_late = 0;
  for (const auto& [k, sum] : sum_m2) {
    if (k >= 2 && k < 6) early_m2 += sum, num_early += num[k];
    if (k >= 10) late_m2 += sum, num_late += num[k];
  }
  ASSERT_GT(num_early, 0);
  ASSERT_GT(num_late, 0);
  EXPECT_LT(late_m2 / num_late, 3 * early_m2 / num_early);
}

// Where very many landmarks are seen at once their own errors count as cancelled: the pose is known
// to a fraction of a millimetre, far better than any of them.
TEST(OdometryPeopleValues, VeryManyLandmarksMakeTheirErrorsCancel) {
  VisualOdometry odometry({});
  std::map<LandmarkId, bool> known;
  double sum_m2 = 0, num = 0;
  for (int k = 0; k < 5; ++k) {
    const OdometryFrame frame = odometry.Process(kCamera, Frame(k, false, false));
    EXPECT_GT(frame.sightings.size(), 100u);
    for (const auto& [id, landmark] : odometry.map().landmarks()) {
      if (!known.try_emplace(id, true).second || k < 2) continue;
      const double sigma_px = VisualOdometryOptions().aligned_sigma_px *
                              std::pow(ImagePyramid::kScaleFactor, landmark.reference_level);
      sum_m2 += landmark.created_covariance_W.trace() -
                kCamera.TriangulationCovariance(landmark.p_C_reference, sigma_px).trace();
      num += 1;
    }
  }
  ASSERT_GT(num, 10);
  EXPECT_LT(sum_m2 / num, 3e-6);  // 2.4e-6; if their errors counted 3.8e-6
}

// The same frames in another W, from frame 9 on: all that follows is the same in its axes, also
// where people alone say where the camera is.
TEST(OdometryPeopleValues, PeopleMoveAlongWithTheWorld) {
  const Se3 T_new_old{ExpSo3({0.02, -0.3, 0.05}), {0.4, -0.2, 0.3}};
  const auto run = [&](bool is_corrected) {
    VisualOdometry odometry({});
    std::vector<OdometryFrame> frames;
    for (int k = 0; k < 16; ++k) {
      frames.push_back(odometry.Process(kCamera, Frame(k, true, k >= 10)));
      if (is_corrected && k == 9) {
        MapCorrection correction;
        correction.newest = FrameId{k};
        correction.frames = {{FrameId{k}, T_new_old * frames.back().T_W_C}};
        odometry.Apply(correction);
      }
    }
    return frames;
  };
  const std::vector<OdometryFrame> plain = run(false);
  const std::vector<OdometryFrame> corrected = run(true);
  for (std::size_t k = 11; k < 16; ++k) {
    EXPECT_EQ(plain[k].num_people, 3);
    EXPECT_EQ(corrected[k].num_people, 3);
    EXPECT_LT(Boxminus(corrected[k].T_W_C, T_new_old * plain[k].T_W_C).norm(), 1e-4) << k;
    EXPECT_LT(Boxminus(corrected[k].T_O_C, plain[k].T_O_C).norm(), 1e-4) << k;
    EXPECT_LT(Boxminus(plain[k].T_W_C, Truth(static_cast<int>(k))).head<3>().norm(), 0.1) << k;
  }
}

// Pictures of other places: what a few chance matches say is not believed, however well they agree.
TEST(OdometryPeopleValues, AChanceAgreementOfAFewMovesNothing) {
  VisualOdometryOptions options;
  options.min_correlation = 0.3;
  options.wide_max_hamming_bits = options.narrow_max_hamming_bits = 256;
  VisualOdometry odometry(options);
  for (int k = 0; k < 8; ++k) odometry.Process(kCamera, Frame(k, false, false));
  Se3 before = Truth(7);
  for (std::uint32_t i = 0; i < 6; ++i) {
    const int k = 8 + static_cast<int>(i);
    const StereoPair other = RenderedScene(50 + i).Render(kCamera, SwayingPath(k));
    const OdometryFrame frame =
        odometry.Process(kCamera, {FrameId{k}, 0.1 * k, other.left, other.right, {}, {}});
    if (frame.state == TrackingState::kTracking) continue;
    // The path goes on at 5 cm a frame; what the prior allows is 22.5 in squared sigmas.
    const Vector6d step = Boxminus(frame.T_W_C, before);
    EXPECT_LT(step.head<3>().norm(), 0.06 * (k - 6) + 4.8 * frame.prior_sigma_position_m * (k - 6));
    before = frame.T_W_C;
  }
}

}  // namespace
}  // namespace airdos
