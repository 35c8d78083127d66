#include "common/features/visual_odometry.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <set>

#include "common/features/pose_score.h"
#include "common/features/visual_odometry_view.h"
#include "common/util/check.h"

namespace airdos {
namespace {

constexpr int kRecentFrames = 3;  // landmarks of so many frames are searched in the whole image

std::vector<LandmarkSighting> Inliers(const std::vector<LandmarkSighting>& sightings,
                                      const PoseEstimate& estimate) {
  std::vector<LandmarkSighting> inliers;
  for (std::size_t i = 0; i < sightings.size(); ++i) {
    if (estimate.is_inlier[i]) inliers.push_back(sightings[i]);
  }
  return inliers;
}

/// Each frame that sees a landmark makes it better known. Where many are seen at once their errors
/// cancel, and the optimizer soon knows them better than this does.
Eigen::Matrix3d CovarianceOf(const LocalLandmark& landmark, std::size_t num_seen_at_once) {
  constexpr std::size_t kMany = 30;
  if (num_seen_at_once >= kMany) return Eigen::Matrix3d::Zero();
  return landmark.created_covariance_W / landmark.num_seen;
}

/// In an estimate of the pose. Less than the trust: the doubtful ones err together.
double WeightOf(double relative_trust) { return relative_trust * relative_trust; }

std::set<LandmarkId> IdsOf(const std::vector<LandmarkSighting>& sightings) {
  std::set<LandmarkId> ids;
  for (const LandmarkSighting& sighting : sightings) ids.insert(sighting.id);
  return ids;
}

}  // namespace

OdometryFrame VisualOdometry::Process(const StereoCamera& camera, const StereoImagePair& images) {
  AIRDOS_CHECK(images.left.cols == camera.width && images.left.rows == camera.height);
  AIRDOS_CHECK(images.right.size() == images.left.size());
  const View view(camera, images, options_, StereoOptions(), extractor_);
  const bool is_first = recent_.empty();
  const double step_s = StepTo(images.time_s);
  const PosePrior prior = Predict(step_s);
  people_.Predict(step_s);

  OdometryFrame frame;
  DescribePrior(step_s, &frame);
  frame.num_detected = static_cast<int>(view.left_features.size()) + view.num_masked;
  frame.num_masked = view.num_masked;

  const std::vector<PersonConstraint> people = Constraints(images, prior);
  const PeoplePose with_people = EstimatePoseFromPeople(prior, people);
  const Tracking best = Track(view, with_people.prior);
  PoseEstimate estimate = best.estimate;
  frame.num_matched = static_cast<int>(best.hypothesis.matches.size());
  const bool is_strong = estimate.num_inliers >= options_.max_static_for_people;
  if (is_strong && !people.empty()) {
    estimate = EstimateFromSightings(camera, best.sightings, best.hypothesis.T_W_C, prior);
  }
  frame.num_people = is_strong ? 0 : static_cast<int>(people.size());
  const bool is_believed = IsBelievable(estimate, with_people.prior);
  num_static_ = is_believed ? estimate.num_inliers : 0;
  frame.state = is_first ? TrackingState::kInitializing : StateOf(num_static_);
  frame.sightings = Inliers(best.sightings, estimate);
  if (frame.state == TrackingState::kCoasting) {
    frame.sightings.clear();
    estimate.T_W_C = with_people.prior.T_W_C;
    estimate.information.setZero();
  }
  frame.T_W_C = is_first ? Se3() : estimate.T_W_C;
  if (is_started_) {
    if (!is_strong) estimate.information += with_people.information;
    motion_.Update(prior, step_s, frame.T_W_C, estimate.information,
                   frame.state == TrackingState::kTracking);
  }
  people_.Update(images.people, frame.T_W_C, motion_.pose_covariance());
  UpdateMap(view, best.tried, &frame);
  return frame;
}

void VisualOdometry::UpdateMap(const View& view, const std::vector<LandmarkId>& tried,
                               OdometryFrame* frame) {
  const bool is_blind = recent_.empty() || frame->state == TrackingState::kCoasting;
  const TrustField field =
      is_blind ? judge_.Unknown()
               : judge_.Judge(view.camera, frame->T_W_C, tried, IdsOf(frame->sightings), &map_);
  frame->sightings = KeepSpread(std::move(frame->sightings));
  UpdateLandmarks(view, frame->T_W_C, frame->sightings);
  Remember(view.images.id, view.images.time_s, frame);
  CreateLandmarks(view, frame->T_W_C, field, &frame->sightings);
  if (!is_started_) num_static_ = static_cast<int>(frame->sightings.size());
  is_started_ = is_started_ || !map_.landmarks().empty();
  map_.Cull(view.images.id);
}

VisualOdometry::Tracking VisualOdometry::Track(const View& view, const PosePrior& prior) const {
  const ProjectionSearch wide{options_.wide_radius_px, options_.wide_max_hamming_bits, 0.9};
  const ProjectionSearch narrow{8, options_.narrow_max_hamming_bits, 0.9};
  Tracking best = Measure(view, TrackFrom(view, prior.T_W_C, wide, prior), prior);
  // With so many that agree no other pose has as many. A frame of few landmarks gets both tries.
  if (best.score >= options_.rich_observations) return best;
  const std::optional<Se3> relocated = Relocate(view);
  if (!relocated) return best;
  Hypothesis other = TrackFrom(view, *relocated, narrow, std::nullopt);
  if (best.hypothesis.matches == other.matches) return best;
  Tracking other_measured = Measure(view, std::move(other), prior);
  return other_measured.score > best.score ? other_measured : best;
}

VisualOdometry::Tracking VisualOdometry::Measure(const View& view, Hypothesis hypothesis,
                                                 const PosePrior& prior) const {
  Tracking tracking;
  tracking.sightings = Sight(view, hypothesis, &tracking.tried);
  if (tracking.sightings.size() > static_cast<std::size_t>(options_.max_observations)) {
    tracking.sightings = KeepSpread(std::move(tracking.sightings));
  }
  std::vector<double> trust;
  for (const LandmarkSighting& sighting : tracking.sightings) {
    trust.push_back(judge_.RelativeTrust(map_.landmarks().at(sighting.id).trust));
  }
  tracking.estimate =
      EstimateFromSightings(view.camera, tracking.sightings, hypothesis.T_W_C, prior);
  tracking.score = ScorePose(tracking.estimate, trust, prior);
  tracking.hypothesis = std::move(hypothesis);
  return tracking;
}

OdometryFrame VisualOdometry::Coast(FrameId id, double time_s) {
  OdometryFrame frame;
  const bool is_first = recent_.empty();
  const double step_s = StepTo(time_s);
  const PosePrior prior = Predict(step_s);
  people_.Predict(step_s);
  DescribePrior(step_s, &frame);
  frame.state = is_first ? TrackingState::kInitializing : TrackingState::kCoasting;
  frame.T_W_C = prior.T_W_C;
  num_static_ = 0;
  if (is_started_) motion_.Update(prior, step_s, frame.T_W_C, Matrix6d::Zero(), false);
  Remember(id, time_s, &frame);
  return frame;
}

void VisualOdometry::Apply(const MapCorrection& correction) {
  if (recent_.empty()) return;
  const Se3 T_Wold_C = map_.poses_W_C().at(recent_.back().first);
  map_.Apply(correction);
  people_.Transform(map_.poses_W_C().at(recent_.back().first) * T_Wold_C.inverse());
}

FeatureStereoMatcherOptions VisualOdometry::StereoOptions() const {
  FeatureStereoMatcherOptions stereo = options_.stereo;
  if (num_static_ >= options_.rich_observations) {
    stereo.min_correlation = std::max(stereo.min_correlation, options_.rich_min_correlation);
  }
  return stereo;
}

double VisualOdometry::StepTo(double time_s) const {
  constexpr double kNominalStep_s = 0.1;
  if (recent_.empty()) return kNominalStep_s;
  const double step_s = time_s - recent_.back().second;
  const double last_step_s =
      recent_.size() < 2 ? step_s : recent_.back().second - recent_[recent_.size() - 2].second;
  // A clock that stands still or jumps says nothing of the motion: take one step as before.
  const bool is_usable = step_s > 0 && (last_step_s <= 0 || step_s < 10 * last_step_s);
  if (is_usable) return step_s;
  return last_step_s > 0 ? last_step_s : kNominalStep_s;
}

PosePrior VisualOdometry::Predict(double step_s) const {
  if (recent_.empty()) return motion_.Predict(Se3(), step_s);
  return motion_.Predict(map_.poses_W_C().at(recent_.back().first), step_s);
}

void VisualOdometry::DescribePrior(double step_s, OdometryFrame* frame) const {
  frame->prior_sigma_position_m = motion_.linear_sigma_m_s2() * step_s * step_s;
  frame->prior_sigma_orientation_rad = motion_.angular_sigma_rad_s2() * step_s * step_s;
}

std::vector<PersonConstraint> VisualOdometry::Constraints(const StereoImagePair& images,
                                                          const PosePrior& prior) const {
  if (recent_.empty() || num_static_ >= options_.max_static_for_people) return {};
  return people_.Constrain(images.people, prior.T_W_C, prior.covariance);
}

VisualOdometry::Hypothesis VisualOdometry::TrackFrom(const View& view, const Se3& start,
                                                     const ProjectionSearch& first,
                                                     const std::optional<PosePrior>& prior) const {
  constexpr double kNarrowRadii_px[] = {8, 4};
  Hypothesis hypothesis{start, {}, 0};
  ProjectionSearch search = first;
  for (int pass = 0; pass < 3; ++pass) {
    const auto visible = FindVisible(map_, view.camera, hypothesis.T_W_C, view.left->num_levels());
    hypothesis.matches = MatchByProjection(visible, view.left_features, *view.grid, search);
    const PoseEstimate estimate =
        EstimateFromMatches(view, hypothesis.matches, hypothesis.T_W_C, prior);
    hypothesis.num_inliers = estimate.num_inliers;
    if (estimate.num_inliers >= options_.min_inliers_weak) hypothesis.T_W_C = estimate.T_W_C;
    std::vector<LandmarkMatch> inliers;
    for (std::size_t i = 0; i < hypothesis.matches.size(); ++i) {
      if (!estimate.is_inlier[i]) continue;
      inliers.push_back(hypothesis.matches[i]);
    }
    hypothesis.matches = std::move(inliers);
    if (pass < 2) search = {kNarrowRadii_px[pass], options_.narrow_max_hamming_bits, 0.95};
  }
  return hypothesis;
}

std::optional<Se3> VisualOdometry::Relocate(const View& view) const {
  constexpr double kRansacError_px = 4;
  if (recent_.empty()) return std::nullopt;
  // The last frames that saw anything, however long ago: after a blackout they are all there is.
  std::set<FrameId> frames;
  for (const auto& [id, landmark] : map_.landmarks()) frames.insert(landmark.last_seen);
  while (frames.size() > static_cast<std::size_t>(kRecentFrames)) frames.erase(frames.begin());
  if (frames.empty()) return std::nullopt;
  const FrameId oldest = *frames.begin();
  std::vector<std::pair<LandmarkId, const LocalLandmark*>> candidates;
  for (const auto& [id, landmark] : map_.landmarks()) {
    if (!(landmark.last_seen < oldest)) candidates.emplace_back(id, &landmark);
  }
  const std::vector<LandmarkMatch> matches =
      MatchByDescriptor(candidates, view.left_features, options_.wide_max_hamming_bits, 0.85);
  std::vector<PoseObservation> observations;
  for (const LandmarkMatch& match : matches) {
    const Feature& feature = view.left_features[static_cast<std::size_t>(match.feature)];
    observations.push_back(
        {map_.landmarks().at(match.landmark).p_W, {feature.uv_px.x(), feature.uv_px.y(), 0}});
  }
  return EstimatePoseRansac(view.camera, observations, kRansacError_px);
}

PoseEstimate VisualOdometry::EstimateFromMatches(const View& view,
                                                 const std::vector<LandmarkMatch>& matches,
                                                 const Se3& start,
                                                 const std::optional<PosePrior>& prior) const {
  std::vector<PoseObservation> observations;
  for (const LandmarkMatch& match : matches) {
    const Feature& feature = view.left_features[static_cast<std::size_t>(match.feature)];
    const LocalLandmark& landmark = map_.landmarks().at(match.landmark);
    observations.push_back({landmark.p_W,
                            {feature.uv_px.x(), feature.uv_px.y(), 0},
                            false,
                            2 * options_.corner_sigma_px * view.left->scale(feature.level),
                            WeightOf(judge_.RelativeTrust(landmark.trust)),
                            CovarianceOf(landmark, matches.size())});
  }
  return EstimatePose(view.camera, observations, start, prior);
}

PoseEstimate VisualOdometry::EstimateFromSightings(const StereoCamera& camera,
                                                   const std::vector<LandmarkSighting>& sightings,
                                                   const Se3& start, const PosePrior& prior) const {
  std::vector<PoseObservation> observations;
  for (const LandmarkSighting& sighting : sightings) {
    const LocalLandmark& landmark = map_.landmarks().at(sighting.id);
    observations.push_back({landmark.p_W, sighting.uvu_px, sighting.has_right, sighting.sigma_px,
                            WeightOf(judge_.RelativeTrust(landmark.trust)),
                            CovarianceOf(landmark, sightings.size())});
  }
  return EstimatePose(camera, observations, start, prior);
}

void VisualOdometry::Remember(FrameId id, double time_s, OdometryFrame* frame) {
  const Se3& T_W_C = frame->T_W_C;
  if (!recent_.empty()) {
    T_O_C_ = T_O_C_ * (map_.poses_W_C().at(recent_.back().first).inverse() * T_W_C);
  }
  frame->T_O_C = T_O_C_;
  map_.SetPose(id, T_W_C);
  recent_.emplace_back(id, time_s);
  if (recent_.size() > kRecentFrames) recent_.pop_front();
}

bool VisualOdometry::IsBelievable(const PoseEstimate& estimate, const PosePrior& prior) const {
  constexpr double kMaxChi2 = 22.5;  // of 6 degrees of freedom, one in a thousand
  if (estimate.num_inliers >= options_.min_inliers_tracking) return true;
  const Vector6d shift = Boxminus(estimate.T_W_C, prior.T_W_C);
  return shift.dot(prior.covariance.ldlt().solve(shift)) <= kMaxChi2;
}

TrackingState VisualOdometry::StateOf(int num_inliers) const {
  if (num_inliers >= options_.min_inliers_tracking) return TrackingState::kTracking;
  return num_inliers >= options_.min_inliers_weak ? TrackingState::kWeak : TrackingState::kCoasting;
}

}  // namespace airdos
