// The paper's timing problems: our adjustment reaches the cost that a g2o with the same factors
// reached (reference.json beside the problems), or less.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/support/ba_problem.h"

namespace airdos {
namespace {

std::string Folder() {
  const char* const data = std::getenv("AIRDOS_DATA_DIR");
  const std::string root = data != nullptr ? data : AIRDOS_SOURCE_DIR "/../shared/data";
  return root + "/ba_problems/";
}

TEST(BaProblemsTest, ReachTheReferencesCost) {
  if (!std::filesystem::exists(Folder() + "reference.json")) {
    GTEST_SKIP() << "no " << Folder() << "reference.json";
  }
  nlohmann::json reference;
  std::ifstream(Folder() + "reference.json") >> reference;
  for (const auto& [name, variants] : reference["problems"].items()) {
    const BaProblem read = ReadBaProblem(Folder() + name + ".txt");
    for (const auto& [variant, expected] : variants.items()) {
      BundleProblem problem = read.problem;
      BundleOptions options = read.options;
      options.use_rigidity = variant == "womot" || variant == "full";
      options.use_motion = variant == "worig" || variant == "full";
      const BundleSummary summary = SolveBundle(options, &problem);
      const double end = expected["cost_end"], start = expected["cost_start"];
      // Theirs has no 1/2; it is given to four and six digits.
      EXPECT_NEAR(2 * summary.initial_cost / start, 1, 1e-3) << name << " " << variant;
      EXPECT_LE(2 * summary.final_cost, end * (1 + 1e-3)) << name << " " << variant;
      EXPECT_GT(2 * summary.final_cost, 0.9 * end) << name << " " << variant;
      EXPECT_TRUE(summary.has_converged) << name << " " << variant;
    }
  }
}

}  // namespace
}  // namespace airdos
