#include "common/util/words.h"

#include <gtest/gtest.h>

namespace airdos {
namespace {

using Lines = std::vector<std::string>;

TEST(WordsTest, WrapsAtTheWidthAndNotBefore) {
  EXPECT_EQ(WrapWords("ab cd ef", 5), (Lines{"ab cd", "ef"}));
  EXPECT_EQ(WrapWords("ab cd ef", 4), (Lines{"ab", "cd", "ef"}));
  EXPECT_EQ(WrapWords(" ab\n  cd ", 80), (Lines{"ab cd"}));
  EXPECT_EQ(WrapWords("a longword b", 4), (Lines{"a", "longword", "b"}));
  EXPECT_EQ(WrapWords("", 10), Lines());
}

TEST(WordsTest, Joins) {
  EXPECT_EQ(JoinWords({"a", "b c", "", "d"}, ", "), "a, b c, , d");
  EXPECT_EQ(JoinWords({"", "a"}, ","), ",a");
  EXPECT_EQ(JoinWords({"a"}, ", "), "a");
  EXPECT_EQ(JoinWords({}, ", "), "");
}

TEST(WordsTest, PartsBetweenCommas) {
  EXPECT_EQ(SplitAtCommas("a,b c,,d,"), (Lines{"a", "b c", "d"}));
  EXPECT_EQ(SplitAtCommas(""), Lines());
}

}  // namespace
}  // namespace airdos
