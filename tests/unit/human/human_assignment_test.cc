#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>

#include "common/human/assignment.h"

namespace airdos {
namespace {

double TotalCost(const Eigen::MatrixXd& cost, double max_cost,
                 const std::vector<std::optional<int>>& partner) {
  double total = max_cost / 2 * static_cast<double>(cost.rows() + cost.cols());
  for (std::size_t row = 0; row < partner.size(); ++row) {
    if (partner[row]) total += cost(static_cast<Eigen::Index>(row), *partner[row]) - max_cost;
  }
  return total;
}

// Tries every way of pairing the rows from `row` on.
double LeastCost(const Eigen::MatrixXd& cost, double max_cost, Eigen::Index row,
                 std::vector<std::optional<int>>* partner) {
  if (row == cost.rows()) return TotalCost(cost, max_cost, *partner);
  double least = LeastCost(cost, max_cost, row + 1, partner);
  for (int column = 0; column < cost.cols(); ++column) {
    if (std::find(partner->begin(), partner->end(), std::optional<int>(column)) != partner->end()) {
      continue;
    }
    (*partner)[static_cast<std::size_t>(row)] = column;
    least = std::min(least, LeastCost(cost, max_cost, row + 1, partner));
    (*partner)[static_cast<std::size_t>(row)].reset();
  }
  return least;
}

TEST(Assignment, EmptySides) {
  EXPECT_TRUE(Assign(Eigen::MatrixXd(0, 0), 1).empty());
  EXPECT_TRUE(Assign(Eigen::MatrixXd(0, 3), 1).empty());
  const auto partner = Assign(Eigen::MatrixXd(2, 0), 1);
  ASSERT_EQ(partner.size(), 2U);
  EXPECT_FALSE(partner[0] || partner[1]);
}

TEST(Assignment, TakesTheLeastSumNotTheLeastPair) {
  Eigen::MatrixXd cost(2, 2);
  cost << 1, 2, 2, 9;
  const auto partner = Assign(cost, 100);
  EXPECT_EQ(partner[0], 1);
  EXPECT_EQ(partner[1], 0);
}

TEST(Assignment, GateAndForbiddenPairs) {
  Eigen::MatrixXd cost(2, 2);
  cost << 5, 0.5, std::numeric_limits<double>::infinity(), std::nan("");
  const auto partner = Assign(cost, 4);
  EXPECT_EQ(partner[0], 1);
  EXPECT_FALSE(partner[1]);
}

TEST(Assignment, EqualsTheBestOfAllWays) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(0, 10);
  for (int trial = 0; trial < 200; ++trial) {
    const int rows = 1 + trial % 5;
    const int columns = 1 + trial / 5 % 5;
    Eigen::MatrixXd cost(rows, columns);
    for (Eigen::Index i = 0; i < cost.size(); ++i) cost(i) = uniform(random);
    std::vector<std::optional<int>> none(static_cast<std::size_t>(rows));
    EXPECT_NEAR(TotalCost(cost, 6, Assign(cost, 6)), LeastCost(cost, 6, 0, &none), 1e-9);
  }
}

}  // namespace
}  // namespace airdos
