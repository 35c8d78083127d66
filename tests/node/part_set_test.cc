#include "processes/node/message/part_set.h"

#include <gtest/gtest.h>

#include "airdos/map_update_t.hpp"

namespace airdos {
namespace {

map_update_t Part(int part, int num_parts) {
  map_update_t message{};
  message.part = part;
  message.num_parts = num_parts;
  return message;
}

TEST(PartSetTest, IsCompleteOnceAllPartsAreThereAndGivesThemInOrder) {
  PartSet<map_update_t> set;
  EXPECT_TRUE(set.empty());
  EXPECT_FALSE(set.is_complete());
  for (const int part : {2, 0, 1}) {
    EXPECT_FALSE(set.is_complete());
    EXPECT_EQ(set.Add(Part(part, 3)), "");
    EXPECT_FALSE(set.empty());
  }
  EXPECT_TRUE(set.is_complete());
  const std::vector<map_update_t> parts = set.Take();
  ASSERT_EQ(parts.size(), 3u);
  for (int i = 0; i < 3; ++i) EXPECT_EQ(parts[static_cast<std::size_t>(i)].part, i);
  EXPECT_TRUE(set.empty());
  EXPECT_EQ(set.Add(Part(0, 1)), "");  // of another message
  EXPECT_TRUE(set.is_complete());
}

TEST(PartSetTest, WhatDoesNotGoWithThePartsBeforeIsRefused) {
  PartSet<map_update_t> set;
  EXPECT_EQ(set.Add(Part(1, 2)), "");
  EXPECT_EQ(set.Add(Part(1, 2)), "part 1 came twice");
  EXPECT_EQ(set.Add(Part(0, 3)), "num_parts 3 differs from that of another part");
  EXPECT_FALSE(set.is_complete());
  EXPECT_EQ(set.Add(Part(0, 2)), "");
  EXPECT_TRUE(set.is_complete());
}

}  // namespace
}  // namespace airdos
