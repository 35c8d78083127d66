#include "common/features/landmark_matcher.h"

#include <gtest/gtest.h>

#include <bitset>
#include <random>
#include <vector>

namespace airdos {
namespace {

Descriptor RandomDescriptor(std::mt19937_64* random) {
  Descriptor descriptor;
  for (std::uint64_t& word : descriptor) word = (*random)();
  return descriptor;
}

/// The same but for `num_bits` bits, the first ones from `first` on.
Descriptor WithFlippedBits(Descriptor descriptor, int num_bits, int first = 0) {
  for (int bit = first; bit < first + num_bits; ++bit)
    descriptor[static_cast<std::size_t>(bit / 64)] ^= std::uint64_t{1} << (bit % 64);
  return descriptor;
}

TEST(HammingDistance, CountsTheBitsThatDiffer) {
  std::mt19937_64 random(1);
  for (int run = 0; run < 100; ++run) {
    const Descriptor a = RandomDescriptor(&random);
    const Descriptor b = RandomDescriptor(&random);
    std::size_t expected = 0;
    for (std::size_t i = 0; i < a.size(); ++i)
      expected += std::bitset<64>(a[i]).count() + std::bitset<64>(b[i]).count() -
                  2 * std::bitset<64>(a[i] & b[i]).count();
    EXPECT_EQ(HammingDistance(a, b), static_cast<int>(expected));
    EXPECT_EQ(HammingDistance(a, WithFlippedBits(a, 2 * run)), 2 * run);
    EXPECT_EQ(HammingDistance(a, WithFlippedBits(a, 256)), 256);  // all: overflows no field
  }
}

class MatchByDescriptorTest : public testing::Test {
 protected:
  MatchByDescriptorTest() : features_(50) {
    for (std::size_t i = 0; i < features_.size(); ++i) {
      features_[i].uv_px = {10.0 * static_cast<double>(i), 5};
      features_[i].descriptor = RandomDescriptor(&random_);
    }
  }

  /// Of one landmark that looks like this.
  std::vector<LandmarkMatch> Match(const Descriptor& descriptor) const {
    LocalLandmark landmark;
    landmark.descriptor = descriptor;
    return MatchByDescriptor({{LandmarkId{7}, &landmark}}, features_, 64, 0.85);
  }

  std::mt19937_64 random_{2};
  std::vector<Feature> features_;
};

TEST_F(MatchByDescriptorTest, FindsTheNearestWhereverItIs) {
  for (const std::size_t index : {0U, 20U, 49U}) {
    const auto matches = Match(WithFlippedBits(features_[index].descriptor, 30));
    ASSERT_EQ(matches.size(), 1U);
    EXPECT_EQ(matches[0].landmark, LandmarkId{7});
    EXPECT_EQ(matches[0].feature, static_cast<int>(index));
    EXPECT_EQ(matches[0].distance, 30);
  }
}

TEST_F(MatchByDescriptorTest, NothingIsNearEnough) {
  EXPECT_EQ(Match(WithFlippedBits(features_[20].descriptor, 64)).size(), 1U);
  EXPECT_TRUE(Match(WithFlippedBits(features_[20].descriptor, 65)).empty());
}

TEST_F(MatchByDescriptorTest, ARivalElsewhereSpoilsTheMatch) {
  const Descriptor descriptor = features_[20].descriptor;
  for (const std::size_t rival : {3U, 40U}) {  // before and after the nearest
    const std::vector<Feature> features = features_;
    features_[20].descriptor = WithFlippedBits(descriptor, 30);
    features_[rival].descriptor = WithFlippedBits(descriptor, 34, 100);
    EXPECT_TRUE(Match(descriptor).empty());
    features_[rival].uv_px = features_[20].uv_px + Eigen::Vector2d(1, 1);  // the same corner
    EXPECT_EQ(Match(descriptor).size(), 1U);
    features_ = features;
  }
}

TEST_F(MatchByDescriptorTest, AFeatureGoesToTheLandmarkThatIsNearest) {
  std::vector<LocalLandmark> landmarks(3);
  const int distances[] = {20, 5, 10};
  std::vector<std::pair<LandmarkId, const LocalLandmark*>> candidates;
  for (std::size_t i = 0; i < landmarks.size(); ++i) {
    landmarks[i].descriptor = WithFlippedBits(features_[8].descriptor, distances[i]);
    candidates.emplace_back(LandmarkId{static_cast<std::int64_t>(i)}, &landmarks[i]);
  }
  const auto matches = MatchByDescriptor(candidates, features_, 64, 0.85);
  ASSERT_EQ(matches.size(), 1U);
  EXPECT_EQ(matches[0].landmark, LandmarkId{1});
}

TEST_F(MatchByDescriptorTest, OneFeatureAloneCannotBeJudged) {
  features_.resize(1);
  EXPECT_TRUE(Match(features_[0].descriptor).empty());
}

}  // namespace
}  // namespace airdos
