#include "common/config/config_reader.h"

#include <gtest/gtest.h>

#include "tests/support/input_errors.h"

namespace airdos {
namespace {

constexpr char kText[] = "a:\n  count: 3\n  ratio: 0.5\nmode: fast\nflag: true\n";

TEST(ConfigReaderTest, ReadsEachType) {
  ConfigReader reader = ConfigReader::FromString(kText, "x.yaml");
  int count = 0;
  double ratio = 0;
  bool flag = false;
  reader.Read("a.count", &count, 0, 10);
  reader.Read("a.ratio", &ratio, 0, 1);
  reader.Read("flag", &flag);
  EXPECT_EQ(reader.ReadChoice("mode", {"slow", "fast"}), 1);
  reader.Finish();
  EXPECT_EQ(count, 3);
  EXPECT_EQ(ratio, 0.5);
  EXPECT_TRUE(flag);
}

TEST(ConfigReaderTest, NamesFileKeyAndValue) {
  ConfigReader reader = ConfigReader::FromString(kText, "x.yaml");
  int count = 0;
  double ratio = 0;
  EXPECT_EQ(ErrorOf([&] { reader.Read("a.count", &count, 5, 10); }),
            "x.yaml: key 'a.count' with value '3': must lie between 5 and 10");
  EXPECT_EQ(ErrorOf([&] { reader.Read("mode", &ratio, 0, 1); }),
            "x.yaml: key 'mode' with value 'fast': must be a number");
  EXPECT_EQ(ErrorOf([&] { reader.Read("a.none", &ratio, 0, 1); }),
            "x.yaml: key 'a.none' is missing");
  EXPECT_EQ(ErrorOf([&] { reader.Finish(); }),
            "x.yaml: key 'a.ratio' with value '0.5': there is no such key");
  EXPECT_EQ(ErrorOf([&] { reader.Override("a.nowhere=4"); }),
            "x.yaml: key 'a.nowhere' with value '4': there is no such key");
  EXPECT_EQ(ErrorOf([&] { ConfigReader::FromFile("/nowhere/y.yaml"); }),
            "/nowhere/y.yaml: cannot be read: No such file or directory");
  EXPECT_EQ(ErrorOf([&] { ConfigReader::FromString("a: [", "z.yaml"); }).substr(0, 12),
            "z.yaml: line");
}

TEST(ConfigReaderTest, OverridesOneValue) {
  ConfigReader reader = ConfigReader::FromString(kText, "x.yaml");
  reader.Override("a.count=7");
  int count = 0;
  reader.Read("a.count", &count, 0, 10);
  EXPECT_EQ(count, 7);
}

}  // namespace
}  // namespace airdos
