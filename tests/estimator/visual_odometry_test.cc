#include "common/features/visual_odometry.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <vector>

#include "tests/support/rendered_scene.h"

namespace airdos {
namespace {

constexpr int kNumFrames = 30;
constexpr double kFrameStep_s = 0.1;
const StereoCamera kCamera = SmallStereoCamera();

/// Each is rendered once, when a test first asks for it.
const StereoPair& Walk(int k) {
  static std::map<int, StereoPair> pairs;
  if (pairs.count(k) == 0) pairs[k] = RenderedScene(11).Render(kCamera, SwayingPath(k));
  return pairs.at(k);
}

/// In W, which is the first left camera.
Se3 Truth(int k) { return SwayingPath(0).inverse() * SwayingPath(k); }

StereoImagePair Frame(int k) {
  const StereoPair& pair = Walk(k);
  return {FrameId{k}, kFrameStep_s * k, pair.left, pair.right, {}, {}};
}

StereoImagePair BlackFrame(int k) {
  StereoImagePair images = Frame(k);
  // Not cv::Mat::zeros(): assigning it would fill the pixels that Walk() keeps.
  images.left = cv::Mat(kCamera.height, kCamera.width, CV_8UC1, cv::Scalar(0));
  images.right = images.left.clone();
  return images;
}

double PositionError_m(const Se3& a, const Se3& b) { return Boxminus(a, b).head<3>().norm(); }
double RotationError_rad(const Se3& a, const Se3& b) { return Boxminus(a, b).tail<3>().norm(); }

// FollowsAPathThatTurnsAndSways measures 6 mm and 1 mrad over 0.9 m of path. A feature is found to
// about 0.1 px, which is 4 mm of depth at 3 m; without bundle adjustment the errors of the frames
// in which landmarks were created add up. The bound leaves a factor of 2.5 for other builds of
// OpenCV.
constexpr double kMaxPositionError_m = 0.015;
constexpr double kMaxRotationError_rad = 0.0025;

void ExpectNear(const OdometryFrame& frame, const Se3& T_W_C_true, int k, double factor = 1) {
  EXPECT_LT(PositionError_m(frame.T_W_C, T_W_C_true), factor * kMaxPositionError_m)
      << "frame " << k;
  EXPECT_LT(RotationError_rad(frame.T_W_C, T_W_C_true), factor * kMaxRotationError_rad)
      << "frame " << k;
}

/// Frame by frame, with `make` for the images of each.
template <class MakeImages>
std::vector<OdometryFrame> RunAll(MakeImages make, int num_frames = kNumFrames) {
  VisualOdometry odometry({});
  std::vector<OdometryFrame> frames;
  for (int k = 0; k < num_frames; ++k) frames.push_back(odometry.Process(kCamera, make(k)));
  return frames;
}

TEST(VisualOdometry, FollowsAPathThatTurnsAndSways) {
  const std::vector<OdometryFrame> frames = RunAll(Frame);
  double worst_m = 0;
  double worst_rad = 0;
  double path_m = 0;
  for (int k = 0; k < kNumFrames; ++k) {
    const OdometryFrame& frame = frames[static_cast<std::size_t>(k)];
    EXPECT_EQ(frame.state, k == 0 ? TrackingState::kInitializing : TrackingState::kTracking);
    ExpectNear(frame, Truth(k), k);
    worst_m = std::max(worst_m, PositionError_m(frame.T_W_C, Truth(k)));
    worst_rad = std::max(worst_rad, RotationError_rad(frame.T_W_C, Truth(k)));
    if (k > 0) path_m += (Truth(k).translation - Truth(k - 1).translation).norm();
  }
  RecordProperty("worst_mm", static_cast<int>(std::lround(1000 * worst_m)));
  RecordProperty("worst_mrad", static_cast<int>(std::lround(1000 * worst_rad)));
  RecordProperty("path_mm", static_cast<int>(std::lround(1000 * path_m)));
  EXPECT_EQ(PositionError_m(frames[0].T_W_C, Se3()), 0);  // it defines W
}

TEST(VisualOdometry, SightingsLieWhereTheLandmarksAre) {
  VisualOdometry odometry({});
  for (int k = 0; k < 10; ++k) {
    const OdometryFrame frame = odometry.Process(kCamera, Frame(k));
    ASSERT_GT(frame.sightings.size(), 60u);
    EXPECT_LE(frame.sightings.size(), 300u);
    std::vector<double> errors_px;
    for (const LandmarkSighting& sighting : frame.sightings) {
      const Eigen::Vector3d p_C =
          frame.T_W_C.inverse() * odometry.map().landmarks().at(sighting.id).p_W;
      errors_px.push_back((kCamera.Project(p_C) - sighting.uvu_px.head<2>()).norm());
      EXPECT_GT(sighting.sigma_px, 0);
    }
    std::sort(errors_px.begin(), errors_px.end());
    EXPECT_LT(errors_px[errors_px.size() / 2], 0.3);
    EXPECT_TRUE(std::is_sorted(frame.sightings.begin(), frame.sightings.end(),
                               [](const auto& a, const auto& b) { return a.id < b.id; }));
  }
}

TEST(VisualOdometry, LandmarksAreSeenAgain) {
  const std::vector<OdometryFrame> frames = RunAll(Frame, 6);
  std::size_t num_again = 0;
  for (const LandmarkSighting& sighting : frames[5].sightings) {
    for (const LandmarkSighting& first : frames[0].sightings) num_again += first.id == sighting.id;
  }
  EXPECT_GT(num_again, frames[0].sightings.size() / 4);
}

TEST(VisualOdometry, WhereLandmarksAboundOnlyBetterStereoMatchesAreTaken) {
  const auto num_matched = [](int rich_observations) {
    VisualOdometryOptions options;
    options.rich_observations = rich_observations;
    options.rich_min_correlation = 0.999;  // which few patches reach
    VisualOdometry odometry(options);
    odometry.Process(kCamera, Frame(0));
    const OdometryFrame frame = odometry.Process(kCamera, Frame(1));
    return std::count_if(frame.sightings.begin(), frame.sightings.end(),
                         [](const LandmarkSighting& sighting) { return sighting.has_right; });
  };
  const auto num_of_any = num_matched(/*rich_observations=*/100000);
  EXPECT_GT(num_of_any, 60);
  EXPECT_LT(num_matched(/*rich_observations=*/60), num_of_any / 2);
}

TEST(VisualOdometry, AMaskOverMostOfTheImageIsKeptFreeAndSurvived) {
  // People in three quarters of the image, moving to and fro.
  const auto mask_of = [](int k) {
    cv::Mat mask = cv::Mat::zeros(kCamera.height, kCamera.width, CV_8UC1);
    mask(cv::Rect(40 + 4 * (k % 5), 0, kCamera.width * 3 / 4 - 20, kCamera.height)) = 255;
    return mask;
  };
  const std::vector<OdometryFrame> frames = RunAll([&](int k) {
    StereoImagePair images = Frame(k);
    images.mask = mask_of(k);
    return images;
  });
  for (int k = 0; k < kNumFrames; ++k) {
    const OdometryFrame& frame = frames[static_cast<std::size_t>(k)];
    // A third of the image and the fewer landmarks: three times the bound.
    ExpectNear(frame, Truth(k), k, 3);
    EXPECT_NE(frame.state, TrackingState::kCoasting) << "frame " << k;
    EXPECT_GT(frame.num_masked, frame.num_detected / 2);
    for (const LandmarkSighting& sighting : frame.sightings) {
      const auto u = static_cast<int>(std::lround(sighting.uvu_px.x()));
      const auto v = static_cast<int>(std::lround(sighting.uvu_px.y()));
      EXPECT_EQ(mask_of(k).at<uchar>(v, u), 0) << "frame " << k;
    }
  }
}

/// A group walks into view from the left, unknown to the odometry: cards 2.5 m in front of the
/// camera, 12 px (14 cm) a frame. In the end they hide three quarters of the world.
StereoImagePair FrameWithWalkers(int k) {
  constexpr int kDisparity_px = 21;
  constexpr int kStep_px = 12;
  constexpr int kWidth_px = 80;
  static const cv::Mat kCloth = NoisePicture(kWidth_px, kCamera.height, 5);
  const StereoPair& pair = Walk(k);
  StereoImagePair images{FrameId{k}, kFrameStep_s * k, pair.left.clone(), pair.right.clone(), {},
                         {}};
  const auto draw = [](int begin, cv::Mat* image) {
    const cv::Rect card =
        cv::Rect(begin, 0, kWidth_px, image->rows) & cv::Rect(0, 0, image->cols, image->rows);
    if (card.empty()) return;
    kCloth(cv::Rect(card.x - begin, 0, card.width, card.height)).copyTo((*image)(card));
  };
  const int shift_px = kStep_px * k;
  for (const int begin : {-80, -200, -320}) {
    draw(begin + shift_px, &images.left);
    draw(begin + shift_px - kDisparity_px, &images.right);
  }
  return images;
}

TEST(VisualOdometry, AGroupThatWalksTogetherDoesNotDragTheCamera) {
  const std::vector<OdometryFrame> frames = RunAll(FrameWithWalkers);
  for (int k = 0; k < kNumFrames; ++k) {
    // Half of the image and the fewer landmarks: three times the bound.
    ExpectNear(frames[static_cast<std::size_t>(k)], Truth(k), k, 3);
  }
}

TEST(VisualOdometry, BlackFramesCoastAndTrackingComesBack) {
  const auto is_black = [](int k) { return k == 12 || k == 13; };
  const std::vector<OdometryFrame> frames =
      RunAll([&](int k) { return is_black(k) ? BlackFrame(k) : Frame(k); });
  for (int k = 1; k < kNumFrames; ++k) {
    const OdometryFrame& frame = frames[static_cast<std::size_t>(k)];
    if (is_black(k)) {
      EXPECT_EQ(frame.state, TrackingState::kCoasting);
      EXPECT_TRUE(frame.sightings.empty());
      EXPECT_EQ(frame.num_detected, 0);
      // Constant velocity for 0.2 s: the path bends by up to 5 mm and 6 mrad a frame and frame.
      ExpectNear(frame, Truth(k), k, 4);
    } else {
      EXPECT_EQ(frame.state, TrackingState::kTracking) << "frame " << k;
      ExpectNear(frame, Truth(k), k);
    }
  }
}

TEST(VisualOdometry, AfterALongBlackoutThePoseIsFoundAgain) {
  // 2.5 s without a picture, then the view of frame 12 again: by then the prediction is far off,
  // and only the descriptors of what was seen before can tell the pose.
  constexpr int kFirstBlack = 13;
  constexpr int kFirstAgain = 38;
  VisualOdometry odometry({});
  for (int k = 0; k < kFirstAgain + 3; ++k) {
    const bool is_black = k >= kFirstBlack && k < kFirstAgain;
    const int place = std::min(k, kFirstBlack - 1);
    StereoImagePair images = is_black ? BlackFrame(place) : Frame(place);
    images.id = FrameId{k};
    images.time_s = kFrameStep_s * k;
    const OdometryFrame frame = odometry.Process(kCamera, images);
    if (k < kFirstAgain) continue;
    EXPECT_EQ(frame.state, TrackingState::kTracking) << "frame " << k;
    ExpectNear(frame, Truth(kFirstBlack - 1), k);
  }
}

TEST(VisualOdometry, CoastingGoesOnAsBeforeAndSlowsDown) {
  const VisualOdometryOptions options;
  VisualOdometry odometry(options);
  Se3 T_W_C_8;
  Se3 T_W_C_9;
  for (int k = 0; k < 10; ++k) {
    T_W_C_8 = T_W_C_9;
    T_W_C_9 = odometry.Process(kCamera, Frame(k)).T_W_C;
  }
  const OdometryFrame coasted = odometry.Coast(FrameId{10}, 10 * kFrameStep_s);
  EXPECT_EQ(coasted.state, TrackingState::kCoasting);
  // The velocity is that of the last step as far as single steps can be believed: some 4 cm and
  // 17 mrad a frame against the noise of two poses, 3 mm and 1 mrad.
  const double memory = std::exp(-kFrameStep_s / options.motion.memory_s);
  const Vector6d motion = memory * Boxminus(T_W_C_9, T_W_C_8);
  ASSERT_GT(motion.head<3>().norm(), 0.03);
  ASSERT_GT(motion.tail<3>().norm(), 0.01);
  EXPECT_LT(PositionError_m(coasted.T_W_C, Boxplus(T_W_C_9, motion)), 0.003);
  EXPECT_LT(RotationError_rad(coasted.T_W_C, Boxplus(T_W_C_9, motion)), 0.001);
  // Half a step of time, half a step of motion, and a little less.
  const OdometryFrame half = odometry.Coast(FrameId{11}, 10.5 * kFrameStep_s);
  const Vector6d last = std::sqrt(memory) * 0.5 * Boxminus(coasted.T_W_C, T_W_C_9);
  EXPECT_LT(Boxminus(half.T_W_C, Boxplus(coasted.T_W_C, last)).norm(), 1e-9);
}

TEST(VisualOdometry, AFirstFrameWithoutImagesIsTheOrigin) {
  VisualOdometry odometry({});
  const OdometryFrame first = odometry.Coast(FrameId{0}, 0);
  EXPECT_EQ(first.state, TrackingState::kInitializing);
  EXPECT_EQ(Boxminus(first.T_W_C, Se3()).norm(), 0);
  // The first one with images then stays there, and the landmarks start with it.
  for (int k = 1; k < 8; ++k) {
    const OdometryFrame frame = odometry.Process(kCamera, Frame(k));
    ExpectNear(frame, SwayingPath(1).inverse() * SwayingPath(k), k);
    EXPECT_EQ(frame.state, k == 1 ? TrackingState::kCoasting : TrackingState::kTracking);
  }
}

TEST(VisualOdometry, AClockThatStandsStillOrJumpsDoesNoHarm) {
  const std::vector<OdometryFrame> frames = RunAll([](int k) {
    StereoImagePair images = Frame(k);
    if (k >= 8) images.time_s = Frame(k - 1).time_s;  // twice the same time at 7, 8
    if (k >= 15) images.time_s += 3600;               // one hour on
    if (k >= 20) images.time_s -= 7200;               // and two back
    return images;
  });
  for (int k = 1; k < kNumFrames; ++k) {
    const OdometryFrame& frame = frames[static_cast<std::size_t>(k)];
    EXPECT_EQ(frame.state, TrackingState::kTracking) << "frame " << k;
    ExpectNear(frame, Truth(k), k);
  }
}

TEST(VisualOdometry, TheSamePictureAgainIsTheSamePose) {
  VisualOdometry odometry({});
  for (int k = 0; k < 10; ++k) odometry.Process(kCamera, Frame(k));
  StereoImagePair again = Frame(9);
  again.id = FrameId{10};  // and at the same time as frame 9
  const OdometryFrame frame = odometry.Process(kCamera, again);
  EXPECT_EQ(frame.state, TrackingState::kTracking);
  ExpectNear(frame, Truth(9), 10);
}

TEST(VisualOdometry, TwoRunsGiveTheSameBits) {
  const std::vector<OdometryFrame> a = RunAll(Frame, 12);
  const std::vector<OdometryFrame> b = RunAll(Frame, 12);
  for (std::size_t k = 0; k < a.size(); ++k) {
    EXPECT_EQ(a[k].T_W_C.translation, b[k].T_W_C.translation);
    EXPECT_EQ(a[k].T_W_C.rotation.coeffs(), b[k].T_W_C.rotation.coeffs());
    EXPECT_EQ(a[k].prior_sigma_position_m, b[k].prior_sigma_position_m);
    EXPECT_EQ(a[k].num_matched, b[k].num_matched);
    ASSERT_EQ(a[k].sightings.size(), b[k].sightings.size());
    for (std::size_t i = 0; i < a[k].sightings.size(); ++i) {
      EXPECT_EQ(a[k].sightings[i].id, b[k].sightings[i].id);
      EXPECT_EQ(a[k].sightings[i].uvu_px, b[k].sightings[i].uvu_px);
    }
  }
}

TEST(VisualOdometry, ACorrectionMovesAllThatFollows) {
  // The optimizer has frame 10 somewhere else, once frame 12 is done: every second landmark and all
  // frames up to 10 are moved as one; frames 11 and 12 and the other landmarks have to follow.
  Vector6d delta;
  delta << 0.2, -0.1, 0.3, 0.05, -0.1, 0.02;
  const Se3 T_new_old = Boxplus(Se3(), delta);
  VisualOdometry odometry({});
  for (int k = 0; k < kNumFrames; ++k) {
    const OdometryFrame frame = odometry.Process(kCamera, Frame(k));
    EXPECT_EQ(frame.state, k == 0 ? TrackingState::kInitializing : TrackingState::kTracking);
    if (k <= 12) {
      ExpectNear(frame, Truth(k), k);
    } else {
      ExpectNear(frame, T_new_old * Truth(k), k);
    }
    if (k != 12) continue;
    MapCorrection correction;
    correction.newest = FrameId{10};
    for (const auto& [id, T_W_C] : odometry.map().poses_W_C()) {
      if (id.value <= 10) correction.frames.emplace_back(id, T_new_old * T_W_C);
    }
    for (const auto& [id, landmark] : odometry.map().landmarks()) {
      if (id.value % 2 == 0) correction.landmarks_W_m.emplace_back(id, T_new_old * landmark.p_W);
    }
    odometry.Apply(correction);
  }
}

TEST(VisualOdometry, CorrectionsDoNotMoveTheOdometryFrame) {
  // After frame 12 the optimizer has the world half a metre and 0.1 rad elsewhere.
  Vector6d delta;
  delta << 0.3, -0.2, 0.4, 0.05, -0.1, 0.02;
  const Se3 T_new_old = Boxplus(Se3(), delta);
  VisualOdometry odometry({});
  for (int k = 0; k < 20; ++k) {
    const OdometryFrame frame = odometry.Process(kCamera, Frame(k));
    EXPECT_LT(PositionError_m(frame.T_O_C, Truth(k)), kMaxPositionError_m) << "frame " << k;
    EXPECT_LT(RotationError_rad(frame.T_O_C, Truth(k)), kMaxRotationError_rad) << "frame " << k;
    if (k <= 12) {
      EXPECT_LT(Boxminus(frame.T_O_C, frame.T_W_C).norm(), 1e-12);
    }
    if (k != 12) continue;
    MapCorrection correction;
    correction.newest = FrameId{k};
    for (const auto& [id, T_W_C] : odometry.map().poses_W_C())
      correction.frames.emplace_back(id, T_new_old * T_W_C);
    for (const auto& [id, landmark] : odometry.map().landmarks())
      correction.landmarks_W_m.emplace_back(id, T_new_old * landmark.p_W);
    odometry.Apply(correction);
  }
}

/// Somebody who walks straight on through the rendered room, as the camera of frame k sees him: a
/// centimetre of noise, three in depth.
HumanMeasurement Walker(int id, const Eigen::Vector3d& start_W, const Eigen::Vector3d& v_W, int k,
                        int place) {
  std::mt19937_64 random(static_cast<std::uint64_t>(1000 * id + k));
  std::normal_distribution<double> normal;
  const Eigen::Vector3d sigma_m(0.01, 0.01, 0.03);
  HumanMeasurement person;
  person.id = HumanId{id};
  for (const int joint : kBodyJoints) {
    const Eigen::Vector3d offset(0.1 * (joint % 3 - 1), joint < 8 ? -0.5 : 0, 0.05 * (joint % 2));
    const Eigen::Vector3d noise{normal(random), normal(random), normal(random)};
    person.joints.push_back({joint,
                             Truth(place).inverse() * (start_W + kFrameStep_s * k * v_W + offset) +
                                 sigma_m.cwiseProduct(noise),
                             sigma_m.cwiseAbs2().asDiagonal()});
  }
  return person;
}

/// Frame `k`, in which the camera stands where it stood in frame `place` of the walk.
StereoImagePair PeopleFrame(int k, int place) {
  StereoImagePair images = Frame(place);
  images.id = FrameId{k};
  images.time_s = kFrameStep_s * k;
  images.people = {Walker(1, {-1, 0, 4}, {0.8, 0, 0.3}, k, place),
                   Walker(2, {1.2, 0, 5}, {0, 0, -0.5}, k, place),
                   Walker(3, {0.2, 0.1, 6}, {-0.6, 0, 0.5}, k, place)};
  return images;
}

TEST(VisualOdometry, PeopleCarryTheCameraThroughFramesThatSeeNothingElse) {
  // For a second nothing static is seen, and in the middle of it the camera turns back.
  constexpr int kCount = 22;
  const auto is_hidden = [](int k) { return k >= 10 && k < 20; };
  const auto place_of = [](int k) { return k <= 12 ? k : 24 - k; };
  const auto run = [&](bool has_people) {
    return RunAll(
        [&](int k) {
          StereoImagePair images = PeopleFrame(k, place_of(k));
          if (!has_people) images.people.clear();
          if (is_hidden(k))
            images.mask = cv::Mat(kCamera.height, kCamera.width, CV_8UC1, cv::Scalar(255));
          return images;
        },
        kCount);
  };
  const std::vector<OdometryFrame> with = run(true);
  const std::vector<OdometryFrame> without = run(false);
  for (int k = 1; k < kCount; ++k) {
    const OdometryFrame& frame = with[static_cast<std::size_t>(k)];
    EXPECT_EQ(frame.state, is_hidden(k) ? TrackingState::kCoasting : TrackingState::kTracking);
    // Whether the static scene is enough is known from the frame before.
    EXPECT_EQ(frame.num_people, k > 10 && is_hidden(k) ? 3 : 0) << "frame " << k;
    EXPECT_EQ(without[static_cast<std::size_t>(k)].num_people, 0);
    if (!is_hidden(k)) ExpectNear(frame, Truth(place_of(k)), k);
  }
  // Other noise on the people gives 0.05 to 0.2 m and 5 to 50 mrad, against 0.54 m and 230 mrad.
  const Se3 truth = Truth(place_of(19));
  const double with_m = PositionError_m(with[19].T_W_C, truth);
  const double without_m = PositionError_m(without[19].T_W_C, truth);
  RecordProperty("with_mm", static_cast<int>(1000 * with_m));
  RecordProperty("without_mm", static_cast<int>(1000 * without_m));
  EXPECT_LT(with_m, 0.45 * without_m);
  EXPECT_LT(RotationError_rad(with[19].T_W_C, truth),
            0.45 * RotationError_rad(without[19].T_W_C, truth));
}

TEST(VisualOdometry, WherePeopleAreNotNeededTheyChangeNothing) {
  const std::vector<OdometryFrame> with = RunAll([](int k) { return PeopleFrame(k, k); }, 10);
  const std::vector<OdometryFrame> without = RunAll(Frame, 10);
  for (std::size_t k = 0; k < with.size(); ++k) {
    EXPECT_EQ(with[k].num_people, 0) << "frame " << k;
    // In frame 1, of which the frame before says nothing yet, people have a say in where landmarks
    // are looked for: the same ones are found, and the pose is the same but for the last steps of
    // its iteration.
    EXPECT_LT(Boxminus(with[k].T_W_C, without[k].T_W_C).norm(), 2e-5) << "frame " << k;
  }
}

TEST(VisualOdometry, TheCarrierIsLearned) {
  // By how much the velocity may change a frame starts wide and closes in on three times what the
  // path's velocity usually changes by: 2 mm and 2 mrad a frame.
  VisualOdometryOptions options;
  options.motion.linear_start_m_s2 = 20;
  options.motion.linear_floor_m_s2 = 0.01;
  options.motion.angular_start_rad_s2 = 20;
  options.motion.angular_floor_rad_s2 = 0.01;
  VisualOdometry odometry(options);
  std::vector<OdometryFrame> frames;
  for (int k = 0; k < kNumFrames; ++k) frames.push_back(odometry.Process(kCamera, Frame(k)));
  std::vector<double> changes_m;
  std::vector<double> changes_rad;
  for (int k = 2; k < kNumFrames; ++k) {
    const Vector6d change = Boxminus(Truth(k), Truth(k - 1)) - Boxminus(Truth(k - 1), Truth(k - 2));
    changes_m.push_back(change.head<3>().norm());
    changes_rad.push_back(change.tail<3>().norm());
  }
  std::sort(changes_m.begin(), changes_m.end());
  std::sort(changes_rad.begin(), changes_rad.end());
  const double change_m = changes_m[changes_m.size() / 2];
  const double change_rad = changes_rad[changes_rad.size() / 2];
  RecordProperty("change_um", static_cast<int>(1e6 * change_m));
  RecordProperty("change_urad", static_cast<int>(1e6 * change_rad));
  const double step2_s2 = kFrameStep_s * kFrameStep_s;
  EXPECT_NEAR(frames[1].prior_sigma_position_m, 20 * step2_s2, 1e-9);
  EXPECT_NEAR(frames[1].prior_sigma_orientation_rad, 20 * step2_s2, 1e-9);
  // What the filter sees is the true change and the errors of three poses.
  EXPECT_GT(frames.back().prior_sigma_position_m, 1.5 * change_m);
  EXPECT_LT(frames.back().prior_sigma_position_m, 3 * change_m + 3 * kMaxPositionError_m);
  EXPECT_GT(frames.back().prior_sigma_orientation_rad, 1.5 * change_rad);
  EXPECT_LT(frames.back().prior_sigma_orientation_rad, 3 * change_rad + 3 * kMaxRotationError_rad);
}

}  // namespace
}  // namespace airdos
