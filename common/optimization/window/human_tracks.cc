#include "common/optimization/window/human_tracks.h"

#include <iterator>
#include <utility>

namespace airdos {
void HumanTracks::AddFrame(const StereoCamera& camera, const FrameInput& input) {
  frames_.push_back(input.id);
  times_s_[input.id] = input.time_s;
  for (const HumanObservation& human : input.humans) {
    std::map<int, Joint> joints;
    for (const JointObservation& seen : human.joints) {
      const Eigen::Vector3d& uvu_px = seen.uvu_px;
      if (uvu_px.x() - uvu_px.z() < options_.min_disparity_px) continue;
      const auto p_C = camera.Triangulate(uvu_px.x(), uvu_px.y(), uvu_px.z());
      if (!p_C || p_C->z() > options_.max_depth_m) continue;
      joints[seen.joint] = {uvu_px, seen.covariance_px2, *p_C, *p_C, false};
    }
    if (joints.empty()) continue;
    Person& person = people_[human.id];
    person.lengths.Add(MeasuredJoints(camera, joints));
    person.sightings[input.id] = std::move(joints);
    person.last_seen = input.id;
  }
  if (static_cast<int>(frames_.size()) > options_.window_frames) {
    for (auto& [id, person] : people_) {
      const auto oldest = person.sightings.find(frames_.front());
      if (oldest == person.sightings.end()) continue;
      person.lengths_before_window.Add(MeasuredJoints(camera, oldest->second));
      person.sightings.erase(oldest);
    }
    times_s_.erase(frames_.front());
    frames_.erase(frames_.begin());
  }
  for (auto it = people_.begin(); it != people_.end();) {
    const bool is_old = input.id.value - it->second.last_seen.value > options_.forget_after_frames;
    it = is_old ? people_.erase(it) : std::next(it);
  }
}

std::map<int, MeasuredJoint> HumanTracks::MeasuredJoints(const StereoCamera& camera,
                                                         const std::map<int, Joint>& joints) {
  std::map<int, MeasuredJoint> measured;
  for (const auto& [id, joint] : joints) {
    const Eigen::Matrix3d J_inverse = camera.ProjectStereoJacobian(joint.p_C_measured).inverse();
    measured[id] = {joint.p_C_measured, J_inverse * joint.covariance_px2 * J_inverse.transpose()};
  }
  return measured;
}

void HumanTracks::AddTo(BundleProblem* problem) const {
  std::map<FrameId, int> index;
  for (std::size_t i = 0; i < problem->frames.size(); ++i) {
    index[problem->frames[i].id] = static_cast<int>(i);
  }
  problem->humans.clear();
  for (const auto& [id, person] : people_) {
    if (person.sightings.empty()) continue;
    BundleProblem::Human human;
    human.id = id;
    for (const auto& [frame_id, joints] : person.sightings) {
      const int frame = index.at(frame_id);
      const Se3& T_W_C = problem->frames[static_cast<std::size_t>(frame)].T_W_C;
      for (const auto& [joint, seen] : joints) {
        human.joints.push_back(
            {frame, joint, T_W_C * seen.p_C, seen.uvu_px, seen.covariance_px2, false});
      }
    }
    for (std::size_t segment = 0; segment < kNumSegments; ++segment) {
      const std::optional<SegmentLengths::Length> length = person.lengths.Find(segment);
      if (!length) continue;
      human.segment_length_m[segment] = length->mean_m;
      // The solver gets the window's own measurements of a length directly, so they must not count
      // here too.
      const std::optional<SegmentLengths::Length> known =
          person.lengths_before_window.Find(segment);
      if (!known) continue;
      human.known_length_m[segment] = known->mean_m;
      human.known_length_sigma_m[segment] = known->sigma_m;
    }
    problem->humans.push_back(std::move(human));
  }
}

void HumanTracks::Absorb(const BundleProblem& problem) {
  for (const BundleProblem::Human& human : problem.humans) {
    Person& person = people_.at(human.id);
    for (const BundleProblem::JointState& state : human.joints) {
      const BundleProblem::Frame& frame = problem.frames[static_cast<std::size_t>(state.frame)];
      const Eigen::Vector3d p_C = frame.T_W_C.inverse() * state.p_W;
      const bool is_possible = p_C.allFinite() && p_C.z() > 0 && p_C.z() < 2 * options_.max_depth_m;
      Joint& joint = person.sightings.at(frame.id).at(state.joint);
      joint.is_rejected = state.is_rejected || !is_possible;
      // A joint whose measurement was rejected starts from that measurement again next time.
      joint.p_C = joint.is_rejected ? joint.p_C_measured : p_C;
    }
  }
}

std::vector<HumanState> HumanTracks::Describe(FrameId frame, const Se3& T_W_C,
                                              const BundleProblem& problem) const {
  std::vector<HumanState> states;
  for (const auto& [id, person] : people_) {
    const auto sighting = person.sightings.find(frame);
    if (sighting == person.sightings.end()) continue;
    HumanState state;
    state.id = id;
    state.frame = frame;
    state.time_s = times_s_.at(frame);
    for (const auto& [joint, seen] : sighting->second) {
      if (seen.is_rejected) continue;
      state.joints.push_back({joint, T_W_C * seen.p_C, T_W_C * seen.p_C_measured});
    }
    for (std::size_t segment = 0; segment < kNumSegments; ++segment) {
      const std::optional<SegmentLengths::Length> length = person.lengths.Find(segment);
      if (length) state.segments.push_back({static_cast<int>(segment), length->mean_m});
    }
    for (const BundleProblem::Human& human : problem.humans) {
      if (human.id != id) continue;
      for (const BundleProblem::PartMotion& motion : human.motions) {
        const BundleProblem::Frame& at = problem.frames[static_cast<std::size_t>(motion.frame)];
        if (at.id == frame) state.motions.push_back(motion);
      }
    }
    states.push_back(std::move(state));
  }
  return states;
}

}  // namespace airdos
