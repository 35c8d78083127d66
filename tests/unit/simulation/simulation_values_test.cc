// The simulated world is what its options say: how it moves, how it is measured, with which noise.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>
#include <vector>

#include "common/simulation/feature_simulator.h"
#include "common/simulation/moving_object.h"
#include "common/simulation/settings.h"

namespace airdos {
namespace {

constexpr double kRadPerDeg = M_PI / 180;

SimulationOptions Options() {
  SimulationOptions options;
  options.seed = 21;
  options.num_frames = 200;
  options.camera = {640, 360, 400, 420, 310, 170, 0.25};
  options.path.speed_m_s = 0.7;
  options.static_per_frame = 12;
  return options;
}

/// Mean of the squares, which should be sigma^2: within four standard errors.
void ExpectSigma(const std::vector<double>& values, double sigma) {
  double sum = 0;
  for (const double value : values) sum += value * value;
  const auto num = static_cast<double>(values.size());
  EXPECT_NEAR(sum / num / (sigma * sigma), 1, 4 * std::sqrt(2 / num));
}

TEST(SimulationValuesTest, TheOdometryErrsStepByStep) {
  SimulationOptions options = Options();
  options.odometry_sigma_m = 0.03;
  options.odometry_sigma_deg = 0.8;
  options.num_frames = 400;
  const SimulatedSequence sequence = Simulate(options);
  std::vector<double> metres, radians;
  for (std::size_t k = 1; k < sequence.frames.size(); ++k) {
    const SimulatedFrame& before = sequence.frames[k - 1];
    const SimulatedFrame& now = sequence.frames[k];
    const Vector6d error = Boxminus(before.T_W_C_odometry.inverse() * now.T_W_C_odometry,
                                    before.T_W_C.inverse() * now.T_W_C);
    for (int i = 0; i < 3; ++i) {
      metres.push_back(error[i]);
      radians.push_back(error[3 + i]);
    }
  }
  ExpectSigma(metres, 0.03);
  ExpectSigma(radians, 0.8 * kRadPerDeg);
}

TEST(SimulationValuesTest, TheCameraWalksAtItsSpeed) {
  const SimulatedSequence sequence = Simulate(Options());
  for (std::size_t k = 1; k < sequence.frames.size(); ++k) {
    const Eigen::Vector3d step =
        sequence.frames[k].T_W_C.translation - sequence.frames[k - 1].T_W_C.translation;
    EXPECT_NEAR(std::hypot(step.x(), step.z()), 0.07, 1e-9);
    EXPECT_GT(step.z(), 0);
    EXPECT_LE(std::abs(sequence.frames[k].T_W_C.translation.y()), 0.04 + 1e-12);
    EXPECT_NEAR(sequence.frames[k].time_s, 0.1 * static_cast<double>(k), 1e-9);
  }
}

TEST(SimulationValuesTest, MeasurementsInMetresAreSeenWhereTheyAreMeasured) {
  SimulationOptions options = Options();
  options.point_sigma_m = 0.2;
  options.objects = {{true, Behaviour::kCruise, 2, 14}};
  const SimulatedSequence sequence = Simulate(options);
  for (const SimulatedFrame& frame : sequence.frames) {
    for (const auto* points : {&frame.static_points, &frame.object_points}) {
      for (const SimulatedMeasurement& seen : *points)
        ASSERT_LT((options.camera.ProjectStereo(seen.p_C) - seen.uvu_px).norm(), 1e-9);
    }
  }
}

TEST(SimulationValuesTest, MeasurementsInPixelsAreTriangulated) {
  SimulationOptions options = Options();
  options.has_point_noise = false;
  options.pixel_sigma_px = 0.6;
  options.farthest_m = 10;
  const SimulatedSequence sequence = Simulate(options);
  std::vector<double> errors;
  for (const SimulatedFrame& frame : sequence.frames) {
    for (const SimulatedMeasurement& seen : frame.static_points) {
      const Eigen::Vector3d p_C =
          frame.T_W_C.inverse() * sequence.landmarks_W[static_cast<std::size_t>(seen.index)];
      const Eigen::Vector3d error = seen.uvu_px - options.camera.ProjectStereo(p_C);
      for (int i = 0; i < 3; ++i) errors.push_back(error[i]);
      ASSERT_LT((options.camera.ProjectStereo(seen.p_C) - seen.uvu_px).norm(), 1e-9);
    }
  }
  ExpectSigma(errors, 0.6);
}

bool IsVisible(const SimulationOptions& options, const Se3& T_W_C, const Eigen::Vector3d& p_W) {
  const Eigen::Vector3d p_C = T_W_C.inverse() * p_W;
  if (p_C.z() < options.nearest_m || p_C.z() > options.farthest_m) return false;
  const Eigen::Vector3d uvu = options.camera.ProjectStereo(p_C);
  return options.camera.IsInImage(uvu.head<2>()) && uvu.z() >= 0;
}

// Nothing is measured that is too near, too far or beyond an image; and no new landmark is taken
// while one from before could be.
TEST(SimulationValuesTest, KnownLandmarksComeFirstAndAllAreInView) {
  SimulationOptions options = Options();
  options.path.min_pan_deg = options.path.max_pan_deg = 9;
  options.path.pan_limit_deg = 40;
  options.path.speed_m_s = 0.3;
  options.nearest_m = 3;
  options.farthest_m = 12;
  const SimulatedSequence sequence = Simulate(options);
  std::set<int> known;
  int num_again = 0;
  std::set<int> last;
  for (const SimulatedFrame& frame : sequence.frames) {
    std::set<int> now;
    bool has_new = false;
    for (const SimulatedMeasurement& seen : frame.static_points) {
      const auto& p_W = sequence.landmarks_W[static_cast<std::size_t>(seen.index)];
      ASSERT_TRUE(IsVisible(options, frame.T_W_C, p_W));
      now.insert(seen.index);
      has_new = has_new || known.count(seen.index) == 0;
      num_again += known.count(seen.index) > 0 && last.count(seen.index) == 0 ? 1 : 0;
    }
    for (const int landmark : known) {
      const bool could_be =
          IsVisible(options, frame.T_W_C, sequence.landmarks_W[static_cast<std::size_t>(landmark)]);
      ASSERT_TRUE(!has_new || !could_be || now.count(landmark) > 0);
    }
    known.insert(now.begin(), now.end());
    last = std::move(now);
  }
  EXPECT_GT(num_again, 20) << "or the last check said nothing";
}

/// Direction of a line between two points over the ground.
double Bearing(const MovingObject& object, std::size_t k, std::size_t a, std::size_t b) {
  const Eigen::Vector3d line = object.points_W[k][b] - object.points_W[k][a];
  return std::atan2(-line.z(), line.x());
}

double Unwrapped(double angle_rad) { return std::remainder(angle_rad, 2 * M_PI); }

TEST(SimulationValuesTest, BoxesTurnSteadilyAndPeopleOnlySway) {
  SimulationOptions options = Options();
  options.num_frames = 60;
  options.object_acceleration_m_s2 = 0;
  options.objects = {{true, Behaviour::kCruise, 3, 14}, {false, Behaviour::kCruise, 3, 8}};
  const SimulatedSequence sequence = Simulate(options);
  double fastest_turn_rad = 0;
  for (const MovingObject& object : sequence.objects) {
    if (object.is_person) {
      // The sway is 0.1 of the swing, 0.6 rad at most.
      for (std::size_t k = 1; k < 60; ++k) {
        EXPECT_LT(std::abs(Unwrapped(Bearing(object, k, 8, 11) - Bearing(object, 0, 8, 11))), 0.13);
      }
      continue;
    }
    const double first_rad = Unwrapped(Bearing(object, 1, 0, 1) - Bearing(object, 0, 0, 1));
    for (std::size_t k = 1; k < 60; ++k) {
      const double turn_rad = Unwrapped(Bearing(object, k, 0, 1) - Bearing(object, k - 1, 0, 1));
      EXPECT_NEAR(turn_rad, first_rad, 1e-9);
    }
    fastest_turn_rad = std::max(fastest_turn_rad, std::abs(first_rad));
  }
  EXPECT_GT(fastest_turn_rad, 0.001);
  EXPECT_LE(fastest_turn_rad, 0.01 + 1e-9);  // 0.1 rad/s
}

// The camera is carried 1.6 m above the ground, which is y = 1.6 in W.
TEST(SimulationValuesTest, PeopleAndBoxesStandOnTheGround) {
  SimulationOptions options = Options();
  options.num_frames = 40;
  options.objects = {{true, Behaviour::kCruise, 4, 14}, {false, Behaviour::kCruise, 4, 30}};
  const SimulatedSequence sequence = Simulate(options);
  for (const MovingObject& object : sequence.objects) {
    double lowest = -10, highest = 10;
    for (const Eigen::Vector3d& p_W : object.points_W[20]) {
      lowest = std::max(lowest, p_W.y());
      highest = std::min(highest, p_W.y());
    }
    if (object.is_person) {
      EXPECT_NEAR(lowest, 1.6, 0.2) << "feet";
      EXPECT_NEAR(highest, 0, 0.25) << "nose";
    } else {
      EXPECT_NEAR(0.5 * (lowest + highest), 0.7, 0.05) << "middle of a box, 0.9 m above the ground";
    }
  }
}

// The order of draws is the code's and not the compiler's: one sequence for a seed, wherever it is
// made.
TEST(SimulationValuesTest, ALandmarkIsDrawnByDepthRowAndColumn) {
  const SimulationOptions options = Options();
  Random random(options.seed);
  for (int i = 0; i < 5; ++i) random.Uniform(0, 1);  // the camera's path
  const double z = random.Uniform(options.nearest_m, options.farthest_m);
  const double v_px = random.Uniform(-0.2, 1.2) * 360;
  const double u_px = random.Uniform(-0.2, 1.2) * 640;
  const Eigen::Vector3d expected((u_px - 310) / 400 * z, (v_px - 170) / 420 * z, z);
  EXPECT_LT((Simulate(options).landmarks_W.at(0) - expected).norm(), 1e-9);
}

TEST(SimulationValuesTest, ABoxIsDrawnByLengthHeightAndWidth) {
  Random random(7), same(7);
  const auto points_W = MakeBox({RootState()}, 3, &random).points_W.at(0);
  const double length_m = same.Uniform(0.5, 0.9);  // z; each point lies on the next pair of sides
  const double height_m = same.Uniform(0.5, 0.9);
  const double width_m = same.Uniform(0.5, 1.25);
  EXPECT_NEAR(std::abs(points_W[0].x()), width_m, 1e-12);
  EXPECT_NEAR(std::abs(points_W[1].y()), height_m, 1e-12);
  EXPECT_NEAR(std::abs(points_W[2].z()), length_m, 1e-12);
}

RootMotion Walking() {
  RootMotion motion;
  motion.velocity_W_m_s = {0.8, 0, -0.6};  // heading atan2(0.6, 0.8)
  motion.acceleration_m_s2 = 0;
  return motion;
}

TEST(RootMotionTest, ACruiserGoesWhereItsVelocityPoints) {
  Random random(1);
  const auto path = SimulateRoot(Walking(), 30, 0.1, &random);
  for (std::size_t k = 0; k < path.size(); ++k) {
    const double time_s = 0.1 * static_cast<double>(k);
    EXPECT_LT((path[k].position_W - time_s * Eigen::Vector3d(0.8, 0, -0.6)).norm(), 1e-9);
    EXPECT_NEAR(path[k].heading_rad, std::atan2(0.6, 0.8), 1e-12);
    EXPECT_NEAR(path[k].speed_m_s, 1, 1e-12);
    EXPECT_EQ(path[k].sitting, 0);
  }
}

TEST(RootMotionTest, ATurnIsSteadyAndMovesAlong) {
  RootMotion motion = Walking();
  motion.turn_rad_s = 0.3;
  Random random(1);
  const auto path = SimulateRoot(motion, 50, 0.1, &random);
  for (std::size_t k = 1; k < path.size(); ++k) {
    EXPECT_NEAR(path[k].heading_rad - path[k - 1].heading_rad, 0.03, 1e-12);
    const Eigen::Vector3d step = path[k].position_W - path[k - 1].position_W;
    EXPECT_NEAR(std::atan2(-step.z(), step.x()), path[k - 1].heading_rad, 1e-9);
  }
}

// A push of sigma a for a step dt, remembered by exp(-dt / memory): the variance settles at
// (a dt)^2 / (1 - exp(-2 dt / memory)); neighbours in time correlate by exp(-dt / memory).
TEST(RootMotionTest, PushesFadeWithTheirMemoryAndStayOnTheGround) {
  RootMotion motion = Walking();
  motion.acceleration_m_s2 = 0.5;
  motion.velocity_memory_s = 0.8;
  Random random(3);
  const auto path = SimulateRoot(motion, 4000, 0.1, &random);
  std::vector<Eigen::Vector3d> deviation_m_s;
  for (std::size_t k = 1; k < path.size(); ++k) {
    EXPECT_EQ(path[k].position_W.y(), 0);
    deviation_m_s.push_back((path[k].position_W - path[k - 1].position_W) / 0.1 -
                            Eigen::Vector3d(0.8, 0, -0.6));
  }
  const double keep = std::exp(-0.1 / 0.8);
  const double variance = 0.05 * 0.05 / (1 - keep * keep);
  for (const int axis : {0, 2}) {
    double squares = 0, products = 0;
    for (std::size_t k = 100; k < deviation_m_s.size(); ++k) {
      squares += deviation_m_s[k][axis] * deviation_m_s[k][axis];
      products += deviation_m_s[k][axis] * deviation_m_s[k - 1][axis];
    }
    const auto num = static_cast<double>(deviation_m_s.size() - 100);
    // Neighbours correlate: about num * (1 - keep^2) / (1 + keep^2) of the squares are independent.
    const double error = 4 * std::sqrt(2 / (num * (1 - keep * keep) / (1 + keep * keep)));
    EXPECT_NEAR(squares / num / variance, 1, error);
    EXPECT_NEAR(products / squares, keep, 0.05);
  }
}

TEST(RootMotionTest, WhoStopsWalksOn) {
  RootMotion motion = Walking();
  motion.behaviour = Behaviour::kStop;
  for (const std::uint32_t seed : {1u, 2u, 3u}) {
    Random random(seed);
    const auto path = SimulateRoot(motion, 100, 0.1, &random);
    double slowest = 1;
    for (const RootState& state : path) {
      EXPECT_GE(state.speed_m_s, -1e-12);
      EXPECT_LE(state.speed_m_s, 1 + 1e-12);
      slowest = std::min(slowest, state.speed_m_s);
    }
    EXPECT_LT(slowest, 1e-9);
    EXPECT_NEAR(path.front().speed_m_s, 1, 1e-12);
    EXPECT_NEAR(path.back().speed_m_s, 1, 1e-12);
  }
}

TEST(RootMotionTest, WhoTurnsHasTurnedByThirdsOfACircleAndWhoSitsStaysSeated) {
  RootMotion motion = Walking();
  motion.behaviour = Behaviour::kTurn;
  Random random(5);
  const auto turned = SimulateRoot(motion, 100, 0.1, &random);
  const double turn_rad = std::abs(turned.back().heading_rad - turned.front().heading_rad);
  EXPECT_GE(turn_rad, M_PI / 3);
  EXPECT_LE(turn_rad, 2 * M_PI / 3);
  motion.behaviour = Behaviour::kSit;
  const auto seated = SimulateRoot(motion, 100, 0.1, &random);
  EXPECT_EQ(seated.front().sitting, 0);
  EXPECT_EQ(seated.back().sitting, 1);
  EXPECT_NEAR(seated.back().speed_m_s, 0, 1e-12);
}

TEST(SettingsTest, TheGroupsStartWithThePapersErrors) {
  const double sigma_m[] = {0.092, 0.102, 0.122, 0.111};
  const double sigma_deg[] = {0.283, 0.366, 0.635, 0.458};
  for (std::size_t i = 0; i < 4; ++i) {
    const SimulationOptions options = SettingByName(PaperGroups()[i], 17);
    EXPECT_EQ(options.odometry_sigma_m, sigma_m[i]);
    EXPECT_EQ(options.odometry_sigma_deg, sigma_deg[i]);
    EXPECT_EQ(options.seed, 17u);
    EXPECT_TRUE(options.has_point_noise);
    EXPECT_EQ(options.point_sigma_m, 0.05);
  }
}

TEST(SettingsTest, TheWalkersAreThoseOfTheirName) {
  const struct {
    const char* name;
    Behaviour behaviour;
    int num_static, num_behaving;
    double acceleration_m_s2;
  } settings[] = {
      {"walkers4", Behaviour::kCruise, 4, 0, 0.2}, {"turn8", Behaviour::kTurn, 8, 6, 0.2},
      {"stop30", Behaviour::kStop, 30, 6, 0.2},    {"sit30", Behaviour::kSit, 30, 6, 0.2},
      {"swap8", Behaviour::kSwapped, 8, 6, 0.2},   {"erratic30", Behaviour::kCruise, 30, 0, 2}};
  for (const auto& setting : settings) {
    SCOPED_TRACE(setting.name);
    const SimulationOptions options = SettingByName(setting.name, 1);
    EXPECT_EQ(options.static_per_frame, setting.num_static);
    EXPECT_EQ(options.object_acceleration_m_s2, setting.acceleration_m_s2);
    EXPECT_EQ(options.odometry_sigma_m, 0.05);
    EXPECT_EQ(options.odometry_sigma_deg, 0.5);
    EXPECT_FALSE(options.has_point_noise);
    ASSERT_EQ(options.objects.size(), 2u);
    EXPECT_EQ(options.objects[0].count, 10 - setting.num_behaving);
    EXPECT_EQ(options.objects[0].behaviour, Behaviour::kCruise);
    EXPECT_EQ(options.objects[1].count, setting.num_behaving);
    EXPECT_EQ(options.objects[1].behaviour, setting.behaviour);
  }
}

}  // namespace
}  // namespace airdos
