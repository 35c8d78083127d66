#ifndef AIRDOS_TESTS_SUPPORT_BA_PROBLEM_H_
#define AIRDOS_TESTS_SUPPORT_BA_PROBLEM_H_

#include <string>

#include "common/optimization/bundle/bundle_adjuster.h"
#include "common/optimization/bundle/bundle_problem.h"

namespace airdos {

/// A problem of the paper's timing benchmark (text, one record per line): points measured in camera
/// coordinates, and one moving object with segments and one rigid motion over the track.
struct BaProblem {
  BundleProblem problem;  ///< start values
  BundleOptions options;  ///< sigmas from the file, no kernels, no rejection
};

/// Throws InputError naming file and line.
BaProblem ReadBaProblem(const std::string& path);

}  // namespace airdos

#endif  // AIRDOS_TESTS_SUPPORT_BA_PROBLEM_H_
