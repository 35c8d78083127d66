#include "common/features/landmark_sighting.h"

#include <algorithm>
#include <map>
#include <optional>
#include <utility>

#include "common/features/cell_counter.h"
#include "common/features/patch.h"

namespace airdos {
namespace {

/// A landmark that should be visible, and the corner it was matched to (or null).
struct Candidate {
  VisibleLandmark visible;
  const Feature* feature;
};

/// The landmarks off people: matched ones first, then by how often they were seen.
std::vector<Candidate> FindCandidates(const StereoFrame& frame, const LocalMap& map,
                                      const Se3& T_W_C, const std::vector<LandmarkMatch>& matches) {
  std::map<LandmarkId, const Feature*> feature_of;
  for (const LandmarkMatch& match : matches) {
    feature_of[match.landmark] = &frame.left_features()[static_cast<std::size_t>(match.feature)];
  }
  std::vector<Candidate> candidates;
  for (const VisibleLandmark& visible :
       FindVisible(map, frame.camera(), T_W_C, frame.left()->num_levels())) {
    if (frame.IsMasked(visible.uv_px)) continue;
    const auto match = feature_of.find(visible.id);
    candidates.push_back({visible, match == feature_of.end() ? nullptr : match->second});
  }
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const Candidate& a, const Candidate& b) {
                     if ((a.feature != nullptr) != (b.feature != nullptr))
                       return a.feature != nullptr;
                     return a.visible.landmark->num_seen > b.visible.landmark->num_seen;
                   });
  return candidates;
}

/// Position of the landmark's patch in the left image, in px of its level there.
std::optional<Patch::Alignment> AlignPatch(const ImagePyramid& left, const VisibleLandmark& visible,
                                           const Eigen::Vector2d& start_px) {
  constexpr double kMaxShift_px = 4;  // of the level
  const LocalLandmark& landmark = *visible.landmark;
  const ImagePyramid& reference = *landmark.reference_image;
  const Eigen::Vector2d reference_px(
      reference.ToLevel(landmark.reference_uv_px.x(), landmark.reference_level),
      reference.ToLevel(landmark.reference_uv_px.y(), landmark.reference_level));
  const std::optional<Patch> patch =
      Patch::Sample(reference.level(landmark.reference_level), reference_px, visible.patch_step_px);
  if (!patch) return std::nullopt;
  const Eigen::Vector2d start(left.ToLevel(start_px.x(), visible.level),
                              left.ToLevel(start_px.y(), visible.level));
  return patch->Align(left.level(visible.level), start, kMaxShift_px, false);
}

std::optional<LandmarkSighting> Sight(const VisualOdometryOptions& options,
                                      const StereoFrame& frame, const Candidate& candidate) {
  constexpr double kMaxRightShift_px = 3;  // of the level
  const VisibleLandmark& visible = candidate.visible;
  const Feature* feature = candidate.feature;
  const ImagePyramid& left = *frame.left();
  const int level = visible.level;
  LandmarkSighting sighting;
  sighting.id = visible.id;
  Eigen::Vector2d uv_px = feature != nullptr ? feature->uv_px : visible.uv_px;
  const std::optional<Patch::Alignment> alignment = AlignPatch(left, visible, uv_px);
  if (alignment && alignment->correlation >= options.min_correlation) {
    uv_px = {left.FromLevel(alignment->centre_px.x(), level),
             left.FromLevel(alignment->centre_px.y(), level)};
    sighting.sigma_px = options.aligned_sigma_px * left.scale(level);
  } else if (feature != nullptr) {
    sighting.sigma_px = options.corner_sigma_px * left.scale(feature->level);
  } else {
    return std::nullopt;
  }
  if (frame.IsMasked(uv_px)) return std::nullopt;
  const double u_right_guess_px =
      uv_px.x() - frame.camera().fx_px * frame.camera().baseline_m / visible.p_C.z();
  const auto u_right_px = frame.stereo().Refine(uv_px, level, u_right_guess_px, kMaxRightShift_px);
  sighting.has_right = u_right_px.has_value();
  sighting.uvu_px = {uv_px.x(), uv_px.y(), u_right_px.value_or(0)};
  return sighting;
}

bool HasLowerId(const LandmarkSighting& a, const LandmarkSighting& b) { return a.id < b.id; }

}  // namespace

SightedLandmarks SightLandmarks(const VisualOdometryOptions& options, const StereoFrame& frame,
                                const LocalMap& map, const Se3& T_W_C,
                                const std::vector<LandmarkMatch>& matches) {
  CellCounter cells(options.observation_cell_px);
  SightedLandmarks seen;
  for (const Candidate& candidate : FindCandidates(frame, map, T_W_C, matches)) {
    if (!cells.Take(candidate.visible.uv_px, kMaxTriedPerCell)) continue;
    seen.looked_for.push_back(candidate.visible.id);
    if (const auto sighting = Sight(options, frame, candidate)) seen.sightings.push_back(*sighting);
  }
  std::sort(seen.sightings.begin(), seen.sightings.end(), HasLowerId);
  return seen;
}

std::vector<LandmarkSighting> KeepSpread(const VisualOdometryOptions& options, const LocalMap& map,
                                         std::vector<LandmarkSighting> sightings) {
  std::stable_sort(sightings.begin(), sightings.end(), [&map](const auto& a, const auto& b) {
    return map.landmarks().at(a.id).num_seen > map.landmarks().at(b.id).num_seen;
  });
  CellCounter cells(options.observation_cell_px);
  std::vector<LandmarkSighting> kept;
  for (const LandmarkSighting& sighting : sightings) {
    if (kept.size() >= static_cast<std::size_t>(options.max_observations)) break;
    if (cells.Take(sighting.uvu_px.head<2>(), kMaxObservationsPerCell)) kept.push_back(sighting);
  }
  std::sort(kept.begin(), kept.end(), HasLowerId);
  return kept;
}

}  // namespace airdos
