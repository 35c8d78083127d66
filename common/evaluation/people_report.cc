#include "common/evaluation/people_report.h"

#include <zlib.h>

#include <cmath>
#include <cstdio>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <tuple>

#include "common/human/skeleton.h"
#include "common/util/error.h"

namespace airdos {
namespace {

using nlohmann::json;

constexpr double kSameTimeS = 0.001;

Joints ParseJoints(const json& object) {
  Joints joints;
  for (const auto& [key, place] : object.items()) {
    const int id = std::stoi(key);
    if (id >= kNumJoints) continue;  // of the face
    joints[id] = Eigen::Vector3d(place.at(0).get<double>(), place.at(1).get<double>(),
                                 place.at(2).get<double>());
  }
  return joints;
}

/// A file, unpacked if it is of gzip.
std::string ReadUnpacked(const std::string& path) {
  const gzFile file = gzopen(path.c_str(), "rb");
  if (file == nullptr) throw InputError(path + ": cannot be read");
  std::string text;
  char buffer[1 << 16];
  int size = 0;
  while ((size = gzread(file, buffer, sizeof buffer)) > 0) {
    text.append(buffer, static_cast<std::size_t>(size));
  }
  gzclose(file);
  if (size < 0) throw InputError(path + ": cannot be unpacked");
  return text;
}

/// T_true_W of a frame: maps points of the estimate's world to the true one, through the camera.
std::optional<TrajectoryPose> TransformAt(const MatchedTrajectories& cameras, double time_s) {
  for (std::size_t i = 0; i < cameras.estimate.size(); ++i) {
    const TrajectoryPose& T_W_C = cameras.estimate[i];
    const TrajectoryPose& T_true_C = cameras.ground_truth[i];
    if (std::abs(T_W_C.time_s - time_s) > kSameTimeS) continue;
    TrajectoryPose T_true_W;
    T_true_W.rotation = T_true_C.rotation * T_W_C.rotation.transpose();
    T_true_W.position_m = T_true_C.position_m - T_true_W.rotation * T_W_C.position_m;
    return T_true_W;
  }
  return std::nullopt;
}

std::vector<double> Distances(const Joints& estimate, const Joints& truth,
                              const TrajectoryPose& T_true_W) {
  std::vector<double> distances_m;
  for (const auto& [id, p_W] : estimate) {
    const auto other = truth.find(id);
    if (other == truth.end()) continue;
    const Eigen::Vector3d p_true = T_true_W.rotation * p_W + T_true_W.position_m;
    distances_m.push_back((p_true - other->second).norm());
  }
  return distances_m;
}

using Pairs = std::map<std::int64_t, std::int64_t>;  // true person -> index of the state

/// Pairs the states of one frame with true people; `last_track` says whom a person was before.
Pairs MakePairs(const std::vector<const PersonState*>& states, const TruePeople& truth,
                const TrajectoryPose& T_true_W,
                const std::map<std::int64_t, std::int64_t>& last_track, double max_distance_m) {
  std::set<std::tuple<bool, double, std::int64_t, std::int64_t>> candidates;
  for (std::size_t i = 0; i < states.size(); ++i) {
    for (const auto& [person, joints] : truth.people) {
      const Statistics distance =
          ComputeStatistics(Distances(states[i]->joints_W, joints, T_true_W));
      if (distance.count == 0 || distance.mean > max_distance_m) continue;
      const auto last = last_track.find(person);
      const bool is_new = last == last_track.end() || last->second != states[i]->track;
      candidates.emplace(is_new, distance.mean, person, static_cast<std::int64_t>(i));
    }
  }
  Pairs pairs;
  std::set<std::int64_t> used;
  for (const auto& [is_new, distance, person, state] : candidates) {
    if (pairs.count(person) > 0 || used.count(state) > 0) continue;
    pairs[person] = state;
    used.insert(state);
  }
  return pairs;
}

void Append(const std::vector<double>& values, std::vector<double>* all) {
  all->insert(all->end(), values.begin(), values.end());
}

}  // namespace

std::vector<PersonState> ReadPeople(const std::string& path) {
  std::ifstream file(path);
  if (!file) throw InputError(path + ": cannot be read");
  std::vector<PersonState> states;
  std::string line;
  for (int number = 1; std::getline(file, line); ++number) {
    try {
      const json object = json::parse(line);
      PersonState state;
      state.time_s = 1e-6 * object.at("utime").get<double>();
      state.track = object.at("track");
      state.joints_W = ParseJoints(object.at("joints"));
      state.measured_W = ParseJoints(object.at("measured"));
      states.push_back(std::move(state));
    } catch (const std::exception& error) {
      throw InputError(path + ":" + std::to_string(number) + ": " + error.what());
    }
  }
  return states;
}

std::vector<TruePeople> ReadTruePeople(const std::string& path) {
  const std::string text = ReadUnpacked(path);
  std::vector<TruePeople> frames;
  try {
    for (const json& object : json::parse(text)) {
      TruePeople frame;
      frame.time_s = object.at("t");
      for (const json& human : object.at("humans")) {
        frame.people[human.at("id")] = ParseJoints(human.at("joints_w"));
      }
      frames.push_back(std::move(frame));
    }
  } catch (const std::exception& error) {
    throw InputError(path + ": " + error.what());
  }
  return frames;
}

PeopleReport EvaluatePeople(const std::vector<PersonState>& estimate,
                            const std::vector<TruePeople>& truth,
                            const MatchedTrajectories& cameras, double max_distance_m) {
  PeopleReport report;
  std::vector<double> errors_m;
  std::vector<double> measured_errors_m;
  std::set<std::int64_t> tracks;
  std::map<std::int64_t, std::int64_t> last_track;  // of each true person
  for (const TruePeople& frame : truth) {
    const std::optional<TrajectoryPose> T_true_W = TransformAt(cameras, frame.time_s);
    if (!T_true_W) continue;
    std::vector<const PersonState*> states;
    for (const PersonState& state : estimate) {
      if (std::abs(state.time_s - frame.time_s) <= kSameTimeS) states.push_back(&state);
    }
    report.num_states += states.size();
    for (const PersonState* state : states) tracks.insert(state->track);
    const Pairs pairs = MakePairs(states, frame, *T_true_W, last_track, max_distance_m);
    report.num_matched += pairs.size();
    for (const auto& [person, index] : pairs) {
      const PersonState& state = *states[static_cast<std::size_t>(index)];
      const auto [last, is_first] = last_track.emplace(person, state.track);
      if (!is_first && last->second != state.track) ++report.num_identity_switches;
      last->second = state.track;
      const Joints& joints = frame.people.at(person);
      Append(Distances(state.joints_W, joints, *T_true_W), &errors_m);
      Append(Distances(state.measured_W, joints, *T_true_W), &measured_errors_m);
    }
  }
  report.num_tracks = tracks.size();
  report.num_people = last_track.size();
  report.joint_error_m = ComputeStatistics(errors_m);
  report.measured_error_m = ComputeStatistics(measured_errors_m);
  return report;
}

std::string ToTable(const PeopleReport& r) {
  char text[700];
  std::snprintf(text, sizeof text,
                "%zu states of %zu tracks, %zu matched with %zu people, %zu identity switches\n"
                "  %-24s %-6s %9s %9s %9s %9s\n  %-24s %-6s %9.4f %9.4f %9.4f %9.4f\n"
                "  %-24s %-6s %9.4f %9.4f %9.4f %9.4f\n",
                r.num_states, r.num_tracks, r.num_matched, r.num_people, r.num_identity_switches,
                "error of the joints", "unit", "rmse", "mean", "median", "max", "optimized", "m",
                r.joint_error_m.rmse, r.joint_error_m.mean, r.joint_error_m.median,
                r.joint_error_m.max, "as triangulated", "m", r.measured_error_m.rmse,
                r.measured_error_m.mean, r.measured_error_m.median, r.measured_error_m.max);
  return text;
}

json ToJson(const PeopleReport& r) {
  const auto statistics = [](const Statistics& s) {
    return json{{"count", s.count},   {"rmse", s.rmse}, {"mean", s.mean},
                {"median", s.median}, {"max", s.max},   {"std", s.std}};
  };
  return {{"states", r.num_states},
          {"states_matched", r.num_matched},
          {"tracks", r.num_tracks},
          {"people_matched", r.num_people},
          {"identity_switches", r.num_identity_switches},
          {"joint_error_m", statistics(r.joint_error_m)},
          {"joint_error_measured_m", statistics(r.measured_error_m)}};
}

}  // namespace airdos
