#ifndef AIRDOS_COMMON_OPTIMIZATION_BUNDLE_BUNDLE_ADJUSTER_H_
#define AIRDOS_COMMON_OPTIMIZATION_BUNDLE_BUNDLE_ADJUSTER_H_

#include <vector>

#include "common/optimization/bundle/bundle_options.h"
#include "common/optimization/bundle/bundle_problem.h"

namespace airdos {

/// Bundle adjustment over camera poses, static landmarks and, if `use_people`, people's joints,
/// segment lengths and motions (paper, eq. 6): Levenberg-Marquardt, then rejection of factors with
/// large errors, then Levenberg-Marquardt again. Overwrites the initial values in `problem` with
/// the result and marks the rejected factors. Fixed frames do not change. A problem without free
/// unknowns is returned as it is. Deterministic: one thread, and factors in the order of the
/// vectors. `memory` (may be null) carries only its capacity from solve to solve, no values.
BundleSummary SolveBundle(const BundleOptions& options, BundleProblem* problem,
                          std::vector<double>* memory = nullptr);

}  // namespace airdos

#endif  // AIRDOS_COMMON_OPTIMIZATION_BUNDLE_BUNDLE_ADJUSTER_H_
