#ifndef AIRDOS_COMMON_HUMAN_ASSIGNMENT_H_
#define AIRDOS_COMMON_HUMAN_ASSIGNMENT_H_

#include <Eigen/Core>
#include <optional>
#include <vector>

namespace airdos {

/// For each row of `cost`, the column that it is paired with, or nothing, such that
///   sum of cost(row, column) over pairs + max_cost / 2 for each row and column without a partner
/// is minimal: a pair is made only if it costs less than `max_cost`. Costs that are not finite
/// forbid a pair. Hungarian method with potentials, O((rows + columns)^3); the same input always
/// gives the same pairs.
std::vector<std::optional<int>> Assign(const Eigen::MatrixXd& cost, double max_cost);

}  // namespace airdos

#endif  // AIRDOS_COMMON_HUMAN_ASSIGNMENT_H_
