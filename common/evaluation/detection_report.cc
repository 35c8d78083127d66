#include "common/evaluation/detection_report.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>
#include <utility>

#include "common/evaluation/people_matching.h"
#include "common/evaluation/seen_person.h"
#include "common/human/person_pairing.h"
#include "common/util/format.h"
#include "common/util/quantile.h"

namespace airdos {
namespace {

constexpr double kLimbQuantile = 0.75;
// Sides count as exchanged if exchanging them halves the distance: of a person seen from the side,
// both are in the same place.
constexpr double kClearlyBetter = 0.5;

// Of detections, those on a person: even a poor network reaches the first, and chance hardly ever.
constexpr double kFewOnPeople = 0.1;
constexpr std::size_t kMinDetectionsToJudge = 20;

using People = std::vector<BodyKeypoints>;
/// Identity -> index of the detection.
using Matches = std::map<std::int64_t, std::size_t>;

double MinConfidence() { return PersonPairingOptions().min_confidence; }

bool IsUsed(const BodyKeypoint& joint) { return joint.confidence >= MinConfidence(); }

bool IsUsable(const BodyKeypoints& person) {
  return std::count_if(person.begin(), person.end(), IsUsed) >= PersonPairingOptions().min_joints;
}

People UsableOf(const People& people) {
  People usable;
  std::copy_if(people.begin(), people.end(), std::back_inserter(usable), IsUsable);
  return usable;
}

/// The directions of a detection's joints, as points at depth `depth_m`.
Joints ToJoints(const BodyKeypoints& person, const StereoCamera& camera, double depth_m) {
  Joints joints_C;
  for (int joint = 0; joint < kNumJoints; ++joint) {
    const BodyKeypoint& keypoint = person[static_cast<std::size_t>(joint)];
    if (!IsUsed(keypoint)) continue;
    joints_C[joint] = depth_m * Eigen::Vector3d((keypoint.u_px - camera.cx_px) / camera.fx_px,
                                                (keypoint.v_px - camera.cy_px) / camera.fy_px, 1);
  }
  return joints_C;
}

std::vector<Joints> ToJoints(const People& people, const StereoCamera& camera) {
  std::vector<Joints> all_C;
  for (const BodyKeypoints& person : people) all_C.push_back(ToJoints(person, camera, 1));
  return all_C;
}

/// Lists of errors, of everybody and by depth.
class Errors {
 public:
  void Add(double error, std::size_t band) {
    all_.push_back(std::abs(error));
    by_depth_[band].push_back(std::abs(error));
  }
  void Report(ErrorSpread* all, std::array<ErrorSpread, kNumDepthBands>* by_depth) const {
    *all = Summary(all_);
    std::transform(by_depth_.begin(), by_depth_.end(), by_depth->begin(), Summary);
  }

 private:
  static ErrorSpread Summary(const std::vector<double>& errors) {
    return {errors.size(), Quantile(errors, 0.5), Quantile(errors, 0.9)};
  }

  std::vector<double> all_;
  std::array<std::vector<double>, kNumDepthBands> by_depth_;
};

void Count(bool is_found, Recall* recall) {
  ++recall->num_people;
  recall->num_found += is_found ? 1 : 0;
}

bool AreSidesExchanged(const Joints& detected_C, const Joints& truth_C) {
  return ImageDistance(detected_C, truth_C, SideSwap::kAll) <
         kClearlyBetter * ImageDistance(detected_C, truth_C, SideSwap::kNone);
}

bool Fits(const Joints& detected_C, const Joints& truth_C) {
  return MiddleDepth(truth_C) >= kMinPersonDepthM &&
         std::min(ImageDistance(detected_C, truth_C, SideSwap::kNone),
                  ImageDistance(detected_C, truth_C, SideSwap::kAll)) < kMaxImageDistance;
}

/// Compares a detector with the truth in one image after the other, of one side.
class ImageEvaluator {
 public:
  /// Returns who was found of those to be seen. `people` are usable ones.
  Matches AddImage(const People& people, const SeenPeople& truth, const StereoCamera& camera);
  void AddUnusable(std::size_t num) { score_.num_unusable += num; }
  ImageScore Report() const {
    ImageScore score = score_;
    joints_.Report(&score.joint_px, &score.joint_px_by_depth);
    return score;
  }

 private:
  void AddRest(const People& rest, const SeenPeople& truth,
               const std::map<std::int64_t, Joints>& others_C, const StereoCamera& camera);
  void AddJoints(const BodyKeypoints& person, const SeenPerson& seen, const StereoCamera& camera);

  ImageScore score_;
  Errors joints_;
};

Matches ImageEvaluator::AddImage(const People& people, const SeenPeople& truth,
                                 const StereoCamera& camera) {
  ++score_.num_images;
  score_.num_detections += people.size();
  std::map<std::int64_t, Joints> to_be_seen_C;
  std::map<std::int64_t, Joints> others_C;
  for (const auto& [identity, seen] : truth) {
    (seen.is_to_be_seen ? to_be_seen_C : others_C)[identity] = seen.joints_C;
  }
  const std::vector<Joints> detected_C = ToJoints(people, camera);
  Matches found;
  std::vector<bool> is_matched(people.size(), false);
  for (const auto& [index, identity] : MatchPeople(detected_C, to_be_seen_C)) {
    found[identity] = index;
    is_matched[index] = true;
    AddJoints(people[index], truth.at(identity), camera);
    if (AreSidesExchanged(detected_C[index], to_be_seen_C.at(identity))) ++score_.num_exchanged;
  }
  for (const auto& [identity, seen] : truth) {
    if (!seen.is_to_be_seen) continue;
    const bool is_found = found.count(identity) > 0;
    Count(is_found, &score_.recall);
    Count(is_found, &score_.recall_by_depth[seen.band]);
    Count(is_found, &score_.recall_by_sight[static_cast<std::size_t>(seen.sight)]);
  }
  People rest;
  for (std::size_t i = 0; i < people.size(); ++i) {
    if (!is_matched[i]) rest.push_back(people[i]);
  }
  AddRest(rest, truth, others_C, camera);
  return found;
}

void ImageEvaluator::AddRest(const People& rest, const SeenPeople& truth,
                             const std::map<std::int64_t, Joints>& others_C,
                             const StereoCamera& camera) {
  const std::vector<Joints> rest_C = ToJoints(rest, camera);
  const std::map<std::size_t, std::int64_t> on_others = MatchPeople(rest_C, others_C);
  score_.num_on_others += on_others.size();
  for (std::size_t i = 0; i < rest_C.size(); ++i) {
    if (on_others.count(i) > 0) continue;
    ++score_.num_false;
    const auto is_any = [&](const auto& is_this_one) {
      return std::any_of(truth.begin(), truth.end(),
                         [&](const auto& entry) { return is_this_one(entry.second); });
    };
    const double height_px = StandingHeight(rest[i], MinConfidence()).value_or(0);
    if (is_any([&](const SeenPerson& person) { return Fits(rest_C[i], person.joints_C); })) {
      ++score_.num_doubles;
    } else if (is_any([&](const SeenPerson& person) {
                 return !person.visible.empty() && IsOn(rest_C[i], height_px, person, camera);
               })) {
      ++score_.num_astray;
    }
  }
}

void ImageEvaluator::AddJoints(const BodyKeypoints& person, const SeenPerson& seen,
                               const StereoCamera& camera) {
  for (const int joint : seen.visible) {
    const BodyKeypoint& keypoint = person[static_cast<std::size_t>(joint)];
    if (!IsUsed(keypoint)) continue;
    const Eigen::Vector2d uv_px = camera.Project(seen.joints_C.at(joint));
    joints_.Add((keypoint.uv_px() - uv_px).norm(), seen.band);
  }
}

/// Compares a detector with the truth, frame by frame.
class DetectorEvaluator {
 public:
  void AddFrame(const PeopleOfPair& people, const TrueScene& truth, const StereoCamera& camera);
  DetectorScore Report() const {
    DetectorScore score;
    score.num_pairs = num_pairs_;
    for (std::size_t side = 0; side < kNumImages; ++side) {
      score.images[side] = images_[side].Report();
    }
    disparities_.Report(&score.disparity_px, &score.disparity_px_by_depth);
    return score;
  }

 private:
  void AddDisparities(const BodyKeypoints& left, const BodyKeypoints& right,
                      const SeenPerson& seen_left, const SeenPerson& seen_right,
                      const StereoCamera& camera);

  std::array<ImageEvaluator, kNumImages> images_;
  std::size_t num_pairs_ = 0;
  Errors disparities_;
};

void DetectorEvaluator::AddFrame(const PeopleOfPair& people, const TrueScene& truth,
                                 const StereoCamera& camera) {
  std::array<People, kNumImages> usable;
  std::array<SeenPeople, kNumImages> seen;
  std::array<Matches, kNumImages> found;
  for (const ImageSide side : {kLeftImage, kRightImage}) {
    if (!people[side]) continue;
    for (const auto& [identity, person] : truth.people) {
      seen[side][identity] = See(person, truth.T_W_C, camera, side);
    }
    usable[side] = UsableOf(*people[side]);
    found[side] = images_[side].AddImage(usable[side], seen[side], camera);
    images_[side].AddUnusable(people[side]->size() - usable[side].size());
  }
  for (const auto& [identity, index] : found[kLeftImage]) {
    const auto right = found[kRightImage].find(identity);
    if (right == found[kRightImage].end()) continue;
    ++num_pairs_;
    AddDisparities(usable[kLeftImage][index], usable[kRightImage][right->second],
                   seen[kLeftImage][identity], seen[kRightImage][identity], camera);
  }
}

void DetectorEvaluator::AddDisparities(const BodyKeypoints& left, const BodyKeypoints& right,
                                       const SeenPerson& seen_left, const SeenPerson& seen_right,
                                       const StereoCamera& camera) {
  for (const int joint : seen_left.visible) {
    const auto index = static_cast<std::size_t>(joint);
    if (seen_right.visible.count(joint) == 0) continue;
    if (!IsUsed(left[index]) || !IsUsed(right[index])) continue;
    const Eigen::Vector3d truth_px = camera.ProjectStereo(seen_left.joints_C.at(joint));
    const double true_disparity_px = truth_px[0] - truth_px[2];
    disparities_.Add(left[index].u_px - right[index].u_px - true_disparity_px, seen_left.band);
  }
}

/// Compares detected with given people in one image.
void AddAgreement(const People& detected, const People& given, const StereoCamera& camera,
                  AgreementScore* score) {
  const People usable = UsableOf(detected);
  std::map<std::int64_t, Joints> given_C;
  for (const BodyKeypoints& person : UsableOf(given)) {
    const std::optional<double> height_px = StandingHeight(person, MinConfidence());
    if (!height_px || !(*height_px > 0)) continue;
    const double depth_m = std::max(kMinPersonDepthM, camera.fy_px * kPersonHeightM / *height_px);
    given_C[static_cast<std::int64_t>(given_C.size())] = ToJoints(person, camera, depth_m);
  }
  std::set<std::int64_t> found;
  for (const auto& [index, partner] : MatchPeople(ToJoints(usable, camera), given_C)) {
    found.insert(partner);
  }
  for (const auto& [partner, joints_C] : given_C) {
    const bool is_found = found.count(partner) > 0;
    Count(is_found, &score->recall);
    Count(is_found, &score->recall_by_depth[DepthBand(MiddleDepth(joints_C))]);
  }
  ++score->num_images;
  score->num_detections += usable.size();
  score->num_without_partner += usable.size() - found.size();
}

double Per(std::size_t num, std::size_t num_images) {
  return num_images > 0 ? static_cast<double>(num) / static_cast<double>(num_images) : 0;
}

bool HasPeople(const PeopleOfPair& people) {
  return people[kLeftImage].has_value() || people[kRightImage].has_value();
}

}  // namespace

double Recall::percent() const { return 100 * Per(num_found, num_people); }

double ImageScore::false_per_image() const { return Per(num_false, num_images); }

double AgreementScore::without_partner_per_image() const {
  return Per(num_without_partner, num_images);
}

std::optional<double> StandingHeight(const BodyKeypoints& person, double min_confidence) {
  std::vector<double> heights_px;
  for (const Segment& segment : kSegments) {
    const BodyKeypoint& a = person[static_cast<std::size_t>(segment.joint_a)];
    const BodyKeypoint& b = person[static_cast<std::size_t>(segment.joint_b)];
    if (a.confidence < min_confidence || b.confidence < min_confidence) continue;
    heights_px.push_back((a.uv_px() - b.uv_px()).norm() / segment.typical_length_m *
                         kPersonHeightM);
  }
  if (heights_px.empty()) return std::nullopt;
  return Quantile(std::move(heights_px), kLimbQuantile);
}

Remarks DoubtsAbout(const DetectionReport& report) {
  std::size_t num = 0;
  std::size_t num_on_nobody = 0;
  for (std::size_t side = 0; side < kNumImages; ++side) {
    if (report.detected) {
      num += report.detected->images[side].num_detections;
      num_on_nobody += report.detected->images[side].num_false;
    } else if (report.agreement) {
      num += (*report.agreement)[side].num_detections;
      num_on_nobody += (*report.agreement)[side].num_without_partner;
    }
  }
  const double num_on_people = static_cast<double>(num - num_on_nobody);
  if (num < kMinDetectionsToJudge || num_on_people >= kFewOnPeople * static_cast<double>(num)) {
    return {};
  }
  return {{true, Format("only %zu of %zu detections are on a person: are log and data set of the "
                        "same images, left and right not exchanged?",
                        num - num_on_nobody, num)}};
}

DetectionReport EvaluateDetections(const StereoCamera& camera,
                                   const std::vector<DetectionFrame>& frames) {
  DetectionReport report;
  DetectorEvaluator detected;
  DetectorEvaluator given;
  bool has_given = false;
  std::array<AgreementScore, kNumImages> agreement;
  for (const DetectionFrame& frame : frames) {
    ++report.num_frames;
    has_given = has_given || HasPeople(frame.given);
    for (std::size_t side = 0; side < kNumImages; ++side) {
      if (!frame.detected[side] || !frame.given[side]) continue;
      AddAgreement(*frame.detected[side], *frame.given[side], camera, &agreement[side]);
    }
    if (!frame.truth) continue;
    ++report.num_frames_with_truth;
    detected.AddFrame(frame.detected, *frame.truth, camera);
    given.AddFrame(frame.given, *frame.truth, camera);
  }
  if (has_given) report.agreement = agreement;
  if (report.num_frames_with_truth == 0) return report;
  report.detected = detected.Report();
  if (has_given) report.given = given.Report();
  return report;
}

}  // namespace airdos
