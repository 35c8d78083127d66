#ifndef AIRDOS_COMMON_OPTIMIZATION_SOLVER_ELIMINATION_ORDER_H_
#define AIRDOS_COMMON_OPTIMIZATION_SOLVER_ELIMINATION_ORDER_H_

#include <vector>

#include "common/optimization/solver/factor_graph.h"

namespace airdos {

/// The order in which the unknowns of a graph are eliminated. A front is a set of unknowns that are
/// eliminated together.
struct EliminationOrder {
  /// For each front, its blocks in the graph: those that are free and have factors.
  std::vector<std::vector<int>> fronts;
  /// The fronts of group i are [group_begins[i], group_begins[i + 1]): all landmarks, then one
  /// group per track, then the poses.
  std::vector<int> group_begins;
};

/// Landmarks first, then track by track, then the poses in one front. Within a track:
///
///  1. its slices by nested dissection in time: the middle slice splits the track into two pieces
///     that are not coupled with each other, and is eliminated after both. Compared with a sweep
///     from end to end, this more than halves the cost, since each piece carries only the poses of
///     its own frames;
///  2. within a slice between two pieces: first the blocks without a partner in another slice (the
///     joints of the limbs), one at a time, fewest neighbours first, that is, from the leaves to
///     the root; then the rest (torso and velocity; all points of a rigid object) in one front. A
///     slice that is not split any further is eliminated in the same way as a whole;
///  3. what belongs to the whole track (segment lengths, or one motion for the track).
///
/// Any order is correct: a coupling that was not foreseen here only costs time.
EliminationOrder OrderForElimination(const FactorGraph& graph);

}  // namespace airdos

#endif  // AIRDOS_COMMON_OPTIMIZATION_SOLVER_ELIMINATION_ORDER_H_
