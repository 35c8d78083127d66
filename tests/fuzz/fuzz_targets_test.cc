#include "tests/fuzz/fuzz_targets.h"

#include <gtest/gtest.h>

#include <ostream>
#include <random>
#include <set>

namespace airdos {

/// The name that ctest shows.
void PrintTo(const FuzzTarget& target, std::ostream* stream) { *stream << target.name; }

namespace {

constexpr int kCopiesOfASeed = 200;

FuzzBytes Changed(FuzzBytes bytes, std::mt19937_64* random) {
  const auto below = [random](std::size_t end) { return (*random)() % end; };
  for (std::size_t i = 1 + below(8); i > 0 && !bytes.empty(); --i) {
    const std::size_t place = below(bytes.size());
    switch (below(4)) {
      case 0:
        bytes[place] = static_cast<std::uint8_t>(below(256));
        break;
      case 1:
        bytes[place] ^= static_cast<std::uint8_t>(1u << below(8));
        break;
      case 2:
        bytes.resize(place);
        break;
      default:
        bytes.insert(bytes.begin() + static_cast<std::ptrdiff_t>(place), below(6),
                     static_cast<std::uint8_t>(below(2) * 255));
    }
  }
  return bytes;
}

class FuzzTargetsTest : public testing::TestWithParam<FuzzTarget> {};

// libFuzzer looks for longer (launch_scripts/fuzz.sh); this keeps the targets alive where there is
// no clang.
TEST_P(FuzzTargetsTest, SurvivesItsSeedsAndChangedCopies) {
  const FuzzTarget& target = GetParam();
  std::mt19937_64 random(1);
  target.run(nullptr, 0);
  ASSERT_FALSE(target.seeds().empty());
  for (const FuzzBytes& seed : target.seeds()) {
    ASSERT_LE(seed.size(), static_cast<std::size_t>(target.max_bytes)) << "libFuzzer would cut it";
    target.run(seed.data(), seed.size());
    for (int i = 0; i < kCopiesOfASeed; ++i) {
      const FuzzBytes changed = Changed(seed, &random);
      target.run(changed.data(), changed.size());
    }
  }
}

INSTANTIATE_TEST_SUITE_P(All, FuzzTargetsTest, testing::ValuesIn(FuzzTargets()),
                         [](const auto& target) { return target.param.name; });

TEST(FuzzTargetNamesTest, AreUnique) {
  std::set<std::string> names;
  for (const FuzzTarget& target : FuzzTargets())
    EXPECT_TRUE(names.insert(target.name).second) << target.name;
}

}  // namespace
}  // namespace airdos
