#include "common/simulation/feature_simulator.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <string>

#include "common/util/error.h"

namespace airdos {
namespace {

constexpr double kCameraHeight_m = 1.6;
constexpr double kHipHeight_m = 0.87;
constexpr double kBoxHeight_m = 0.9;
constexpr int kMaxTrials = 300;
constexpr double kRadPerDeg = M_PI / 180;

void Check(const SimulationOptions& options) {
  const auto require = [](bool is_good, const std::string& what) {
    if (!is_good) throw InputError("simulation: " + what);
  };
  require(options.num_frames >= 2, "needs at least two frames");
  require(options.step_s > 0, "the time step must be positive");
  require(options.camera.IsValid(), "the camera is invalid");
  require(0 < options.nearest_m && options.nearest_m < options.farthest_m, "invalid depth limits");
  require(options.static_per_frame >= 0, "a negative number of static points");
  require(options.point_sigma_m >= 0 && options.pixel_sigma_px >= 0, "a negative sigma");
  for (const ObjectGroup& group : options.objects) {
    const bool is_good = group.count >= 0 && group.num_points >= 4 &&
                         (!group.is_person || (group.num_points >= 14 && group.num_points <= 18));
    require(is_good, "a person has 14 to 18 points, another object at least 4");
  }
}

/// The error-free measurement; nothing if the point is out of view.
std::optional<Eigen::Vector3d> Look(const SimulationOptions& options, const Se3& T_W_C,
                                    const Eigen::Vector3d& p_W) {
  const Eigen::Vector3d p_C = T_W_C.inverse() * p_W;
  if (p_C.z() < options.nearest_m || p_C.z() > options.farthest_m) return std::nullopt;
  const Eigen::Vector3d uvu_px = options.camera.ProjectStereo(p_C);
  if (!options.camera.IsInImage(uvu_px.head<2>()) || uvu_px.z() < 0) return std::nullopt;
  return p_C;
}

std::optional<SimulatedMeasurement> Measure(const SimulationOptions& options, const Se3& T_W_C,
                                            const Eigen::Vector3d& p_W, Random* random) {
  const std::optional<Eigen::Vector3d> p_C = Look(options, T_W_C, p_W);
  if (!p_C) return std::nullopt;
  SimulatedMeasurement measurement;
  if (options.has_point_noise) {
    measurement.p_C = *p_C + random->Normal3(options.point_sigma_m);
    measurement.uvu_px = options.camera.ProjectStereo(measurement.p_C);
    return measurement;
  }
  measurement.uvu_px = options.camera.ProjectStereo(*p_C) + random->Normal3(options.pixel_sigma_px);
  const Eigen::Vector3d& uvu_px = measurement.uvu_px;
  const auto measured_C = options.camera.Triangulate(uvu_px.x(), uvu_px.y(), uvu_px.z());
  if (!measured_C) return std::nullopt;
  measurement.p_C = *measured_C;
  return measurement;
}

class Simulator {
 public:
  explicit Simulator(const SimulationOptions& options) : options_(options), random_(options.seed) {}

  SimulatedSequence Run() {
    sequence_.options = options_;
    MoveCamera();
    ScatterLandmarks();
    PlaceObjects();
    for (SimulatedFrame& frame : sequence_.frames) {
      ObserveLandmarks(&frame);
      ObserveObjects(&frame);
    }
    AddOdometry();
    return std::move(sequence_);
  }

 private:
  void MoveCamera();
  void ScatterLandmarks();
  void PlaceObjects();
  MovingObject PlaceObject(const ObjectGroup& group);
  MovingObject TryObject(const ObjectGroup& group);
  double SeenShare(const MovingObject& object) const;
  void ObserveLandmarks(SimulatedFrame* frame);
  void ObserveObjects(SimulatedFrame* frame);
  void AddOdometry();

  const SimulationOptions& options_;
  Random random_;
  SimulatedSequence sequence_;
  std::set<int> in_map_;      // landmarks that have been measured before
  std::vector<int> tracked_;  // landmarks of the last frame
};

void Simulator::MoveCamera() {
  const CameraPath& path = options_.path;
  const double curve_rad_s = random_.Uniform(-path.curve_rad_s, path.curve_rad_s);
  const double pitch_rad = 0.25 * path.curve_rad_s * random_.Sign();
  const double wave_rad_s = random_.Uniform(1.0, 2.0);
  const double pan_rad = kRadPerDeg * random_.Uniform(path.min_pan_deg, path.max_pan_deg);
  double pan_sign = random_.Sign();
  double panned_rad = 0;
  Eigen::Vector3d position_W = Eigen::Vector3d::Zero();
  for (int i = 0; i < options_.num_frames; ++i) {
    const double time_s = i * options_.step_s;
    const double heading_rad = curve_rad_s * time_s;
    SimulatedFrame frame;
    frame.time_s = time_s;
    frame.T_W_C.rotation = ExpSo3({0, heading_rad + panned_rad, 0}) *
                           ExpSo3({pitch_rad * std::sin(wave_rad_s * time_s), 0,
                                   0.5 * pitch_rad * std::sin(1.7 * wave_rad_s * time_s)});
    frame.T_W_C.translation = position_W;
    frame.T_W_C.translation.y() += 0.02 * (1 - std::cos(2 * wave_rad_s * time_s));
    sequence_.frames.push_back(frame);
    position_W += options_.step_s * path.speed_m_s *
                  Eigen::Vector3d(std::sin(heading_rad), 0, std::cos(heading_rad));
    if (std::abs(panned_rad + pan_sign * pan_rad) > kRadPerDeg * path.pan_limit_deg) {
      pan_sign = -pan_sign;
    }
    panned_rad += pan_sign * pan_rad;
  }
}

/// Enough landmarks that every frame sees more than it may use.
void Simulator::ScatterLandmarks() {
  const int per_frame = 20 + 12 * options_.static_per_frame;
  for (std::size_t i = 0; i < sequence_.frames.size(); i += 4) {
    const Se3& T_W_C = sequence_.frames[i].T_W_C;
    for (int k = 0; k < per_frame / 4; ++k) {
      const double z = random_.Uniform(options_.nearest_m, options_.farthest_m);
      const StereoCamera& camera = options_.camera;
      const double v_px = random_.Uniform(-0.2, 1.2) * camera.height;
      const double u_px = random_.Uniform(-0.2, 1.2) * camera.width;
      const Eigen::Vector3d p_C((u_px - camera.cx_px) / camera.fx_px * z,
                                (v_px - camera.cy_px) / camera.fy_px * z, z);
      sequence_.landmarks_W.push_back(T_W_C * p_C);
    }
  }
}

MovingObject Simulator::TryObject(const ObjectGroup& group) {
  const Se3& T_W_C = sequence_.frames[sequence_.frames.size() / 2].T_W_C;
  const double z = random_.Uniform(options_.object_nearest_m, options_.object_farthest_m);
  Eigen::Vector3d middle_W;
  if (options_.path.max_pan_deg > 0) {  // all around the area that the camera pans over
    const double limit_rad = kRadPerDeg * options_.path.pan_limit_deg;
    const double bearing_rad = random_.Uniform(-limit_rad, limit_rad);
    middle_W =
        T_W_C.translation + z * Eigen::Vector3d(std::sin(bearing_rad), 0, std::cos(bearing_rad));
  } else {
    const double spread = 0.4 * options_.camera.width / options_.camera.fx_px;
    middle_W = T_W_C * Eigen::Vector3d(random_.Uniform(-spread, spread) * z, 0, z);
  }
  middle_W.y() = kCameraHeight_m - (group.is_person ? kHipHeight_m : kBoxHeight_m);
  RootMotion motion;
  motion.behaviour = group.behaviour;
  motion.acceleration_m_s2 = options_.object_acceleration_m_s2;
  const double direction_rad = random_.Uniform(-M_PI, M_PI);
  const double speed_m_s = random_.Uniform(0.4, 1.0) * options_.max_object_speed_m_s;
  motion.velocity_W_m_s =
      speed_m_s * Eigen::Vector3d(std::cos(direction_rad), 0, -std::sin(direction_rad));
  if (!group.is_person) motion.turn_rad_s = random_.Uniform(-0.1, 0.1);
  std::vector<RootState> root =
      SimulateRoot(motion, options_.num_frames, options_.step_s, &random_);
  const Eigen::Vector3d shift = middle_W - root[root.size() / 2].position_W;
  for (RootState& state : root) state.position_W += shift;
  MovingObject object = group.is_person
                            ? MakePerson(root, options_.step_s, group.num_points, &random_)
                            : MakeBox(root, group.num_points, &random_);
  object.behaviour = group.behaviour;
  return object;
}

double Simulator::SeenShare(const MovingObject& object) const {
  int seen = 0, all = 0;
  for (std::size_t i = 0; i < sequence_.frames.size(); ++i) {
    for (const Eigen::Vector3d& p_W : object.points_W[i]) {
      if (Look(options_, sequence_.frames[i].T_W_C, p_W)) ++seen;
      ++all;
    }
  }
  return static_cast<double>(seen) / all;
}

MovingObject Simulator::PlaceObject(const ObjectGroup& group) {
  MovingObject best;
  double best_share = -1;
  for (int trial = 0; trial < kMaxTrials && best_share < options_.min_seen_share; ++trial) {
    MovingObject object = TryObject(group);
    const double share = SeenShare(object);
    if (share > best_share) {
      best = std::move(object);
      best_share = share;
    }
  }
  return best;
}

void Simulator::PlaceObjects() {
  for (const ObjectGroup& group : options_.objects) {
    for (int i = 0; i < group.count; ++i) sequence_.objects.push_back(PlaceObject(group));
  }
  std::optional<std::size_t> first_of_pair;
  sequence_.swap_frame.assign(sequence_.objects.size(), -1);
  for (std::size_t i = 0; i < sequence_.objects.size(); ++i) {
    if (sequence_.objects[i].behaviour != Behaviour::kSwapped) continue;
    if (!first_of_pair) {
      first_of_pair = i;
      continue;
    }
    const int frame = static_cast<int>(random_.Uniform(0.3, 0.7) * options_.num_frames);
    sequence_.swap_frame[*first_of_pair] = sequence_.swap_frame[i] = frame;
    first_of_pair.reset();
  }
}

void Simulator::ObserveLandmarks(SimulatedFrame* frame) {
  // Tracked landmarks first, then those known from earlier frames, then new ones.
  std::vector<int> order = tracked_;
  for (const int landmark : in_map_) order.push_back(landmark);
  const int num_landmarks = static_cast<int>(sequence_.landmarks_W.size());
  const int first = num_landmarks > 0 ? static_cast<int>(random_.Uniform(0, num_landmarks)) : 0;
  for (int i = 0; i < num_landmarks; ++i) order.push_back((first + i) % num_landmarks);

  std::set<int> tried;
  tracked_.clear();
  for (const int landmark : order) {
    if (static_cast<int>(tracked_.size()) >= options_.static_per_frame) break;
    if (!tried.insert(landmark).second) continue;
    const Eigen::Vector3d& p_W = sequence_.landmarks_W[static_cast<std::size_t>(landmark)];
    auto measurement = Measure(options_, frame->T_W_C, p_W, &random_);
    if (!measurement) continue;
    measurement->index = landmark;
    frame->static_points.push_back(*measurement);
    tracked_.push_back(landmark);
    in_map_.insert(landmark);
  }
  std::sort(frame->static_points.begin(), frame->static_points.end(),
            [](const auto& a, const auto& b) { return a.index < b.index; });
}

void Simulator::ObserveObjects(SimulatedFrame* frame) {
  const int number = static_cast<int>(frame - sequence_.frames.data());
  for (int object = 0; object < static_cast<int>(sequence_.objects.size()); ++object) {
    const MovingObject& seen = sequence_.objects[sequence_.TrueObject(object, number)];
    const auto& points_W = seen.points_W[static_cast<std::size_t>(number)];
    for (std::size_t point = 0; point < points_W.size(); ++point) {
      auto measurement = Measure(options_, frame->T_W_C, points_W[point], &random_);
      if (!measurement) continue;
      measurement->index = static_cast<int>(point);
      measurement->object = object;
      frame->object_points.push_back(*measurement);
    }
  }
}

void Simulator::AddOdometry() {
  std::vector<SimulatedFrame>& frames = sequence_.frames;
  frames[0].T_W_C_odometry = frames[0].T_W_C;
  for (std::size_t i = 1; i < frames.size(); ++i) {
    Vector6d error;
    error << random_.Normal3(options_.odometry_sigma_m),
        random_.Normal3(kRadPerDeg * options_.odometry_sigma_deg);
    const Se3 step = frames[i - 1].T_W_C.inverse() * frames[i].T_W_C;
    frames[i].T_W_C_odometry = Boxplus(frames[i - 1].T_W_C_odometry * step, error);
  }
}

}  // namespace

std::size_t SimulatedSequence::TrueObject(int object, int frame) const {
  const auto self = static_cast<std::size_t>(object);
  if (swap_frame[self] < 0 || frame < swap_frame[self]) return self;
  std::vector<std::size_t> swapped;
  for (std::size_t i = 0; i < swap_frame.size(); ++i) {
    if (swap_frame[i] >= 0) swapped.push_back(i);
  }
  // Pairs in the order of their numbers.
  const auto place =
      static_cast<std::size_t>(std::find(swapped.begin(), swapped.end(), self) - swapped.begin());
  return swapped[place ^ 1U];
}

SimulatedSequence Simulate(const SimulationOptions& options) {
  Check(options);
  return Simulator(options).Run();
}

}  // namespace airdos
