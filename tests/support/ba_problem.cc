#include "tests/support/ba_problem.h"

#include <algorithm>
#include <fstream>
#include <limits>
#include <map>
#include <memory>
#include <set>
#include <sstream>
#include <utility>
#include <vector>

#include "common/util/error.h"

namespace airdos {
namespace {

/// The object's points are numbered consecutively over the frames: within a frame, a point's number
/// is that of the model's point.
struct DynamicPoint {
  int frame = 0;
  int number = 0;
};

class Reader {
 public:
  explicit Reader(const std::string& path) : path_(path) {}

  BaProblem Read() {
    std::ifstream file(path_);
    if (!file) throw InputError(path_ + ": cannot be read");
    std::string line;
    for (int number = 1; std::getline(file, line); ++number) {
      std::istringstream words(line);
      std::string kind;
      words >> kind;
      Take(kind, &words);
      if (!words) throw InputError(path_ + ": line " + std::to_string(number) + " is damaged");
    }
    Finish();
    return std::move(result_);
  }

 private:
  using Words = std::istringstream;

  static Eigen::Vector3d Vector(Words* words) {
    Eigen::Vector3d v = Eigen::Vector3d::Zero();
    *words >> v.x() >> v.y() >> v.z();
    return v;
  }
  static Se3 Pose(Words* words) {
    const Eigen::Vector3d t = Vector(words);
    double x = 0, y = 0, z = 0, w = 1;
    *words >> x >> y >> z >> w;
    return {Eigen::Quaterniond(w, x, y, z).normalized(), t};
  }

  void Take(const std::string& kind, Words* words) {
    BundleProblem& problem = result_.problem;
    if (kind == "SIGMA") {
      *words >> sigma_m_ >> result_.options.rigidity_sigma_m >> motion_sigma_m_;
    } else if (kind == "POSE") {
      int k = 0;
      *words >> k;
      problem.frames.push_back({FrameId{k}, static_cast<double>(k), Pose(words), k == 0});
    } else if (kind == "POINT") {
      TakePoint(words);
    } else if (kind == "OBS") {
      TakeObservation(words);
    } else if (kind == "SEG") {
      int segment = 0;
      double length_m = 0;
      *words >> segment >> length_m;
      lengths_m_[segment] = length_m;
    } else if (kind == "RIG") {
      int segment = 0, i = 0, j = 0;
      *words >> segment >> i >> j;
      segments_[segment] = {dynamic_.at(i).number, dynamic_.at(j).number};
    } else if (kind == "MOTION") {
      int m = 0;
      *words >> m;
      motion_W_ = Pose(words);
    } else if (kind == "MOT") {
      int m = 0, i = 0;
      *words >> m >> i;
      moving_.insert(dynamic_.at(i).number);
    }
  }

  void TakePoint(Words* words) {
    int i = 0, frame = 0;
    char kind = 'S';
    *words >> i >> kind >> frame;
    start_W_[i] = Vector(words);
    if (kind == 'S') {
      landmark_[i] = static_cast<int>(result_.problem.landmarks.size());
      result_.problem.landmarks.push_back({LandmarkId{i}, start_W_[i], false});
    } else {
      dynamic_[i] = {frame, num_in_frame_[frame]++};
    }
  }

  void TakeObservation(Words* words) {
    int k = 0, i = 0;
    *words >> k >> i;
    const BundleProblem::PointMeasurement point{Vector(words), sigma_m_};
    const auto landmark = landmark_.find(i);
    if (landmark != landmark_.end()) {
      result_.problem.observations.push_back(
          {k, landmark->second, Eigen::Vector3d::Zero(), true, 1, false, point});
      return;
    }
    joints_.push_back({k, dynamic_.at(i).number, start_W_.at(i), Eigen::Vector3d::Zero(),
                       Eigen::Matrix3d::Identity(), false, point});
  }

  void Finish() {
    auto model = std::make_shared<ArticulatedModel>();
    for (const auto& [frame, num] : num_in_frame_) {
      model->num_points = std::max(model->num_points, num);
    }
    for (const auto& [segment, points] : segments_) {
      model->segments.push_back({points.first, points.second});
    }
    model->parts.emplace_back(moving_.begin(), moving_.end());
    if (!model->IsValid()) throw InputError(path_ + ": points that do not exist");

    BundleProblem::Human object;
    object.model = model;
    object.motion_form = MotionForm::kSe3Track;
    object.motion_noise = MotionNoise{motion_sigma_m_, 1.0, 1.0};
    object.start_motions = {{0, 0, Eigen::Vector3d::Zero(), motion_W_}};
    object.segment_length_m.clear();
    for (const auto& [segment, length_m] : lengths_m_) object.segment_length_m.push_back(length_m);
    object.known_length_m.assign(object.segment_length_m.size(), std::nullopt);
    std::stable_sort(joints_.begin(), joints_.end(), [](const auto& a, const auto& b) {
      return std::make_pair(a.frame, a.joint) < std::make_pair(b.frame, b.joint);
    });
    object.joints = std::move(joints_);
    result_.problem.humans.push_back(std::move(object));

    BundleOptions& options = result_.options;
    options.compute_covariance = false;
    options.max_iterations = 200;
    options.max_iterations_after_rejection = 0;
    options.function_tolerance = 1e-6;
    options.huber_static_sigmas = options.huber_dynamic_sigmas = 1e9;
    options.motion_max_gap_s = std::numeric_limits<double>::infinity();
    options.person_speed_m_s = 0;
  }

  std::string path_;
  BaProblem result_;
  double sigma_m_ = 1;
  double motion_sigma_m_ = 1;
  Se3 motion_W_;
  std::map<int, int> landmark_;  // index in the problem, by number in the file; likewise below
  std::map<int, DynamicPoint> dynamic_;
  std::map<int, Eigen::Vector3d> start_W_;
  std::map<int, int> num_in_frame_;
  std::map<int, double> lengths_m_;
  std::map<int, std::pair<int, int>> segments_;
  std::set<int> moving_;
  std::vector<BundleProblem::JointState> joints_;
};

}  // namespace

BaProblem ReadBaProblem(const std::string& path) { return Reader(path).Read(); }

}  // namespace airdos
