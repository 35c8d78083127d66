// The local map's memory of images, and the trust in landmarks, by values worked by hand.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <set>

#include "common/features/landmark_trust.h"
#include "common/features/local_map.h"

namespace airdos {
namespace {

LocalLandmark Landmark(std::int64_t reference, std::int64_t last_seen) {
  LocalLandmark landmark;
  landmark.reference_frame = FrameId{reference};
  landmark.last_seen = FrameId{last_seen};
  landmark.num_seen = landmark.num_expected = 3;
  return landmark;
}

// 251 images are one too many. Of each the landmark that was seen last counts, wherever it stands:
// image 0 has one of long ago before and behind one that was just seen; that of image 7 is oldest.
TEST(LocalMapValues, TheImageWhoseLandmarksWereNotSeenForLongestGoes) {
  LocalMap map({});
  map.Add(Landmark(0, 1));
  map.Add(Landmark(0, 900));
  map.Add(Landmark(0, 2));
  for (std::int64_t reference = 1; reference <= 250; ++reference)
    map.Add(Landmark(reference, reference == 7 ? 3 : 500 + reference));
  map.Cull(FrameId{901});
  std::set<std::int64_t> references;
  for (const auto& [id, landmark] : map.landmarks())
    references.insert(landmark.reference_frame.value);
  EXPECT_EQ(references.size(), 250u);
  EXPECT_EQ(references.count(0), 1u);
  EXPECT_EQ(references.count(7), 0u);
  EXPECT_EQ(map.landmarks().size(), 252u);
}

// A verdict counts by how near it is, 1 at the place and 0 at 32 px, beside two of the base's.
TEST(TrustFieldValues, VerdictsCountByTheirDistance) {
  TrustField field(0.25);
  EXPECT_DOUBLE_EQ(field.At({100, 100}, 5), 0.25);
  field.Add({108, 100}, 5, true);   // 8 px: 0.75
  field.Add({100, 124}, 5, false);  // 24 px: 0.25
  EXPECT_NEAR(field.At({100, 100}, 5), (2 * 0.25 + 0.75) / (2 + 0.75 + 0.25), 1e-12);
  // From (140, 124) the first is too far, the second too.
  EXPECT_DOUBLE_EQ(field.At({141, 124}, 5), 0.25);
  // From (92, 124): the second is 8 px away, the first 28.8 px.
  const double near = 1 - std::hypot(16, 24) / 32;
  EXPECT_NEAR(field.At({92, 124}, 5), (2 * 0.25 + near) / (2 + 0.75 + near), 1e-12);
}

TEST(TrustFieldValues, OnlyWhatIsAsFarAwayCounts) {
  TrustField field(0.5);
  field.Add({100, 100}, 5, false);
  for (const double depth_m : {4.1, 5.0, 6.2}) EXPECT_LT(field.At({100, 100}, depth_m), 0.4);
  for (const double depth_m : {3.9, 6.3}) EXPECT_DOUBLE_EQ(field.At({100, 100}, depth_m), 0.5);
}

// Two frames' worth of belief to begin with; a memory of twenty.
TEST(LandmarkTrustValues, EachVerdictCountsOneAndOldOnesFade) {
  LandmarkTrust trust(0.75);
  EXPECT_NEAR(trust.static_probability(), 0.75, 1e-12);
  trust.Agree();
  EXPECT_NEAR(trust.static_probability(), 2.5 / 3, 1e-12);
  trust.Disagree();
  trust.Disagree();
  EXPECT_NEAR(trust.static_probability(), 2.5 / 5, 1e-12);
  double agreed = 2.5, disagreed = 2.5;
  for (int i = 0; i < 40; ++i) {
    trust.Agree();
    agreed += 1;
    if (agreed + disagreed > 20) {
      const double factor = 20 / (agreed + disagreed);
      agreed *= factor;
      disagreed *= factor;
    }
    EXPECT_NEAR(trust.static_probability(), agreed / (agreed + disagreed), 1e-12) << i;
  }
  EXPECT_GT(trust.static_probability(), 0.95);
}

}  // namespace
}  // namespace airdos
