#include "common/features/pose_search.h"

#include <cstddef>
#include <set>
#include <utility>

#include "common/features/pose_score.h"

namespace airdos {
namespace {

constexpr std::size_t kRecentFrames = 3;  // whose landmarks are searched in the whole image

/// Each frame that sees a landmark makes it better known. Where many are seen at once their errors
/// cancel, and the optimizer soon knows them better than this does.
Eigen::Matrix3d CovarianceOf(const LocalLandmark& landmark, std::size_t num_seen_at_once) {
  constexpr std::size_t kMany = 30;
  if (num_seen_at_once >= kMany) return Eigen::Matrix3d::Zero();
  return landmark.created_covariance_W / landmark.num_seen;
}

/// In an estimate of the pose. Less than the trust: the doubtful ones err together.
double WeightOf(double relative_trust) { return relative_trust * relative_trust; }

/// The landmarks last seen in the newest frames that saw any, however long ago: after a blackout
/// there are no others.
std::vector<std::pair<LandmarkId, const LocalLandmark*>> RecentLandmarks(const LocalMap& map) {
  std::set<FrameId> frames;
  for (const auto& [id, landmark] : map.landmarks()) frames.insert(landmark.last_seen);
  while (frames.size() > kRecentFrames) frames.erase(frames.begin());
  std::vector<std::pair<LandmarkId, const LocalLandmark*>> recent;
  for (const auto& [id, landmark] : map.landmarks()) {
    if (!(landmark.last_seen < *frames.begin())) recent.emplace_back(id, &landmark);
  }
  return recent;
}

}  // namespace

MeasuredPose PoseSearch::FindBest(const PosePrior& prior) const {
  const ProjectionSearch wide{options_.wide_radius_px, options_.wide_max_hamming_bits, 0.9};
  const ProjectionSearch narrow{8, options_.narrow_max_hamming_bits, 0.9};
  MeasuredPose best = Measure(TrackFrom(prior.T_W_C, wide, prior), prior);
  // With this many that agree no other pose has more. A frame of few landmarks gets both tries.
  if (best.score >= options_.rich_observations) return best;
  const std::optional<Se3> relocated = Relocate();
  if (!relocated) return best;
  PoseHypothesis other = TrackFrom(*relocated, narrow, std::nullopt);
  if (best.hypothesis.matches == other.matches) return best;
  MeasuredPose other_measured = Measure(std::move(other), prior);
  return other_measured.score > best.score ? other_measured : best;
}

MeasuredPose PoseSearch::Measure(PoseHypothesis hypothesis, const PosePrior& prior) const {
  MeasuredPose measured;
  measured.seen = SightLandmarks(options_, frame_, map_, hypothesis.T_W_C, hypothesis.matches);
  // Of a pose that nothing supports it cannot be said what should be in view.
  if (hypothesis.num_inliers < options_.min_inliers_weak) measured.seen.looked_for.clear();
  std::vector<LandmarkSighting>& sightings = measured.seen.sightings;
  if (sightings.size() > static_cast<std::size_t>(options_.max_observations)) {
    sightings = KeepSpread(options_, map_, std::move(sightings));
  }
  std::vector<double> trust;
  for (const LandmarkSighting& sighting : sightings) {
    trust.push_back(judge_.RelativeTrust(map_.landmarks().at(sighting.id).trust));
  }
  measured.estimate = Estimate(sightings, hypothesis.T_W_C, prior);
  measured.score = ScorePose(measured.estimate, trust, prior);
  measured.hypothesis = std::move(hypothesis);
  return measured;
}

PoseHypothesis PoseSearch::TrackFrom(const Se3& start, const ProjectionSearch& first,
                                     const std::optional<PosePrior>& prior) const {
  constexpr double kNarrowRadii_px[] = {8, 4};
  PoseHypothesis hypothesis{start, {}, 0};
  ProjectionSearch search = first;
  for (int pass = 0; pass < 3; ++pass) {
    const auto visible =
        FindVisible(map_, frame_.camera(), hypothesis.T_W_C, frame_.left()->num_levels());
    hypothesis.matches = MatchByProjection(visible, frame_.left_features(), frame_.grid(), search);
    const PoseEstimate estimate = EstimateFromMatches(hypothesis.matches, hypothesis.T_W_C, prior);
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

std::optional<Se3> PoseSearch::Relocate() const {
  constexpr double kRansacError_px = 4;
  const std::vector<LandmarkMatch> matches = MatchByDescriptor(
      RecentLandmarks(map_), frame_.left_features(), options_.wide_max_hamming_bits, 0.85);
  std::vector<PoseObservation> observations;
  for (const LandmarkMatch& match : matches) {
    const Feature& feature = frame_.left_features()[static_cast<std::size_t>(match.feature)];
    observations.push_back(
        {map_.landmarks().at(match.landmark).p_W, {feature.uv_px.x(), feature.uv_px.y(), 0}});
  }
  return EstimatePoseRansac(frame_.camera(), observations, kRansacError_px);
}

PoseEstimate PoseSearch::EstimateFromMatches(const std::vector<LandmarkMatch>& matches,
                                             const Se3& start,
                                             const std::optional<PosePrior>& prior) const {
  std::vector<PoseObservation> observations;
  for (const LandmarkMatch& match : matches) {
    const Feature& feature = frame_.left_features()[static_cast<std::size_t>(match.feature)];
    const LocalLandmark& landmark = map_.landmarks().at(match.landmark);
    observations.push_back({landmark.p_W,
                            {feature.uv_px.x(), feature.uv_px.y(), 0},
                            false,
                            2 * options_.corner_sigma_px * frame_.left()->scale(feature.level),
                            WeightOf(judge_.RelativeTrust(landmark.trust)),
                            CovarianceOf(landmark, matches.size())});
  }
  return EstimatePose(frame_.camera(), observations, start, prior);
}

PoseEstimate PoseSearch::Estimate(const std::vector<LandmarkSighting>& sightings, const Se3& start,
                                  const PosePrior& prior) const {
  std::vector<PoseObservation> observations;
  for (const LandmarkSighting& sighting : sightings) {
    const LocalLandmark& landmark = map_.landmarks().at(sighting.id);
    observations.push_back({landmark.p_W, sighting.uvu_px, sighting.has_right, sighting.sigma_px,
                            WeightOf(judge_.RelativeTrust(landmark.trust)),
                            CovarianceOf(landmark, sightings.size())});
  }
  return EstimatePose(frame_.camera(), observations, start, prior);
}

}  // namespace airdos
