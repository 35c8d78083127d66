#include "tests/support/human_scoring.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <ctime>
#include <limits>
#include <memory>
#include <numeric>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <set>

#include "common/dataset/stereo_sequence.h"
#include "common/human/assignment.h"
#include "common/human/layouts.h"
#include "common/util/quantile.h"
#include "tests/support/crossing_truth.h"

namespace airdos {
namespace {

constexpr int kMinVisibleJoints = 5;
constexpr double kMinHeightPx = 45;
constexpr double kMaxMatchPerHeight = 0.15;  // mean distance of joints, relative to the height

double Mean(const std::vector<double>& values) {
  return values.empty() ? 0
                        : std::accumulate(values.begin(), values.end(), 0.0) /
                              static_cast<double>(values.size());
}

std::vector<BodyKeypoints> ToPeople(KeypointLayout layout,
                                    const std::vector<PersonKeypoints>& detections) {
  std::vector<BodyKeypoints> people;
  for (const PersonKeypoints& detection : detections) {
    std::vector<BodyKeypoint> keypoints;
    for (const Keypoint& k : detection) keypoints.push_back({k.u_px, k.v_px, k.confidence});
    people.push_back(*MapToBody(layout, keypoints));
  }
  return people;
}

PeopleFrame ToPeopleFrame(const SequenceFrame& frame) {
  PeopleFrame people;
  people.left_color = cv::imdecode(frame.left_image_file, cv::IMREAD_COLOR);
  cv::cvtColor(people.left_color, people.left_gray, cv::COLOR_BGR2GRAY);
  people.right_gray = cv::imdecode(frame.right_image_file, cv::IMREAD_GRAYSCALE);
  people.left = ToPeople(frame.keypoint_layout, frame.keypoints_left);
  people.right = ToPeople(frame.keypoint_layout, frame.keypoints_right);
  return people;
}

double DepthOf(const TruePerson& person) {
  std::vector<double> depths;
  for (const Eigen::Vector3d& p_C : person.p_C) depths.push_back(p_C.z());
  return *Median(depths);
}

// Mean distance in px from a true person's projection, over the joints that both have. Each joint
// counts at most a tenth of the height, to limit the influence of outliers. Nothing if the person
// is not in front of the camera.
std::optional<double> Distance(const StereoCamera& camera, const TruePerson& truth,
                               const BodyKeypoints& seen, bool is_right) {
  const double depth_m = DepthOf(truth);
  if (depth_m < 0.5) return std::nullopt;
  const double height_px = camera.fx_px * kPersonHeightM / depth_m;
  double best = std::numeric_limits<double>::infinity();
  for (const SideSwap swap : {SideSwap::kNone, SideSwap::kAll}) {
    const BodyKeypoints person = SwapSides(seen, swap);
    double sum = 0;
    int num = 0;
    for (std::size_t joint = 0; joint < person.size(); ++joint) {
      if (person[joint].confidence <= 0 || truth.p_C[joint].z() < 0.2) continue;
      const Eigen::Vector3d uvu = camera.ProjectStereo(truth.p_C[joint]);
      const Eigen::Vector2d uv(is_right ? uvu[2] : uvu[0], uvu[1]);
      sum += std::min((person[joint].uv_px() - uv).norm() / height_px, 0.25);
      ++num;
    }
    if (num > 0) best = std::min(best, sum / num);
  }
  if (!(best < kMaxMatchPerHeight)) return std::nullopt;
  return best;
}

// Finds the true person for each detection in one image, one-to-one.
std::vector<std::optional<std::int64_t>> Identify(const StereoCamera& camera,
                                                  const TrueFrame& truth,
                                                  const std::vector<BodyKeypoints>& people,
                                                  bool is_right) {
  Eigen::MatrixXd cost = Eigen::MatrixXd::Constant(
      static_cast<Eigen::Index>(people.size()), static_cast<Eigen::Index>(truth.people.size()), 9);
  std::vector<std::int64_t> identities;
  for (const auto& [identity, person] : truth.people) {
    for (std::size_t i = 0; i < people.size(); ++i) {
      cost(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(identities.size())) =
          Distance(camera, person, people[i], is_right).value_or(9);
    }
    identities.push_back(identity);
  }
  std::vector<std::optional<std::int64_t>> result(people.size());
  const std::vector<std::optional<int>> partner = Assign(cost, 1);
  for (std::size_t i = 0; i < people.size(); ++i) {
    if (partner[i]) result[i] = identities[static_cast<std::size_t>(*partner[i])];
  }
  return result;
}

void ScorePairing(const HumanTrackerOptions& options, const StereoCamera& camera,
                  const TrueFrame& truth, const PeopleFrame& frame, HumanScore* score) {
  const auto right = Identify(camera, truth, frame.right, true);
  std::set<std::int64_t> in_left(truth.identity_left.begin(), truth.identity_left.end());
  for (const auto& identity : right) {
    if (identity && in_left.count(*identity) != 0) ++score->num_possible_pairs;
  }
  for (const PersonPair& pair :
       PairPeople(options.matcher, camera, frame.left, frame.right).pairs) {
    ++score->num_pairs;
    const auto& other = right[static_cast<std::size_t>(pair.right)];
    if (!other || *other != truth.identity_left[static_cast<std::size_t>(pair.left)]) {
      ++score->num_wrong_pairs;
    }
  }
}

bool IsToBeSeen(const StereoCamera& camera, const TruePerson& person) {
  return person.num_visible_left >= kMinVisibleJoints &&
         person.num_visible_right >= kMinVisibleJoints &&
         camera.fx_px * kPersonHeightM / DepthOf(person) >= kMinHeightPx;
}

void ScoreJoints(const TruePerson& truth, const JointObservations& joints, HumanScore* score) {
  double error = 0;
  double swapped_error = 0;
  for (std::size_t joint = 0; joint < joints.size(); ++joint) {
    if (!joints[joint]) continue;
    const Eigen::Vector3d difference = joints[joint]->p_C - truth.p_C[joint];
    const double depth_m = truth.p_C[joint].z();
    ++score->num_joints;
    score->joint_error_m.push_back(difference.norm());
    score->joint_error_by_depth_m[depth_m < 6    ? 0
                                  : depth_m < 12 ? 1
                                                 : 2]
        .push_back(difference.norm());
    if (depth_m < 6 && truth.is_plain[joint]) score->depth_bias_m.push_back(difference.z());
    const double normalised = difference.dot(joints[joint]->covariance_C.inverse() * difference);
    if (normalised < 50) {
      score->sum_normalised_squared += normalised;
      ++score->num_normalised;
    }
    const int mirrored = SwappedJoint(static_cast<int>(joint), SideSwap::kAll);
    error += difference.head<2>().norm();
    swapped_error +=
        (joints[joint]->p_C - truth.p_C[static_cast<std::size_t>(mirrored)]).head<2>().norm();
  }
  if (swapped_error < 0.7 * error) ++score->num_swapped_sides;
}

void ScoreOutput(const StereoCamera& camera, const TrueFrame& truth, const TrackedFrame& tracked,
                 IdentityEvaluator* identities, HumanScore* score) {
  std::vector<BodyKeypoints> seen;
  for (const TrackedHuman& human : tracked.humans) {
    BodyKeypoints left;
    for (std::size_t joint = 0; joint < left.size(); ++joint) {
      const auto& observation = human.joints[joint];
      if (observation) left[joint] = {observation->u_left_px, observation->v_px, 1};
    }
    seen.push_back(left);
  }
  const auto identity = Identify(camera, truth, seen, false);
  std::map<std::int64_t, std::optional<std::int64_t>> person_of_track;
  std::set<std::int64_t> found;
  for (std::size_t i = 0; i < seen.size(); ++i) {
    ++score->num_reported;
    person_of_track[tracked.humans[i].id.value] = identity[i];
    if (!identity[i]) {
      ++score->num_false;
      continue;
    }
    found.insert(*identity[i]);
    ScoreJoints(truth.people.at(*identity[i]), tracked.humans[i].joints, score);
  }
  std::set<std::int64_t> visible;
  for (const auto& [id, person] : truth.people) {
    if (!IsToBeSeen(camera, person)) continue;
    visible.insert(id);
    ++score->num_visible;
    if (found.count(id) != 0) ++score->num_visible_found;
  }
  identities->AddFrame(visible, person_of_track);
}

}  // namespace

double HumanScore::PairPrecision() const {
  return num_pairs == 0 ? 1 : 1 - static_cast<double>(num_wrong_pairs) / num_pairs;
}

double HumanScore::PairRecall() const {
  return num_possible_pairs == 0
             ? 1
             : static_cast<double>(num_pairs - num_wrong_pairs) / num_possible_pairs;
}

double HumanScore::MeanJointError() const { return Mean(joint_error_m); }

double HumanScore::MedianJointError() const { return Quantile(joint_error_m, 0.5); }

std::string HumanScore::TableHead() {
  return "sequence        paired% wrong% | found% false% joints swap% | err med  mean   <6m  6-12  "
         ">12 bias(<6) nees | people switch  IDF1   IDP   IDR | ms p50  p95";
}

std::string HumanScore::Table() const {
  std::array<char, 400> line;
  const auto percent = [](int a, int b) { return b == 0 ? 0.0 : 100.0 * a / b; };
  std::snprintf(
      line.data(), line.size(),
      "%-15s %6.1f  %5.2f  | %5.1f %5.2f %6d %5.2f | %6.3f %6.3f %5.3f %5.3f %5.3f %+6.3f %5.2f  | "
      "%4d %5d  %.3f %.3f %.3f | %5.1f %5.1f",
      name.c_str(), 100 * PairRecall(), percent(num_wrong_pairs, num_pairs),
      percent(num_visible_found, num_visible), percent(num_false, num_reported), num_joints,
      percent(num_swapped_sides, num_reported), Quantile(joint_error_m, 0.5), MeanJointError(),
      Quantile(joint_error_by_depth_m[0], 0.5), Quantile(joint_error_by_depth_m[1], 0.5),
      Quantile(joint_error_by_depth_m[2], 0.5), Quantile(depth_bias_m, 0.5),
      num_normalised == 0 ? 0 : sum_normalised_squared / (3 * num_normalised), identity.num_people,
      identity.num_switches, identity.idf1, identity.id_precision, identity.id_recall,
      Quantile(frame_ms, 0.5), Quantile(frame_ms, 0.95));
  return line.data();
}

HumanScore ScoreCrossing(const HumanTrackerOptions& options, const std::string& folder) {
  const std::unique_ptr<StereoSequence> sequence = OpenStereoSequence(folder);
  const std::vector<TrueFrame> truth = ReadCrossingTruth(folder);
  HumanScore score;
  score.name = folder.substr(folder.find_last_of('/') + 1);
  HumanTracker tracker(options);
  IdentityEvaluator identities;
  for (std::size_t k = 0; k < sequence->num_frames(); ++k) {
    const SequenceFrame file = sequence->Load(k);
    const std::clock_t start = std::clock();  // CPU time of this process, regardless of other load
    const PeopleFrame frame = ToPeopleFrame(file);
    const TrackedFrame tracked = tracker.Process(sequence->camera(), frame);
    score.frame_ms.push_back(1000.0 * static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC);
    ScorePairing(options, sequence->camera(), truth[k], frame, &score);
    ScoreOutput(sequence->camera(), truth[k], tracked, &identities, &score);
  }
  score.identity = identities.Score();
  return score;
}

}  // namespace airdos
