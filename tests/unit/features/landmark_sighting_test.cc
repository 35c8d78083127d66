#include "common/features/landmark_sighting.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "tests/support/walked_frame.h"

namespace airdos {
namespace {

const StereoCamera kCamera = SmallStereoCamera();

TEST(LandmarkSighting, LandmarksAreFoundWhereTheyProjectWithoutAnyMatch) {
  const LocalMap map = MapOfFirstFrame();
  const WalkedFrame frame(1);
  const Se3 T_W_C = WalkedFrame::Truth(1);
  const SightedLandmarks seen = SightLandmarks({}, *frame, map, T_W_C, {});
  ASSERT_GT(seen.looked_for.size(), 60u);
  EXPECT_GT(seen.sightings.size(), 0.6 * static_cast<double>(seen.looked_for.size()));
  const std::set<LandmarkId> looked_for(seen.looked_for.begin(), seen.looked_for.end());
  EXPECT_EQ(looked_for.size(), seen.looked_for.size()) << "each once";
  std::vector<double> errors_px, right_errors_px;
  for (const LandmarkSighting& sighting : seen.sightings) {
    EXPECT_EQ(looked_for.count(sighting.id), 1u);
    const Eigen::Vector3d p_C = T_W_C.inverse() * map.landmarks().at(sighting.id).p_W;
    const Eigen::Vector3d expected_px = kCamera.ProjectStereo(p_C);
    errors_px.push_back((expected_px - sighting.uvu_px).head<2>().norm());
    if (!sighting.has_right) {
      EXPECT_EQ(sighting.uvu_px.z(), 0);
      continue;
    }
    right_errors_px.push_back(std::abs(expected_px.z() - sighting.uvu_px.z()));
  }
  const auto median = [](std::vector<double> values) {
    std::sort(values.begin(), values.end());
    return values[values.size() / 2];
  };
  EXPECT_LT(median(errors_px), 0.2);
  ASSERT_GT(right_errors_px.size(), 0.7 * static_cast<double>(errors_px.size()));
  EXPECT_LT(median(right_errors_px), 0.3);
  EXPECT_TRUE(std::is_sorted(seen.sightings.begin(), seen.sightings.end(),
                             [](const auto& a, const auto& b) { return a.id < b.id; }));
}

TEST(LandmarkSighting, OfACrowdedCellFourAreLookedForTheMatchedAndLongestKnownFirst) {
  LocalMap map = MapOfFirstFrame();
  VisualOdometryOptions options;
  options.observation_cell_px = 320;  // the whole image is one cell
  const WalkedFrame frame(1);
  const Se3 T_W_C = WalkedFrame::Truth(1);
  const std::vector<LandmarkId> all = SightLandmarks({}, *frame, map, T_W_C, {}).looked_for;
  const std::vector<LandmarkId> known(all.end() - 3, all.end());
  for (const LandmarkId id : known) map.landmarks().at(id).num_seen = 9;
  const LandmarkId matched = all[all.size() / 2];
  const SightedLandmarks seen = SightLandmarks(options, *frame, map, T_W_C, {{matched, 0, 0}});
  ASSERT_EQ(seen.looked_for.size(), static_cast<std::size_t>(kMaxTriedPerCell));
  EXPECT_EQ(seen.looked_for.front(), matched);
  for (const LandmarkId id : known) {
    EXPECT_EQ(std::count(seen.looked_for.begin(), seen.looked_for.end(), id), 1);
  }
}

// A patch that fits nowhere: the corner of the match stands in, with a corner's sigma.
TEST(LandmarkSighting, WhatDoesNotAlignStaysAtItsCorner) {
  const LocalMap map = MapOfFirstFrame();
  VisualOdometryOptions options;
  options.min_correlation = 1.01;
  options.corner_sigma_px = 0.7;
  const WalkedFrame frame(1);
  const Se3 T_W_C = WalkedFrame::Truth(1);
  EXPECT_TRUE(SightLandmarks(options, *frame, map, T_W_C, {}).sightings.empty());
  const auto visible = FindVisible(map, kCamera, T_W_C, frame->left()->num_levels());
  const std::vector<LandmarkMatch> matches =
      MatchByProjection(visible, frame->left_features(), frame->grid(), {});
  ASSERT_GT(matches.size(), 50u);
  std::map<LandmarkId, int> feature_of;
  for (const LandmarkMatch& match : matches) feature_of[match.landmark] = match.feature;
  const SightedLandmarks seen = SightLandmarks(options, *frame, map, T_W_C, matches);
  ASSERT_GT(seen.sightings.size(), 40u);
  std::set<int> levels;
  for (const LandmarkSighting& sighting : seen.sightings) {
    ASSERT_EQ(feature_of.count(sighting.id), 1u);
    const Feature& feature =
        frame->left_features()[static_cast<std::size_t>(feature_of[sighting.id])];
    EXPECT_EQ(sighting.uvu_px.head<2>(), feature.uv_px);
    EXPECT_DOUBLE_EQ(sighting.sigma_px, 0.7 * std::pow(ImagePyramid::kScaleFactor, feature.level));
    levels.insert(feature.level);
  }
  EXPECT_GT(levels.size(), 2u);
}

TEST(LandmarkSighting, NobodyLooksForLandmarksBehindPeople) {
  const LocalMap map = MapOfFirstFrame();
  cv::Mat mask(kCamera.height, kCamera.width, CV_8UC1, cv::Scalar(0));
  mask.colRange(100, 220) = cv::Scalar(255);
  const WalkedFrame frame(1, mask);
  const Se3 T_W_C = WalkedFrame::Truth(1);
  const SightedLandmarks seen = SightLandmarks({}, *frame, map, T_W_C, {});
  ASSERT_GT(seen.sightings.size(), 20u);
  for (const LandmarkId id : seen.looked_for) {
    const Eigen::Vector2d uv_px = kCamera.Project(T_W_C.inverse() * map.landmarks().at(id).p_W);
    EXPECT_FALSE(frame->IsMasked(uv_px));
  }
  for (const LandmarkSighting& sighting : seen.sightings)
    EXPECT_FALSE(frame->IsMasked(sighting.uvu_px.head<2>()));
}

// ---- which of the sightings are kept

LandmarkSighting At(LandmarkId id, double u_px, double v_px) {
  LandmarkSighting sighting;
  sighting.id = id;
  sighting.uvu_px = {u_px, v_px, 0};
  return sighting;
}

class KeepSpreadTest : public testing::Test {
 protected:
  LandmarkId Add(int num_seen) {
    LocalLandmark landmark;
    landmark.num_seen = num_seen;
    return map_.Add(landmark);
  }
  std::vector<std::int64_t> Kept(const std::vector<LandmarkSighting>& sightings) const {
    std::vector<std::int64_t> ids;
    for (const LandmarkSighting& sighting : KeepSpread(options_, map_, sightings))
      ids.push_back(sighting.id.value);
    return ids;
  }

  VisualOdometryOptions options_;
  LocalMap map_{LocalMapOptions()};
};

TEST_F(KeepSpreadTest, TwoOfACellThoseSeenMostOften) {
  const LandmarkId a = Add(1), b = Add(5), c = Add(3), d = Add(1);
  // 16 px a cell: a, b and c share one, d is beside it.
  EXPECT_EQ(Kept({At(a, 0, 0), At(b, 15.9, 15.9), At(c, 8, 8), At(d, 16.1, 8)}),
            (std::vector<std::int64_t>{b.value, c.value, d.value}));
  EXPECT_TRUE(Kept({}).empty());
}

TEST_F(KeepSpreadTest, NoMoreThanTheLimitThoseSeenMostOften) {
  options_.max_observations = 2;
  const LandmarkId a = Add(1), b = Add(5), c = Add(3);
  EXPECT_EQ(Kept({At(a, 0, 0), At(b, 50, 0), At(c, 100, 0)}),
            (std::vector<std::int64_t>{b.value, c.value}));
}

}  // namespace
}  // namespace airdos
