#include "common/optimization/window/window_map.h"

#include <algorithm>
#include <utility>

#include "common/util/check.h"

namespace airdos {
namespace {

// The frontend learns about a removed landmark a few frames later and keeps observing it until
// then.
constexpr int kIgnoreRemovedFrames = 50;
constexpr double kFarthest_m = 1e5;

}  // namespace

void WindowMap::AddFrame(const StereoCamera& camera, const FrameInput& input, const Se3& T_W_C) {
  AIRDOS_CHECK(window_.empty() || window_.back() < input.id);
  Frame frame;
  frame.time_s = input.time_s;
  frame.T_W_C = T_W_C;
  frame.is_first = frames_.empty();
  frames_[input.id] = frame;
  window_.push_back(input.id);
  for (const StaticObservation& feature : input.features) {
    AddObservation(camera, input.id, feature);
  }
  if (static_cast<int>(window_.size()) > options_.window_frames) RetireOldest();
  ForgetLandmarks(input.id);
}

void WindowMap::AddObservation(const StereoCamera& camera, FrameId id,
                               const StaticObservation& feature) {
  if (removed_.count(feature.id) > 0) return;
  Frame& frame = frames_.at(id);
  if (!frame.observations
           .try_emplace(feature.id,
                        Observation{feature.uvu_px, feature.has_right, feature.sigma_px, 0})
           .second) {
    return;
  }
  Landmark& landmark = landmarks_[feature.id];
  // No kept frame sees it any more, so nothing holds its old position: the new measurement is
  // better.
  if (landmark.frames.empty()) landmark.p_W.reset();
  landmark.frames.insert(id);
  landmark.last_seen = id;
  const double disparity_px = feature.uvu_px.x() - feature.uvu_px.z();
  if (landmark.p_W || !feature.has_right || disparity_px < options_.min_disparity_px) return;
  const auto p_C = camera.Triangulate(feature.uvu_px.x(), feature.uvu_px.y(), feature.uvu_px.z());
  if (p_C) landmark.p_W = frame.T_W_C * *p_C;
}

int WindowMap::NumShared(const Frame& a, const Frame& b) const {
  int num_shared = 0;
  for (const auto& [id, observation] : a.observations) {
    num_shared += static_cast<int>(b.observations.count(id));
  }
  return num_shared;
}

void WindowMap::RetireOldest() {
  const FrameId oldest = window_.front();
  window_.erase(window_.begin());
  const Frame& frame = frames_.at(oldest);
  ++frames_since_key_frame_;
  bool is_key = key_frames_.empty() || frames_since_key_frame_ >= options_.key_frame_interval;
  if (!is_key) {
    const int num_shared = NumShared(frame, frames_.at(key_frames_.back()));
    is_key =
        num_shared < options_.key_frame_max_shared * static_cast<double>(frame.observations.size());
  }
  if (!is_key) {
    ForgetFrame(oldest);
    return;
  }
  frames_since_key_frame_ = 0;
  key_frames_.push_back(oldest);
  if (static_cast<int>(key_frames_.size()) > options_.max_key_frames) {
    ForgetFrame(key_frames_.front());
    key_frames_.erase(key_frames_.begin());
  }
}

void WindowMap::ForgetFrame(FrameId id) {
  for (const auto& [landmark, observation] : frames_.at(id).observations) {
    const auto it = landmarks_.find(landmark);
    if (it != landmarks_.end()) it->second.frames.erase(id);
  }
  frames_.erase(id);
}

void WindowMap::ForgetLandmarks(FrameId newest) {
  for (auto it = landmarks_.begin(); it != landmarks_.end();) {
    const bool is_old = newest.value - it->second.last_seen.value > options_.forget_after_frames;
    it = is_old && it->second.frames.empty() ? landmarks_.erase(it) : std::next(it);
  }
  for (auto it = removed_.begin(); it != removed_.end();) {
    const bool is_old = newest.value - it->second.value > kIgnoreRemovedFrames;
    it = is_old ? removed_.erase(it) : std::next(it);
  }
}

std::vector<FrameId> WindowMap::ChooseFixedFrames() const {
  std::set<LandmarkId> seen;
  for (const FrameId id : window_) {
    for (const auto& [landmark, observation] : frames_.at(id).observations) seen.insert(landmark);
  }
  std::vector<std::pair<int, FrameId>> ranked;  // minus the number shared: most shared first
  for (const FrameId id : key_frames_) {
    int num_shared = 0;
    for (const auto& [landmark, observation] : frames_.at(id).observations) {
      num_shared += static_cast<int>(seen.count(landmark));
    }
    if (num_shared >= options_.min_shared_landmarks) ranked.emplace_back(-num_shared, id);
  }
  std::sort(ranked.begin(), ranked.end());
  std::vector<FrameId> chosen;
  for (const auto& [minus_shared, id] : ranked) {
    if (static_cast<int>(chosen.size()) == options_.max_fixed_key_frames) break;
    chosen.push_back(id);
  }
  std::sort(chosen.begin(), chosen.end());
  return chosen;
}

BundleProblem WindowMap::BuildProblem(const StereoCamera& camera) const {
  BundleProblem problem;
  problem.camera = camera;
  std::vector<FrameId> ids = ChooseFixedFrames();
  const std::size_t num_fixed = ids.size();
  ids.insert(ids.end(), window_.begin(), window_.end());

  struct Place {
    int frame;
    const Observation* observation;
  };
  std::map<LandmarkId, std::vector<Place>> places;
  for (std::size_t i = 0; i < ids.size(); ++i) {
    const Frame& frame = frames_.at(ids[i]);
    problem.frames.push_back({ids[i], frame.time_s, frame.T_W_C, i < num_fixed || frame.is_first});
    for (const auto& [landmark, observation] : frame.observations) {
      places[landmark].push_back({static_cast<int>(i), &observation});
    }
  }
  if (num_fixed == 0) problem.frames.front().is_fixed = true;

  for (const auto& [id, seen] : places) {
    const auto landmark = landmarks_.find(id);
    const bool is_in_window = seen.back().frame >= static_cast<int>(num_fixed);
    if (landmark == landmarks_.end() || !landmark->second.p_W || seen.size() < 2 || !is_in_window) {
      continue;
    }
    problem.landmarks.push_back({id, *landmark->second.p_W, false});
    for (const Place& place : seen) {
      problem.observations.push_back({place.frame, static_cast<int>(problem.landmarks.size()) - 1,
                                      place.observation->uvu_px, place.observation->has_right,
                                      place.observation->sigma_px, false});
    }
  }
  return problem;
}

bool WindowMap::IsBad(const Landmark& landmark) const {
  const bool is_impossible = !landmark.p_W || !(landmark.p_W->norm() < kFarthest_m);
  // More of its observations were wrong than right.
  return is_impossible || (landmark.num_dropped > 0 &&
                           landmark.num_dropped >= static_cast<int>(landmark.frames.size()));
}

std::vector<LandmarkId> WindowMap::Absorb(const BundleProblem& problem) {
  for (const BundleProblem::Frame& frame : problem.frames) frames_.at(frame.id).T_W_C = frame.T_W_C;
  for (const BundleProblem::Landmark& landmark : problem.landmarks) {
    landmarks_.at(landmark.id).p_W = landmark.p_W;
  }
  for (const BundleProblem::LandmarkObservation& result : problem.observations) {
    const FrameId frame_id = problem.frames[static_cast<std::size_t>(result.frame)].id;
    const LandmarkId id = problem.landmarks[static_cast<std::size_t>(result.landmark)].id;
    Frame& frame = frames_.at(frame_id);
    Observation& observation = frame.observations.at(id);
    observation.num_rejections = result.is_rejected ? observation.num_rejections + 1 : 0;
    if (observation.num_rejections < options_.max_rejections) continue;
    frame.observations.erase(id);
    landmarks_.at(id).frames.erase(frame_id);
    ++landmarks_.at(id).num_dropped;
  }
  std::vector<LandmarkId> bad;
  for (const BundleProblem::Landmark& landmark : problem.landmarks) {
    if (!IsBad(landmarks_.at(landmark.id))) continue;
    bad.push_back(landmark.id);
    for (const FrameId id : landmarks_.at(landmark.id).frames) {
      frames_.at(id).observations.erase(landmark.id);
    }
    landmarks_.erase(landmark.id);
    removed_[landmark.id] = window_.back();
  }
  return bad;
}

}  // namespace airdos
