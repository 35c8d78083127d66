#include "common/human/assignment.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "common/util/check.h"

namespace airdos {
namespace {

// Extends an optimal assignment of the first rows by one row, along the shortest augmenting path
// over the reduced costs cost - row_potential - column_potential.
class HungarianSolver {
 public:
  explicit HungarianSolver(const Eigen::MatrixXd& cost)
      : cost_(cost),
        size_(static_cast<int>(cost.rows())),
        row_potential_(Eigen::VectorXd::Zero(size_)),
        column_potential_(Eigen::VectorXd::Zero(size_)),
        row_of_column_(static_cast<std::size_t>(size_), -1) {}

  std::vector<int> Solve() {
    for (int row = 0; row < size_; ++row) AddRow(row);
    return row_of_column_;
  }

 private:
  int& RowOf(int column) { return row_of_column_[static_cast<std::size_t>(column)]; }

  void AddRow(int new_row) {
    const double infinity = std::numeric_limits<double>::infinity();
    Eigen::VectorXd distance = Eigen::VectorXd::Constant(size_, infinity);
    std::vector<int> previous(static_cast<std::size_t>(size_), -1);
    std::vector<bool> is_done(static_cast<std::size_t>(size_), false);
    double length = 0;
    int row = new_row;
    int column = -1;
    while (true) {
      int nearest = -1;
      for (int c = 0; c < size_; ++c) {
        if (is_done[static_cast<std::size_t>(c)]) continue;
        const double reduced = length + cost_(row, c) - row_potential_[row] - column_potential_[c];
        if (reduced < distance[c]) {
          distance[c] = reduced;
          previous[static_cast<std::size_t>(c)] = column;
        }
        if (nearest < 0 || distance[c] < distance[nearest]) nearest = c;
      }
      column = nearest;
      length = distance[column];
      is_done[static_cast<std::size_t>(column)] = true;
      if (RowOf(column) < 0) break;
      row = RowOf(column);
    }
    row_potential_[new_row] += length;
    for (int c = 0; c < size_; ++c) {
      if (!is_done[static_cast<std::size_t>(c)] || c == column) continue;
      row_potential_[RowOf(c)] += length - distance[c];
      column_potential_[c] -= length - distance[c];
    }
    while (column >= 0) {
      const int before = previous[static_cast<std::size_t>(column)];
      RowOf(column) = before < 0 ? new_row : RowOf(before);
      column = before;
    }
  }

  const Eigen::MatrixXd& cost_;
  int size_;
  Eigen::VectorXd row_potential_;
  Eigen::VectorXd column_potential_;
  std::vector<int> row_of_column_;
};

}  // namespace

std::vector<std::optional<int>> Assign(const Eigen::MatrixXd& cost, double max_cost) {
  AIRDOS_CHECK(std::isfinite(max_cost) && max_cost > 0);
  const Eigen::Index rows = cost.rows();
  const Eigen::Index columns = cost.cols();
  // Each row can stay alone by taking one of the columns added on the right, and each column by
  // taking one of the rows added below; added rows and columns pair with each other at no cost.
  Eigen::MatrixXd square = Eigen::MatrixXd::Zero(rows + columns, rows + columns);
  square.topRightCorner(rows, rows).setConstant(max_cost / 2);
  square.bottomLeftCorner(columns, columns).setConstant(max_cost / 2);
  for (Eigen::Index r = 0; r < rows; ++r) {
    for (Eigen::Index c = 0; c < columns; ++c) {
      const bool is_allowed = std::isfinite(cost(r, c)) && cost(r, c) < max_cost;
      square(r, c) = is_allowed ? cost(r, c) : 2 * max_cost;
    }
  }
  std::vector<std::optional<int>> partner(static_cast<std::size_t>(rows));
  const std::vector<int> row_of_column = HungarianSolver(square).Solve();
  for (Eigen::Index c = 0; c < columns; ++c) {
    const int r = row_of_column[static_cast<std::size_t>(c)];
    if (r < rows && square(r, c) < max_cost)
      partner[static_cast<std::size_t>(r)] = static_cast<int>(c);
  }
  return partner;
}

}  // namespace airdos
