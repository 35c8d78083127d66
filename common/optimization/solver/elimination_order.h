#ifndef AIRDOS_COMMON_OPTIMIZATION_SOLVER_ELIMINATION_ORDER_H_
#define AIRDOS_COMMON_OPTIMIZATION_SOLVER_ELIMINATION_ORDER_H_

#include <vector>

#include "common/optimization/solver/factor_graph.h"

namespace airdos {

/// In which order the unknowns of a graph are eliminated. A front is a set of unknowns that are
/// eliminated together.
struct EliminationOrder {
  /// Blocks of the graph that are free and have factors, by front.
  std::vector<std::vector<int>> fronts;
  /// Fronts of all landmarks, of each track, of the poses: [begins[i], begins[i + 1]).
  std::vector<int> group_begins;
};

/// Landmarks, then track by track, then the poses in one front. Within a track:
///
///  1. its slices by nested dissection in time: the slice in the middle parts the track into two
///     that do not know of each other, and is eliminated after both. Against a sweep from end to
///     end this halves the cost and more, as every piece carries the poses of its own frames only;
///  2. within a slice that stands between two pieces, first what has no partner in other slices
///     (the joints of the limbs), each alone, the one with the fewest neighbours first: from the
///     leaves to the root; then the rest (torso and velocity; all points of a rigid object) in
///     one front. A slice that is not parted any more is eliminated the same way altogether;
///  3. what belongs to the whole track (lengths, a motion over the track).
///
/// Any order is right: what couples unknowns in a way not foreseen here only costs more.
EliminationOrder OrderForElimination(const FactorGraph& graph);

}  // namespace airdos

#endif  // AIRDOS_COMMON_OPTIMIZATION_SOLVER_ELIMINATION_ORDER_H_
