#include "tests/support/chain_run.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <opencv2/core/utility.hpp>
#include <stdexcept>
#include <utility>

#include "airdos/human_observations_t.hpp"
#include "airdos/map_update_t.hpp"
#include "airdos/state_estimate_t.hpp"
#include "common/evaluation/people_matching.h"
#include "common/map/four_d_map.h"
#include "common/util/quantile.h"
#include "processes/node/log/event_log.h"
#include "processes/node/message/channels.h"
#include "processes/node/message/codec.h"
#include "processes/tools/replay/replay_setup.h"
#include "tests/support/test_overrides.h"

namespace airdos {
namespace {

namespace fs = std::filesystem;

constexpr char kLogName[] = "out.lcm";
constexpr double kMicro = 1e-6;
constexpr double kMaxTimeDifferenceS = 0.001;

/// The folder of one run.
class RunFolder {
 public:
  RunFolder() {
    static int number = 0;
    path_ = fs::temp_directory_path() /
            ("airdos_chain_" + std::to_string(getpid()) + "_" + std::to_string(++number));
    fs::create_directories(path_);
  }
  ~RunFolder() { fs::remove_all(path_); }
  RunFolder(const RunFolder&) = delete;
  RunFolder& operator=(const RunFolder&) = delete;
  std::string file(const std::string& name) const { return (path_ / name).string(); }
  std::string path() const { return path_.string(); }

 private:
  fs::path path_;
};

template <class Message>
Message DecodeEvent(const LogEvent& event) {
  Message message{};
  if (!Decode(event.payload.data(), event.payload.size(), &message))
    throw std::runtime_error(event.channel + " does not decode");
  return message;
}

double Percent(double part, double whole) { return whole > 0 ? 100 * part / whole : 0; }

PeopleUse UseOfPeople(const std::string& log) {
  PeopleUse use;
  double num_frames = 0, rigidity_eliminated = 0, motion_eliminated = 0;
  EventLogReader reader(log);
  while (const std::optional<LogEvent> event = reader.Next()) {
    if (event->channel == channel::kHumanObservations) {
      for (const auto& human : DecodeEvent<human_observations_t>(*event).humans)
        use.joints_seen += human.num_joints;
    } else if (event->channel == channel::kMapUpdate) {
      const auto update = DecodeEvent<map_update_t>(*event);
      for (const human_state_t& human : update.humans)
        use.joints_adjusted += human.seq == update.seq ? human.num_joints : 0;
    } else if (event->channel == channel::kStateEstimate) {
      const auto state = DecodeEvent<state_estimate_t>(*event);
      ++num_frames;
      use.people += state.num_people;
      use.rigidity_factors += state.num_rigidity_factors;
      use.motion_factors += state.num_motion_factors;
      use.reprojection_eliminated += state.num_reprojection_eliminated;
      rigidity_eliminated += state.num_rigidity_eliminated;
      motion_eliminated += state.num_motion_eliminated;
    }
  }
  use.rigidity_eliminated_percent = Percent(rigidity_eliminated, use.rigidity_factors);
  use.motion_eliminated_percent = Percent(motion_eliminated, use.motion_factors);
  for (double* sum : {&use.joints_seen, &use.joints_adjusted, &use.people, &use.rigidity_factors,
                      &use.motion_factors, &use.reprojection_eliminated})
    *sum /= num_frames;
  return use;
}

/// Step of the middle of the joints that define a torso's motion, if both frames have all of them.
std::optional<Eigen::Vector3d> TorsoStep(const Joints& before, const Joints& after) {
  Eigen::Vector3d step = Eigen::Vector3d::Zero();
  for (const int joint : kBodyJoints) {
    if (before.count(joint) == 0 || after.count(joint) == 0) return std::nullopt;
    step += (after.at(joint) - before.at(joint)) / kNumBodyJoints;
  }
  return step;
}

struct FrameOfPeople {
  TrajectoryPose estimate, truth;     // camera poses
  std::vector<human_state_t> humans;  // as reported while the frame was the newest
  const TruePeople* true_people = nullptr;
};

/// The true person for each of the frame's people.
std::map<std::size_t, std::int64_t> Match(const FrameOfPeople& frame) {
  std::vector<Joints> measured_C;
  for (const human_state_t& human : frame.humans) {
    Joints joints_W;
    for (std::size_t i = 0; i < human.joint_id.size(); ++i) {
      joints_W[human.joint_id[i]] = {human.x_W_measured_m[i], human.y_W_measured_m[i],
                                     human.z_W_measured_m[i]};
    }
    measured_C.push_back(InCamera(joints_W, frame.estimate));
  }
  std::map<std::int64_t, Joints> truth_C;
  for (const auto& [id, person] : frame.true_people->people)
    truth_C[id] = InCamera(person.joints, frame.truth);
  return MatchPeople(measured_C, truth_C);
}

std::vector<FrameOfPeople> FramesOfPeople(const std::string& log,
                                          const std::vector<TruePeople>& truth,
                                          const MatchedTrajectories& cameras) {
  std::map<std::int64_t, std::vector<human_state_t>> humans;  // keyed by utime
  EventLogReader reader(log);
  while (const std::optional<LogEvent> event = reader.Next()) {
    if (event->channel != channel::kMapUpdate) continue;
    const auto update = DecodeEvent<map_update_t>(*event);
    for (const human_state_t& human : update.humans) {
      if (human.seq == update.seq) humans[update.utime].push_back(human);
    }
  }
  std::vector<FrameOfPeople> frames;
  for (std::size_t i = 0; i < cameras.estimate.size(); ++i) {
    const double time_s = cameras.estimate[i].time_s;
    const auto people = std::find_if(truth.begin(), truth.end(), [&](const TruePeople& other) {
      return std::abs(other.time_s - time_s) < kMaxTimeDifferenceS;
    });
    if (people == truth.end()) continue;
    frames.push_back({cameras.estimate[i], cameras.ground_truth[i],
                      humans[std::llround(time_s / kMicro)], &*people});
  }
  return frames;
}

/// The torso's motion, if it has one.
std::optional<Eigen::Vector3d> MotionOf(const human_state_t& human) {
  const auto torso = std::find(human.part_id.begin(), human.part_id.end(), kTorsoPart);
  if (torso == human.part_id.end()) return std::nullopt;
  const std::vector<float>& t =
      human.translation_m[static_cast<std::size_t>(torso - human.part_id.begin())];
  return Eigen::Vector3d(t[0], t[1], t[2]);
}

/// Errors of torsos seen in two consecutive frames, relative to the true step of the same joints.
VelocityErrors ErrorsOfVelocity(const std::vector<FrameOfPeople>& frames) {
  std::vector<double> errors, speeds;
  std::map<std::int64_t, std::size_t> last_frame;  // of each track
  for (std::size_t k = 0; k < frames.size(); ++k) {
    const auto matches = Match(frames[k]);
    for (std::size_t i = 0; i < frames[k].humans.size(); ++i) {
      const human_state_t& human = frames[k].humans[i];
      const auto before = last_frame.find(human.track_id);
      const bool is_next = before != last_frame.end() && before->second + 1 == k;
      last_frame[human.track_id] = k;
      const std::optional<Eigen::Vector3d> motion = MotionOf(human);
      if (!is_next || matches.count(i) == 0 || !motion) continue;
      const auto& people_before = frames[k - 1].true_people->people;
      const auto person_before = people_before.find(matches.at(i));
      if (person_before == people_before.end()) continue;
      const auto step = TorsoStep(person_before->second.joints,
                                  frames[k].true_people->people.at(matches.at(i)).joints);
      if (!step) continue;
      const double step_s = frames[k].estimate.time_s - frames[k - 1].estimate.time_s;
      // Each in the axes of its own camera, since the worlds differ.
      const Eigen::Vector3d moved_C = frames[k].estimate.rotation.transpose() * *motion;
      const Eigen::Vector3d truly_C = frames[k].truth.rotation.transpose() * *step;
      errors.push_back((moved_C - truly_C).norm() / step_s);
      speeds.push_back(moved_C.norm() / step_s);
    }
  }
  return {errors.size(), Quantile(errors, 0.5), Quantile(speeds, 0.5)};
}

void EvaluateTruth(const RunFolder& folder, const PeopleTruth& truth, ChainRun* run) {
  const MatchedTrajectories cameras = Associate(ReadTrajectory(folder.file("trajectory.tum")),
                                                ReadTrajectory(truth.camera), kMaxTimeDifferenceS);
  const std::vector<TruePeople> people = ReadTruePeople(truth.joints);
  run->people = EvaluatePeople(ReadPeople(folder.file("people.jsonl")), people, cameras);
  run->velocity = ErrorsOfVelocity(FramesOfPeople(folder.file(kLogName), people, cameras));
}

}  // namespace

ChainRun RunChain(const ChainInput& input) {
  cv::setNumThreads(1);
  const RunFolder folder;
  ReplaySetup setup;
  setup.config_dir = std::string(AIRDOS_SOURCE_DIR) + "/launch_scripts/config";
  setup.run_dir = folder.path();
  setup.people = input.people;
  setup.detects = input.detects;
  setup.overrides = TestOverrides();
  ReplayOptions options;
  options.out_path = folder.file(kLogName);
  ChainRun run;
  run.result = Replay(OpenFrameSource(input.path).get(), MakeReplayNodes(setup), options);
  EvaluationOptions evaluation;
  evaluation.axes = input.has_ned_truth ? GroundTruthAxes::Ned() : GroundTruthAxes::Optical();
  run.trajectory = EvaluateTrajectory(ReadTrajectory(folder.file("trajectory.tum")),
                                      ReadTrajectory(folder.file("ground_truth.tum")), evaluation);
  run.use = UseOfPeople(options.out_path);
  MapFileSummary summary;
  const FourDMap map = ReadFourDMap(folder.file("map.airdos"), &summary);
  run.num_landmarks = map.landmarks.size();
  run.is_closed = map.is_closed;
  if (!input.truth.joints.empty()) EvaluateTruth(folder, input.truth, &run);
  return run;
}

Figures FiguresOf(const ChainRun& run) {
  Figures figures = {{"ate_m", run.trajectory.ate_se3_m.rmse},
                     {"drift_percent", run.trajectory.end_point_drift_percent},
                     {"frames_lost", static_cast<double>(run.trajectory.num_lost)},
                     {"landmarks", static_cast<double>(run.num_landmarks)},
                     {"joints_seen", run.use.joints_seen},
                     {"joints_adjusted", run.use.joints_adjusted},
                     {"people", run.use.people},
                     {"rigidity_factors", run.use.rigidity_factors},
                     {"motion_factors", run.use.motion_factors},
                     {"rigidity_eliminated_percent", run.use.rigidity_eliminated_percent},
                     {"motion_eliminated_percent", run.use.motion_eliminated_percent},
                     {"reprojections_eliminated", run.use.reprojection_eliminated}};
  if (!run.people) return figures;
  const PeopleReport& people = *run.people;
  const Figures of_people = {
      {"people_found_percent",
       Percent(static_cast<double>(people.num_seen), static_cast<double>(people.num_to_be_seen))},
      {"tracks", static_cast<double>(people.num_tracks)},
      {"switches", people.identity.num_switches},
      {"idf1", people.identity.idf1},
      {"joint_measured_mean_m", people.joint_errors.measured.mean},
      {"joint_measured_median_m", people.joint_errors.measured.median},
      {"joint_optimized_mean_m", people.joint_errors.optimized.mean},
      {"joint_optimized_median_m", people.joint_errors.optimized.median},
      {"length_error_percent", people.lengths.relative_percent.median},
      {"length_signed_percent", people.lengths.median_signed_percent},
      {"lengths_within_5_percent", people.lengths.within_5_percent},
      {"velocities", static_cast<double>(run.velocity->num)},
      {"velocity_error_m_s", run.velocity->median_m_s},
      {"speed_m_s", run.velocity->median_speed_m_s}};
  figures.insert(of_people.begin(), of_people.end());
  return figures;
}

}  // namespace airdos
