#ifndef AIRDOS_COMMON_OPTIMIZATION_BUNDLE_BUNDLE_ADJUSTER_H_
#define AIRDOS_COMMON_OPTIMIZATION_BUNDLE_BUNDLE_ADJUSTER_H_

#include <vector>

#include "common/optimization/bundle/bundle_options.h"
#include "common/optimization/bundle/bundle_problem.h"

namespace airdos {

/// Bundle adjustment over camera poses, static landmarks and, if `use_people`, their joints,
/// segment lengths and motions (paper, eq. 6): Levenberg-Marquardt, then rejection of factors
/// with large errors, then Levenberg-Marquardt again. Overwrites the start values in `problem` with
/// the result and marks rejected factors. Frames that are fixed do not change. A problem without
/// any free unknown comes back as it is. Deterministic: one thread, order of the vectors. `memory`
/// (or null) carries no values from solve to solve, only its capacity.
BundleSummary SolveBundle(const BundleOptions& options, BundleProblem* problem,
                          std::vector<double>* memory = nullptr);

}  // namespace airdos

#endif  // AIRDOS_COMMON_OPTIMIZATION_BUNDLE_BUNDLE_ADJUSTER_H_
