#include "common/features/visual_odometry.h"

#include <algorithm>
#include <set>
#include <utility>

#include "common/features/local_mapping.h"
#include "common/geometry/covariance.h"

namespace airdos {
namespace {

std::vector<LandmarkSighting> Inliers(const std::vector<LandmarkSighting>& sightings,
                                      const PoseEstimate& estimate) {
  std::vector<LandmarkSighting> inliers;
  for (std::size_t i = 0; i < sightings.size(); ++i) {
    if (estimate.is_inlier[i]) inliers.push_back(sightings[i]);
  }
  return inliers;
}

std::set<LandmarkId> IdsOf(const std::vector<LandmarkSighting>& sightings) {
  std::set<LandmarkId> ids;
  for (const LandmarkSighting& sighting : sightings) ids.insert(sighting.id);
  return ids;
}

void Count(const StereoFrame& frame, const MeasuredPose& measured, const PeoplePose& people,
           OdometryFrame* result) {
  result->num_detected = static_cast<int>(frame.left_features().size()) + frame.num_masked();
  result->num_masked = frame.num_masked();
  result->num_matched = static_cast<int>(measured.hypothesis.matches.size());
  result->num_people = people.num_people;
}

}  // namespace

OdometryFrame VisualOdometry::Process(const StereoCamera& camera, const StereoImagePair& images) {
  OdometryFrame result;
  const StereoFrame frame(camera, images, extractor_, StereoOptions());
  const Prediction predicted = PredictMotion(images.time_s, &result);
  PeoplePose people = CorrectByPeople(images.people, predicted.prior);
  const PoseSearch search(options_, frame, map_, judge_);
  const MeasuredPose measured = search.FindBest(people.prior);
  PoseEstimate estimate = EstimateFinalPose(search, measured, predicted.prior, &people);
  AcceptOrCoast(measured.seen.sightings, people.prior, &estimate, &result);
  UpdateMotion(predicted, estimate.information + people.information, result);
  people_.Update(images.people, result.T_W_C, motion_.pose_covariance());
  Remember(images.id, images.time_s, &result);
  UpdateMap(frame, measured.seen.looked_for, &result);
  Count(frame, measured, people, &result);
  return result;
}

OdometryFrame VisualOdometry::Coast(FrameId id, double time_s) {
  OdometryFrame result;
  const Prediction predicted = PredictMotion(time_s, &result);
  result.state = recent_.empty() ? TrackingState::kInitializing : TrackingState::kCoasting;
  result.T_W_C = predicted.prior.T_W_C;
  num_static_ = 0;
  UpdateMotion(predicted, Matrix6d::Zero(), result);
  Remember(id, time_s, &result);
  return result;
}

void VisualOdometry::Apply(const MapCorrection& correction) {
  if (recent_.empty()) return;
  const Se3 T_Wold_C = LastPose();
  map_.Apply(correction);
  people_.Transform(LastPose() * T_Wold_C.inverse());
}

FeatureStereoMatcherOptions VisualOdometry::StereoOptions() const {
  FeatureStereoMatcherOptions stereo = options_.stereo;
  if (num_static_ >= options_.rich_observations) {
    stereo.min_correlation = std::max(stereo.min_correlation, options_.rich_min_correlation);
  }
  return stereo;
}

VisualOdometry::Prediction VisualOdometry::PredictMotion(double time_s, OdometryFrame* result) {
  const double step_s = StepTo(time_s);
  people_.Predict(step_s);
  result->prior_sigma_position_m = motion_.linear_sigma_m_s2() * step_s * step_s;
  result->prior_sigma_orientation_rad = motion_.angular_sigma_rad_s2() * step_s * step_s;
  return {step_s, motion_.Predict(recent_.empty() ? Se3() : LastPose(), step_s)};
}

PeoplePose VisualOdometry::CorrectByPeople(const std::vector<HumanMeasurement>& people,
                                           const PosePrior& prior) const {
  if (recent_.empty() || num_static_ >= options_.max_static_for_people) {
    return EstimatePoseFromPeople(prior, {});
  }
  return EstimatePoseFromPeople(prior, people_.Constrain(people, prior.T_W_C, prior.covariance));
}

PoseEstimate VisualOdometry::EstimateFinalPose(const PoseSearch& search,
                                               const MeasuredPose& measured, const PosePrior& prior,
                                               PeoplePose* people) const {
  const bool is_strong = measured.estimate.num_inliers >= options_.max_static_for_people;
  if (!is_strong || people->num_people == 0) return measured.estimate;
  people->num_people = 0;
  people->information.setZero();
  return search.Estimate(measured.seen.sightings, measured.hypothesis.T_W_C, prior);
}

void VisualOdometry::AcceptOrCoast(const std::vector<LandmarkSighting>& sightings,
                                   const PosePrior& prior, PoseEstimate* estimate,
                                   OdometryFrame* result) {
  const bool is_first = recent_.empty();
  num_static_ = IsBelievable(*estimate, prior) ? estimate->num_inliers : 0;
  result->state = is_first ? TrackingState::kInitializing : StateOf(num_static_);
  if (result->state == TrackingState::kCoasting) {
    estimate->T_W_C = prior.T_W_C;
    estimate->information.setZero();
  } else {
    result->sightings = Inliers(sightings, *estimate);
  }
  result->T_W_C = is_first ? Se3() : estimate->T_W_C;
}

void VisualOdometry::UpdateMotion(const Prediction& predicted, const Matrix6d& information,
                                  const OdometryFrame& result) {
  if (!is_started_) return;
  motion_.Update(predicted.prior, predicted.step_s, result.T_W_C, information,
                 result.state == TrackingState::kTracking);
}

void VisualOdometry::Remember(FrameId id, double time_s, OdometryFrame* result) {
  if (!recent_.empty()) T_O_C_ = T_O_C_ * (LastPose().inverse() * result->T_W_C);
  result->T_O_C = T_O_C_;
  map_.SetPose(id, result->T_W_C);
  recent_.push_back({id, time_s});
  if (recent_.size() > 2) recent_.pop_front();
}

void VisualOdometry::UpdateMap(const StereoFrame& frame, const std::vector<LandmarkId>& looked_for,
                               OdometryFrame* result) {
  const Se3& T_W_C = result->T_W_C;
  std::vector<LandmarkSighting>& sightings = result->sightings;
  const bool is_blind =
      result->state == TrackingState::kInitializing || result->state == TrackingState::kCoasting;
  const TrustField field =
      is_blind ? judge_.Unknown()
               : judge_.Judge(frame.camera(), T_W_C, looked_for, IdsOf(sightings), &map_);
  sightings = KeepSpread(options_, map_, std::move(sightings));
  UpdateLandmarks(frame, T_W_C, sightings, &map_);
  CreateLandmarks(options_, frame, T_W_C, motion_.pose_covariance(), field, &sightings, &map_);
  if (!is_started_) num_static_ = static_cast<int>(sightings.size());
  is_started_ = is_started_ || !map_.landmarks().empty();
  map_.Cull(frame.id());
}

double VisualOdometry::StepTo(double time_s) const {
  constexpr double kNominalStep_s = 0.1;
  if (recent_.empty()) return kNominalStep_s;
  const double step_s = time_s - recent_.back().time_s;
  const double last_step_s =
      recent_.size() < 2 ? step_s : recent_.back().time_s - recent_.front().time_s;
  // A clock that stands still or jumps says nothing of the motion: take one step as before.
  const bool is_usable = step_s > 0 && (last_step_s <= 0 || step_s < 10 * last_step_s);
  if (is_usable) return step_s;
  return last_step_s > 0 ? last_step_s : kNominalStep_s;
}

bool VisualOdometry::IsBelievable(const PoseEstimate& estimate, const PosePrior& prior) const {
  constexpr double kMaxChi2 = 22.5;  // of 6 degrees of freedom, one in a thousand
  if (estimate.num_inliers >= options_.min_inliers_tracking) return true;
  const Vector6d shift = Boxminus(estimate.T_W_C, prior.T_W_C);
  return SquaredMahalanobis(shift, prior.covariance) <= kMaxChi2;
}

TrackingState VisualOdometry::StateOf(int num_inliers) const {
  if (num_inliers >= options_.min_inliers_tracking) return TrackingState::kTracking;
  return num_inliers >= options_.min_inliers_weak ? TrackingState::kWeak : TrackingState::kCoasting;
}

}  // namespace airdos
