#include "common/features/visual_odometry.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <set>

#include "common/features/patch.h"
#include "common/features/pose_score.h"
#include "common/util/check.h"

namespace airdos {
namespace {

constexpr int kRecentFrames = 3;     // landmarks of so many frames are searched in the whole image
constexpr int kMaxPerCell = 2;       // observed landmarks
constexpr int kMaxTriedPerCell = 4;  // landmarks or corners that are looked for to get there

/// Counts what lies in each square cell of the image.
class CellCounter {
 public:
  explicit CellCounter(int cell_size_px) : cell_size_px_(cell_size_px) {}
  bool IsFull(const Eigen::Vector2d& uv_px, int limit) const {
    const auto it = counts_.find(CellOf(uv_px));
    return it != counts_.end() && it->second >= limit;
  }
  /// False where the cell is full.
  bool Take(const Eigen::Vector2d& uv_px, int limit) {
    int& count = counts_[CellOf(uv_px)];
    return count < limit && ++count > 0;
  }

 private:
  std::pair<int, int> CellOf(const Eigen::Vector2d& uv_px) const {
    return {static_cast<int>(uv_px.x()) / cell_size_px_,
            static_cast<int>(uv_px.y()) / cell_size_px_};
  }
  int cell_size_px_;
  std::map<std::pair<int, int>, int> counts_;
};

bool IsMasked(const cv::Mat& mask, const Eigen::Vector2d& uv_px) {
  if (mask.empty()) return false;
  const int u = std::clamp(static_cast<int>(std::lround(uv_px.x())), 0, mask.cols - 1);
  const int v = std::clamp(static_cast<int>(std::lround(uv_px.y())), 0, mask.rows - 1);
  return mask.at<uchar>(v, u) != 0;
}

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

struct VisualOdometry::View {
  const StereoCamera& camera;
  const StereoImagePair& images;
  std::shared_ptr<const ImagePyramid> left;
  ImagePyramid right;
  std::vector<Feature> left_features;
  std::vector<Feature> right_features;
  std::unique_ptr<FeatureGrid> grid;
  std::unique_ptr<FeatureStereoMatcher> stereo;
  int num_masked = 0;

  View(const StereoCamera& camera_in, const StereoImagePair& images_in,
       const VisualOdometryOptions& options, const FeatureExtractor& extractor)
      : camera(camera_in),
        images(images_in),
        left(std::make_shared<ImagePyramid>(images_in.left, options.extractor.num_levels)),
        right(images_in.right, options.extractor.num_levels) {
    int num_masked_right = 0;
    left_features = extractor.Extract(*left, images.mask, &num_masked);
    right_features = extractor.Extract(right, cv::Mat(), &num_masked_right);
    grid = std::make_unique<FeatureGrid>(left_features, camera.width, camera.height);
    stereo = std::make_unique<FeatureStereoMatcher>(options.stereo, camera, *left, right,
                                                    right_features);
  }
};

OdometryFrame VisualOdometry::Process(const StereoCamera& camera, const StereoImagePair& images) {
  AIRDOS_CHECK(images.left.cols == camera.width && images.left.rows == camera.height);
  AIRDOS_CHECK(images.right.size() == images.left.size());
  const View view(camera, images, options_, extractor_);
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
  const TrustField field =
      is_first || frame.state == TrackingState::kCoasting
          ? judge_.Unknown()
          : judge_.Judge(camera, frame.T_W_C, best.tried, IdsOf(frame.sightings), &map_);
  frame.sightings = KeepSpread(std::move(frame.sightings));

  UpdateLandmarks(view, frame.T_W_C, frame.sightings);
  if (is_started_) {
    if (!is_strong) estimate.information += with_people.information;
    motion_.Update(prior, step_s, frame.T_W_C, estimate.information,
                   frame.state == TrackingState::kTracking);
  }
  people_.Update(images.people, frame.T_W_C, motion_.pose_covariance());
  Remember(images.id, images.time_s, &frame);
  CreateLandmarks(view, frame.T_W_C, field, &frame.sightings);
  if (!is_started_) num_static_ = static_cast<int>(frame.sightings.size());
  is_started_ = is_started_ || !map_.landmarks().empty();
  map_.Cull(images.id);
  return frame;
}

VisualOdometry::Tracking VisualOdometry::Track(const View& view, const PosePrior& prior) const {
  const ProjectionSearch wide{options_.wide_radius_px, options_.wide_max_hamming, 0.9};
  const ProjectionSearch narrow{8, options_.narrow_max_hamming, 0.9};
  Tracking best = Measure(view, TrackFrom(view, prior.T_W_C, wide, prior), prior);
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
    if (pass < 2) search = {kNarrowRadii_px[pass], options_.narrow_max_hamming, 0.95};
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
      MatchByDescriptor(candidates, view.left_features, options_.wide_max_hamming, 0.85);
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

std::vector<LandmarkSighting> VisualOdometry::Sight(const View& view, const Hypothesis& hypothesis,
                                                    std::vector<LandmarkId>* tried) const {
  struct Candidate {
    VisibleLandmark visible;
    const Feature* feature;
  };
  std::map<LandmarkId, const Feature*> feature_of;
  for (const LandmarkMatch& match : hypothesis.matches) {
    feature_of[match.landmark] = &view.left_features[static_cast<std::size_t>(match.feature)];
  }
  std::vector<Candidate> candidates;
  for (const VisibleLandmark& visible :
       FindVisible(map_, view.camera, hypothesis.T_W_C, view.left->num_levels())) {
    if (IsMasked(view.images.mask, visible.uv_px)) continue;
    const auto match = feature_of.find(visible.id);
    candidates.push_back({visible, match == feature_of.end() ? nullptr : match->second});
  }
  // Where many landmarks crowd, a few are enough: first those that were matched, then the longest
  // known.
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const Candidate& a, const Candidate& b) {
                     if ((a.feature != nullptr) != (b.feature != nullptr))
                       return a.feature != nullptr;
                     return a.visible.landmark->num_seen > b.visible.landmark->num_seen;
                   });
  CellCounter cells(options_.observation_cell_px);
  std::vector<LandmarkSighting> sightings;
  for (const Candidate& candidate : candidates) {
    if (!cells.Take(candidate.visible.uv_px, kMaxTriedPerCell)) continue;
    // Of a pose that nothing supports it cannot be said what should be in view.
    if (hypothesis.num_inliers >= options_.min_inliers_weak) tried->push_back(candidate.visible.id);
    if (const auto sighting = SightOne(view, candidate.visible, candidate.feature))
      sightings.push_back(*sighting);
  }
  std::sort(sightings.begin(), sightings.end(),
            [](const auto& a, const auto& b) { return a.id < b.id; });
  return sightings;
}

std::optional<LandmarkSighting> VisualOdometry::SightOne(const View& view,
                                                         const VisibleLandmark& visible,
                                                         const Feature* feature) const {
  constexpr double kMaxShift_px = 4;       // of the level
  constexpr double kMaxRightShift_px = 3;  // of the level
  const LocalLandmark& landmark = *visible.landmark;
  const int level = visible.level;
  LandmarkSighting sighting;
  sighting.id = visible.id;
  Eigen::Vector2d uv_px = feature != nullptr ? feature->uv_px : visible.uv_px;
  const ImagePyramid& reference = *landmark.reference_image;
  const Eigen::Vector2d reference_px(
      reference.ToLevel(landmark.reference_uv_px.x(), landmark.reference_level),
      reference.ToLevel(landmark.reference_uv_px.y(), landmark.reference_level));
  const std::optional<Patch> patch =
      Patch::Sample(reference.level(landmark.reference_level), reference_px, visible.patch_step_px);
  std::optional<Patch::Alignment> alignment;
  if (patch) {
    const Eigen::Vector2d start(view.left->ToLevel(uv_px.x(), level),
                                view.left->ToLevel(uv_px.y(), level));
    alignment = patch->Align(view.left->level(level), start, kMaxShift_px, false);
  }
  if (alignment && alignment->correlation >= options_.min_correlation) {
    uv_px = {view.left->FromLevel(alignment->centre_px.x(), level),
             view.left->FromLevel(alignment->centre_px.y(), level)};
    sighting.sigma_px = options_.aligned_sigma_px * view.left->scale(level);
  } else if (feature != nullptr) {
    sighting.sigma_px = options_.corner_sigma_px * view.left->scale(feature->level);
  } else {
    return std::nullopt;
  }
  if (IsMasked(view.images.mask, uv_px)) return std::nullopt;
  const double u_right_guess =
      uv_px.x() - view.camera.fx_px * view.camera.baseline_m / visible.p_C.z();
  const auto u_right_px = view.stereo->Refine(uv_px, level, u_right_guess, kMaxRightShift_px);
  sighting.has_right = u_right_px.has_value();
  sighting.uvu_px = {uv_px.x(), uv_px.y(), u_right_px.value_or(0)};
  return sighting;
}

std::vector<LandmarkSighting> VisualOdometry::KeepSpread(
    std::vector<LandmarkSighting> sightings) const {
  // The longest known first: they tie the new frames to the old ones.
  std::stable_sort(sightings.begin(), sightings.end(), [this](const auto& a, const auto& b) {
    return map_.landmarks().at(a.id).num_seen > map_.landmarks().at(b.id).num_seen;
  });
  CellCounter cells(options_.observation_cell_px);
  std::vector<LandmarkSighting> kept;
  for (const LandmarkSighting& sighting : sightings) {
    if (kept.size() >= static_cast<std::size_t>(options_.max_observations)) break;
    if (cells.Take(sighting.uvu_px.head<2>(), kMaxPerCell)) kept.push_back(sighting);
  }
  std::sort(kept.begin(), kept.end(), [](const auto& a, const auto& b) { return a.id < b.id; });
  return kept;
}

void VisualOdometry::UpdateLandmarks(const View& view, const Se3& T_W_C,
                                     const std::vector<LandmarkSighting>& sightings) {
  constexpr double kMinDepthRatio = 0.85;
  constexpr double kMaxDepthRatio = 1.18;
  const Se3 T_C_W = T_W_C.inverse();
  for (const LandmarkSighting& sighting : sightings) {
    LocalLandmark& landmark = map_.landmarks().at(sighting.id);
    landmark.last_seen = view.images.id;
    ++landmark.num_seen;
    const Eigen::Vector3d p_C = T_C_W * landmark.p_W;
    const double depth_ratio = p_C.z() / landmark.p_C_reference.z();
    if (depth_ratio > kMinDepthRatio && depth_ratio < kMaxDepthRatio) continue;
    // It looks too different by now: from here on it is known by how it looks in this frame.
    const double level_change = -std::log(depth_ratio) / std::log(ImagePyramid::kScaleFactor);
    landmark.reference_level =
        std::clamp(landmark.reference_level + static_cast<int>(std::lround(level_change)), 0,
                   view.left->num_levels() - 1);
    landmark.reference_frame = view.images.id;
    landmark.reference_image = view.left;
    landmark.reference_uv_px = sighting.uvu_px.head<2>();
    landmark.p_C_reference = p_C;
  }
}

void VisualOdometry::CreateLandmarks(const View& view, const Se3& T_W_C, const TrustField& field,
                                     std::vector<LandmarkSighting>* sightings) {
  CellCounter cells(options_.observation_cell_px);
  for (const LandmarkSighting& sighting : *sightings)
    cells.Take(sighting.uvu_px.head<2>(), kMaxPerCell);
  std::vector<const Feature*> by_response;
  for (const Feature& feature : view.left_features) by_response.push_back(&feature);
  std::stable_sort(by_response.begin(), by_response.end(),
                   [](const Feature* a, const Feature* b) { return a->response > b->response; });
  CellCounter tried(options_.observation_cell_px);
  for (const Feature* feature : by_response) {
    if (sightings->size() >= static_cast<std::size_t>(options_.max_observations)) return;
    if (cells.IsFull(feature->uv_px, kMaxPerCell) || !tried.Take(feature->uv_px, kMaxTriedPerCell))
      continue;
    const std::optional<double> u_right_px = view.stereo->Match(*feature);
    if (!u_right_px) continue;
    const auto p_C = view.camera.Triangulate(feature->uv_px.x(), feature->uv_px.y(), *u_right_px);
    if (!p_C) continue;
    cells.Take(feature->uv_px, kMaxPerCell);
    LocalLandmark landmark;
    landmark.p_W = T_W_C * *p_C;
    landmark.created_covariance_W = CreatedCovariance(
        view.camera, T_W_C, *p_C, options_.aligned_sigma_px * view.left->scale(feature->level));
    landmark.reference_frame = view.images.id;
    landmark.p_C_reference = *p_C;
    landmark.reference_image = view.left;
    landmark.reference_uv_px = feature->uv_px;
    landmark.reference_level = feature->level;
    landmark.descriptor = feature->descriptor;
    landmark.trust = LandmarkTrust(field.At(feature->uv_px, p_C->z()));
    landmark.last_seen = view.images.id;
    landmark.num_seen = 1;
    landmark.num_expected = 1;
    const LandmarkId id = map_.Add(std::move(landmark));
    sightings->push_back({id,
                          {feature->uv_px.x(), feature->uv_px.y(), *u_right_px},
                          true,
                          options_.aligned_sigma_px * view.left->scale(feature->level)});
  }
}

Eigen::Matrix3d VisualOdometry::CreatedCovariance(const StereoCamera& camera, const Se3& T_W_C,
                                                  const Eigen::Vector3d& p_C,
                                                  double sigma_px) const {
  Eigen::Matrix<double, 3, 6> J;  // of the point in C by the tangent of the pose
  J << Eigen::Matrix3d::Identity(), -Skew(p_C);
  const Eigen::Matrix3d R_W_C = T_W_C.rotation.toRotationMatrix();
  return R_W_C *
         (camera.TriangulationCovariance(p_C, sigma_px) +
          J * motion_.pose_covariance() * J.transpose()) *
         R_W_C.transpose();
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
