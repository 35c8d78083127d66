#include "common/map/map_export.h"

#include <cinttypes>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <utility>

#include "common/human/skeleton.h"
#include "common/map/byte_io.h"
#include "common/util/error.h"
#include "common/util/format.h"

namespace airdos {
namespace {

namespace fs = std::filesystem;

/// A file written sequentially; Close() throws InputError if any write failed.
class OutputFile {
 public:
  explicit OutputFile(const std::string& path) : path_(path), file_(path, std::ios::binary) {
    if (!file_) throw InputError(path + ": cannot be created");
  }
  void Write(const std::string& text) { file_ << text; }
  void Write(const std::vector<std::uint8_t>& bytes) {
    file_.write(reinterpret_cast<const char*>(bytes.data()),
                static_cast<std::streamsize>(bytes.size()));
  }
  void Close() {
    file_.close();
    if (!file_) throw InputError(path_ + ": cannot be written");
  }

 private:
  std::string path_;
  std::ofstream file_;
};

/// Rows of a trajectory in order of image numbers. Readers take for granted that times increase, so
/// rows whose time does not are left out, and a comment states how many.
class TrajectoryRows {
 public:
  void Add(std::int64_t utime, const Se3& pose) {
    if (last_utime_ && utime <= *last_utime_) {
      ++num_left_out_;
      return;
    }
    last_utime_ = utime;
    rows_ += TumRow(utime, pose);
  }
  std::string Text() const {
    if (num_left_out_ == 0) return rows_;
    return "# left out: " + std::to_string(num_left_out_) +
           " poses whose time is not later than that of an earlier image\n" + rows_;
  }

 private:
  std::optional<std::int64_t> last_utime_;
  std::int64_t num_left_out_ = 0;
  std::string rows_;
};

std::string KittiRow(const Se3& pose) {
  const Eigen::Matrix4d m = pose.matrix();
  std::string row;
  for (int i = 0; i < 12; ++i) row += Format("%s%.9e", i == 0 ? "" : " ", m(i / 4, i % 4));
  return row + "\n";
}

const char* NameOfAxes(std::int8_t axes) {
  if (axes == 1) return "optical (x right, y down, z forward)";
  if (axes == 2) return "NED (x forward, y right, z down)";
  return "unknown";
}

void ExportTrajectories(const FourDMap& map, const std::string& folder,
                        std::vector<std::string>* paths) {
  const std::string names[] = {"trajectory.tum", "trajectory_live.tum", "trajectory.kitti"};
  for (const std::string& name : names) paths->push_back(folder + "/" + name);
  OutputFile refined(folder + "/" + names[0]);
  OutputFile live(folder + "/" + names[1]);
  OutputFile kitti(folder + "/" + names[2]);
  bool has_ground_truth = false;
  TrajectoryRows refined_rows;
  TrajectoryRows live_rows;
  for (const auto& [id, frame] : map.frames) {
    const std::optional<Se3> best = frame.best();
    if (best) refined_rows.Add(frame.utime, *best);
    if (best) kitti.Write(KittiRow(*best));
    if (frame.live) live_rows.Add(frame.utime, *frame.live);
    has_ground_truth |= frame.ground_truth.has_value();
  }
  refined.Write(refined_rows.Text());
  live.Write(live_rows.Text());
  refined.Close();
  live.Close();
  kitti.Close();
  if (!has_ground_truth) return;
  paths->push_back(folder + "/ground_truth.tum");
  OutputFile truth(paths->back());
  truth.Write(std::string("# axes: ") + NameOfAxes(map.ground_truth_axes) + "\n");
  TrajectoryRows truth_rows;
  for (const auto& [id, frame] : map.frames) {
    if (frame.ground_truth) truth_rows.Add(frame.utime, *frame.ground_truth);
  }
  truth.Write(truth_rows.Text());
  truth.Close();
}

void ExportPly(const FourDMap& map, const std::string& path) {
  OutputFile file(path);
  file.Write(
      "ply\nformat binary_little_endian 1.0\ncomment static landmarks in the world of the first "
      "left camera, m\nelement vertex " +
      std::to_string(map.landmarks.size()) +
      "\nproperty float x\nproperty float y\nproperty float z\nproperty float sigma_m\n"
      "property int num_observations\nend_header\n");
  ByteWriter writer;
  for (const auto& [id, landmark] : map.landmarks) {
    for (int i = 0; i < 3; ++i) writer.F32(landmark.p_W[i]);
    writer.F32(landmark.sigma_m);
    writer.U32(static_cast<std::uint32_t>(landmark.num_observations));
  }
  file.Write(writer.bytes());
  file.Close();
}

void ExportPeople(const FourDMap& map, const std::string& folder, std::vector<std::string>* paths) {
  paths->push_back(folder + "/people.jsonl");
  OutputFile lines(paths->back());
  std::map<HumanId, TrajectoryRows> tracks;
  for (const auto& [key, human] : map.humans) {
    lines.Write(HumanToJson(key.first, key.second, human) + "\n");
    const std::optional<Se3> T_W_H = TorsoPose(human);
    if (T_W_H) tracks[key.second].Add(human.utime, *T_W_H);
  }
  lines.Close();
  for (const auto& [id, rows] : tracks) {
    paths->push_back(folder + "/people/" + std::to_string(id.value) + ".tum");
    OutputFile file(paths->back());
    file.Write(rows.Text());
    file.Close();
  }
}

/// Keys stay in the order in which they are set, and numbers are the floats of the map in as few
/// digits as give the same float again.
using Json = nlohmann::basic_json<nlohmann::ordered_map, std::vector, std::string, bool,
                                  std::int64_t, std::uint64_t, float>;

Json JointsToJson(const MapHuman& human, Eigen::Vector3f MapJoint::*place) {
  Json joints = Json::object();
  for (const auto& [id, joint] : human.joints) {
    const Eigen::Vector3f& p_W = joint.*place;
    joints[std::to_string(id)] = {p_W.x(), p_W.y(), p_W.z()};
  }
  return joints;
}

}  // namespace

std::string TumRow(std::int64_t utime, const Se3& T_W_B) {
  constexpr std::int64_t kUsPerS = 1000000;
  const std::uint64_t magnitude =
      utime < 0 ? 0 - static_cast<std::uint64_t>(utime) : static_cast<std::uint64_t>(utime);
  const Eigen::Vector3d& p = T_W_B.translation;
  const Eigen::Quaterniond& q = T_W_B.rotation;
  return Format("%s%" PRIu64 ".%06" PRIu64 " %.9f %.9f %.9f %.12f %.12f %.12f %.12f\n",
                utime < 0 ? "-" : "", magnitude / kUsPerS, magnitude % kUsPerS, p.x(), p.y(), p.z(),
                q.x(), q.y(), q.z(), q.w());
}

std::optional<Se3> TorsoPose(const MapHuman& human) {
  const RigidPart& torso = kParts[kTorsoPart];
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double count = 0;
  for (int i = 0; i < torso.num_joints; ++i) {
    const auto joint = human.joints.find(torso.joints[static_cast<std::size_t>(i)]);
    if (joint == human.joints.end()) continue;
    sum += joint->second.p_W.cast<double>();
    ++count;
  }
  if (count == 0) return std::nullopt;
  Se3 T_W_H;
  T_W_H.translation = sum / count;
  const auto neck = human.joints.find(kNeck);
  const auto right = human.joints.find(kRightHip);
  const auto left = human.joints.find(kLeftHip);
  const auto end = human.joints.end();
  if (neck == end || right == end || left == end) return T_W_H;

  const Eigen::Vector3d p_right = right->second.p_W.cast<double>();
  const Eigen::Vector3d p_left = left->second.p_W.cast<double>();
  const Eigen::Vector3d p_neck = neck->second.p_W.cast<double>();
  const Eigen::Vector3d p_hips = 0.5 * (p_right + p_left);
  T_W_H.translation = 0.5 * (p_neck + p_hips);
  const Eigen::Vector3d down = p_hips - p_neck;
  const Eigen::Vector3d forward = (p_right - p_left).cross(down);
  constexpr double kMinAreaM2 = 1e-4;  // hips 1 cm apart, below a spine 1 cm long
  if (!(forward.norm() > kMinAreaM2)) return T_W_H;
  Eigen::Matrix3d R_W_H;
  R_W_H.col(1) = down.normalized();
  R_W_H.col(2) = forward.normalized();
  R_W_H.col(0) = R_W_H.col(1).cross(R_W_H.col(2));
  T_W_H.rotation = Eigen::Quaterniond(R_W_H).normalized();
  return T_W_H;
}

std::string HumanToJson(FrameId frame, HumanId human, const MapHuman& state) {
  Json lengths = Json::object();
  for (const auto& [id, length_m] : state.segment_lengths_m) lengths[std::to_string(id)] = length_m;
  const Json line = {{"seq", frame.value},
                     {"utime", state.utime},
                     {"track", human.value},
                     {"joints", JointsToJson(state, &MapJoint::p_W)},
                     {"measured", JointsToJson(state, &MapJoint::p_W_measured)},
                     {"segment_lengths_m", std::move(lengths)}};
  return line.dump();
}

std::vector<std::string> ExportNames(const std::string& folder, const std::string& prefix) {
  std::vector<std::string> names;
  for (const char* name : {"trajectory.tum", "trajectory_live.tum", "trajectory.kitti",
                           "ground_truth.tum", "map.ply", "people.jsonl"}) {
    names.push_back(prefix + name);
  }
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder + "/" + prefix + "people", error)) {
    const std::string name = entry.path().filename().string();
    const bool is_track = name.size() > 4 && name.substr(name.size() - 4) == ".tum" &&
                          name.find_first_not_of("0123456789") == name.size() - 4;
    if (is_track) names.push_back(prefix + "people/" + name);
  }
  return names;
}

std::vector<std::string> ExportMap(const FourDMap& map, const std::string& prefix,
                                   const std::string& group, OutputFolder* results) {
  const std::string stage = results->PathOf(".airdos_export");
  std::error_code error;
  fs::remove_all(stage, error);  // left by an export that was killed
  fs::create_directories(stage + "/people", error);
  if (error) throw InputError(stage + ": cannot be created: " + error.message());
  std::vector<std::string> paths;
  try {
    ExportTrajectories(map, stage, &paths);
    paths.push_back(stage + "/map.ply");
    ExportPly(map, paths.back());
    ExportPeople(map, stage, &paths);
    for (std::string& path : paths) {
      const std::string place = results->Claim(prefix + path.substr(stage.size() + 1), group);
      fs::rename(path, place, error);
      if (error) throw InputError(place + ": cannot be written: " + error.message());
      path = place;
    }
  } catch (...) {
    fs::remove_all(stage, error);
    throw;
  }
  fs::remove_all(stage, error);
  return paths;
}

std::vector<std::string> ExportMap(const FourDMap& map, const std::string& map_path,
                                   const std::string& folder, bool force, int* num_replaced) {
  OutputFolder results(folder, {{map_path}, force});
  std::error_code error;
  if (results.IsListed("map.airdos") && !force && fs::exists(results.PathOf("map.airdos"), error) &&
      !fs::equivalent(results.PathOf("map.airdos"), map_path, error)) {
    throw InputError(folder +
                     ": holds the results of a run with another map; choose another "
                     "folder, or --force replaces its exports");
  }
  const OutputFolder::Selection of_exports = [](const std::string&, const std::string& group) {
    return group == kExportGroup;
  };
  results.RequireReplaceable(ExportNames(folder, ""), of_exports);
  const int num_removed = results.RemoveEarlier(of_exports);
  if (num_replaced != nullptr) *num_replaced = num_removed;
  return ExportMap(map, "", kExportGroup, &results);
}

}  // namespace airdos
