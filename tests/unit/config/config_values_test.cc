// What the configuration reader takes and refuses, at the limits.
#include <gtest/gtest.h>

#include <string>

#include "common/config/config_reader.h"
#include "common/util/error.h"

namespace airdos {
namespace {

ConfigReader Of(const std::string& value) {
  return ConfigReader::FromString("key: " + value + "\n", "x.yaml");
}

std::string MessageOf(const std::string& text) {
  try {
    ConfigReader::FromString(text, "x.yaml");
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(ConfigValuesTest, ARangeHasBothItsEnds) {
  double number = 0;
  for (const char* good : {"-2", "3.5", "0"})
    EXPECT_NO_THROW(Of(good).Read("key", &number, -2, 3.5));
  for (const char* bad : {"-2.001", "3.501", "nan", "inf", "-inf", "", "1 2", "1x", "0x", "true"})
    EXPECT_THROW(Of(bad).Read("key", &number, -2, 3.5), InputError) << bad;
  Of("1.25e-1").Read("key", &number, -2, 3.5);
  EXPECT_EQ(number, 0.125);
  int count = 0;
  for (const char* good : {"-2", "3"}) EXPECT_NO_THROW(Of(good).Read("key", &count, -2, 3));
  for (const char* bad : {"-3", "4", "1.5", "1.1", "1.9", "one"})
    EXPECT_THROW(Of(bad).Read("key", &count, -2, 3), InputError) << bad;
  Of("-2").Read("key", &count, -2, 3);
  EXPECT_EQ(count, -2);
}

TEST(ConfigValuesTest, TrueAndFalseAreTheOnlyTruths) {
  bool flag = false;
  Of("true").Read("key", &flag);
  EXPECT_TRUE(flag);
  Of("false").Read("key", &flag);
  EXPECT_FALSE(flag);
  for (const char* bad : {"yes", "no", "1", "0", "True", "on"})
    EXPECT_THROW(Of(bad).Read("key", &flag), InputError) << bad;
}

TEST(ConfigValuesTest, AChoiceIsItsPlace) {
  for (int i = 0; i < 3; ++i) {
    const std::string values[] = {"a", "b", "c"};
    EXPECT_EQ(Of(values[i]).ReadChoice("key", {"a", "b", "c"}), i);
  }
  try {
    Of("d").ReadChoice("key", {"a", "b", "c"});
    ADD_FAILURE();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "x.yaml: key 'key' with value 'd': must be one of a, b, c");
  }
}

TEST(ConfigValuesTest, OverridesTakeWhatStandsBehindTheFirstEquals) {
  ConfigReader reader = ConfigReader::FromString("a: 1\nb:\n  c: 2\n", "x.yaml");
  reader.Override("b.c=x=y");
  std::string text;
  reader.Read("b.c", &text);
  EXPECT_EQ(text, "x=y");
  reader.Read("a", &text);
  EXPECT_EQ(text, "1") << "the others stay";
  EXPECT_EQ(reader.Resolved(), "a: 1\nb.c: \"x=y\"\n");
  EXPECT_NO_THROW(reader.Finish());
  EXPECT_THROW(reader.Override("b=3"), InputError);
  EXPECT_THROW(reader.Override("a"), InputError);
}

TEST(ConfigValuesTest, EachKeyOnceAndNotTooDeep) {
  EXPECT_NE(MessageOf("a: 1\nb: 2\na: 3\n"), "");
  EXPECT_NE(MessageOf("a: [1, 2]\n"), "");
  EXPECT_EQ(MessageOf("a: 1\nb: [\n").substr(0, 14), "x.yaml: line 3");
  std::string deep;
  for (int depth = 0; depth < 8; ++depth)
    deep += std::string(static_cast<std::size_t>(depth), ' ') + "k:" + (depth < 7 ? "\n" : " 1\n");
  EXPECT_EQ(MessageOf(deep), "");
  EXPECT_NE(MessageOf("a:\n  b:\n    c:\n      d:\n        e:\n          f:\n            g:\n"
                      "              h:\n                i: 1\n"),
            "");
}

TEST(ConfigValuesTest, AKeyThatNobodyReadIsAnError) {
  ConfigReader reader = ConfigReader::FromString("a: 1\nb: 2\n", "x.yaml");
  std::string text;
  reader.Read("a", &text);
  EXPECT_THROW(reader.Finish(), InputError);
  reader.Read("b", &text);
  EXPECT_NO_THROW(reader.Finish());
}

}  // namespace
}  // namespace airdos
