#include <gtest/gtest.h>

#include <string>

#include "tests/fuzz/fuzz_targets.h"

namespace airdos {
namespace {

// What fuzzing found, as small as it got. Each crashed, threw, or took more than 64 MB.
struct Finding {
  std::string name;
  std::string target;
  std::string hex;
};

FuzzBytes FromHex(const std::string& hex) {
  FuzzBytes bytes;
  for (std::size_t i = 0; i + 1 < hex.size(); i += 2)
    bytes.push_back(static_cast<std::uint8_t>(std::stoul(hex.substr(i, 2), nullptr, 16)));
  return bytes;
}

const Finding kFindings[] = {
    // A zero byte within a text, which is encoded as a shorter one than its size says.
    {"ZeroByteInAText", "messages",
     "0900000000000003e8000000000000000a000000000000000700000011616972646f732e0000000000000065720"
     "0"},
    // Three times a width times a height does not fit into 64 bits.
    {"BytesOfAHugeImage", "messages",
     "00004c9008006061000000000000040000000000004c90080060610000800000000400000000"},
    // Ceres gives up before its first step, and then says that it made -1 of them.
    {"StepsOfASolverThatGaveUp", "optimizer",
     "0000300000000280000001e0407f400000000000407f4000000000004074000000000000406e0000000000"
     "003fd000000000000001008501020000000000000000000000000000000000000000000000003ff0000000"
     "0000000000000000000000000000000000000000000000000000003fa47ae147ae147b3fa999999999999a"
     "0000000000000000000000000000000c000000000000000000000000000000010000000000000002000000"
     "00000000030000000000000140000000000000000500000000000000060000000000000007000000000000"
     "00080000000000000009000000000000000a000000000000000b4270000042c80000430c00004334000043"
     "5c0000438200004396000043aa000043be000043d2000043e6000043fa000041a0000042b6000043220000"
     "43690000434900004248000042b200004300000043270000434e000043750000438e000043a1800043b500"
     "0043c8800043dc000043ef80000101010101010101010101013f80000043c9000043dc800043f000000101"
     "010101010101010101013f8000003f8000003f8000003f8000003f80000300000002010d42c80000420042"
     "dc000042480000427000003f809900"},
};

class FuzzRegressionsTest : public testing::TestWithParam<Finding> {};

TEST_P(FuzzRegressionsTest, Survives) {
  const FuzzBytes bytes = FromHex(GetParam().hex);
  for (const FuzzTarget& target : FuzzTargets()) {
    if (target.name != GetParam().target) continue;
    target.run(bytes.data(), bytes.size());
    return;
  }
  FAIL() << "no target " << GetParam().target;
}

INSTANTIATE_TEST_SUITE_P(All, FuzzRegressionsTest, testing::ValuesIn(kFindings),
                         [](const auto& finding) { return finding.param.name; });

}  // namespace
}  // namespace airdos
