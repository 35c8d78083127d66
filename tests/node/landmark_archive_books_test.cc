// The map that is told again: in which order, and what of it is forgotten.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "processes/optimizer/landmark_archive.h"

namespace airdos {
namespace {

MapChanges Set(std::int64_t first, std::int64_t last, double x = 1) {
  MapChanges changes;
  for (std::int64_t id = first; id <= last; ++id)
    changes.landmarks.push_back({LandmarkId{id}, {x, 2, 3}, 0.1, 4});
  return changes;
}

/// "1-200" or "401-450 1-150": runs of the numbers in their order.
std::string Runs(const std::vector<MapChanges::Landmark>& landmarks) {
  std::string text;
  for (std::size_t i = 0; i < landmarks.size();) {
    std::size_t end = i + 1;
    while (end < landmarks.size() && landmarks[end].id.value == landmarks[end - 1].id.value + 1)
      ++end;
    text += (i == 0 ? "" : " ") + std::to_string(landmarks[i].id.value) + "-" +
            std::to_string(landmarks[end - 1].id.value);
    i = end;
  }
  return text;
}

TEST(LandmarkArchiveBooksTest, TwoHundredAFrameRoundAndRound) {
  LandmarkArchive archive;
  archive.Add(Set(1, 450));
  EXPECT_EQ(Runs(archive.NextRepeated()), "1-200");
  EXPECT_EQ(Runs(archive.NextRepeated()), "201-400");
  EXPECT_EQ(Runs(archive.NextRepeated()), "401-450 1-150");
  EXPECT_EQ(Runs(archive.NextRepeated()), "151-350");
}

TEST(LandmarkArchiveBooksTest, FewAreToldOnceAFrame) {
  LandmarkArchive archive;
  archive.Add(Set(1, 3));
  EXPECT_EQ(Runs(archive.NextRepeated()), "1-3");
  EXPECT_EQ(Runs(archive.NextRepeated()), "1-3");
}

TEST(LandmarkArchiveBooksTest, TheLastWordCounts) {
  LandmarkArchive archive;
  archive.Add(Set(1, 5));
  MapChanges changes = Set(2, 3, 7);
  changes.removed = {LandmarkId{4}};
  archive.Add(changes);
  const std::vector<MapChanges::Landmark> told = archive.NextRepeated();
  EXPECT_EQ(Runs(told), "1-3 5-5");
  EXPECT_EQ(told[0].p_W.x(), 1);
  EXPECT_EQ(told[1].p_W.x(), 7);
  EXPECT_EQ(told[2].p_W.x(), 7);
}

TEST(LandmarkArchiveBooksTest, BeyondTheLimitTheOldestGo) {
  LandmarkArchive archive(10);
  EXPECT_FALSE(archive.Add(Set(1, 10))) << "as many as it holds";
  EXPECT_TRUE(archive.Add(Set(11, 13)));
  EXPECT_EQ(Runs(archive.NextRepeated()), "4-13");
  EXPECT_FALSE(archive.Add(Set(14, 14))) << "said once";
  EXPECT_EQ(archive.size(), 10u);
}

}  // namespace
}  // namespace airdos
