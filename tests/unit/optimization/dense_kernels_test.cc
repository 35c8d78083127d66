#include "common/optimization/solver/dense_kernels.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <random>
#include <vector>

namespace airdos {
namespace {

std::vector<double> RandomDoubles(std::size_t num, std::mt19937_64* random) {
  std::vector<double> values(num);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (double& value : values) value = uniform(*random);
  return values;
}

// Bit for bit, whatever registers the processor has: each element is one sum in order.
TEST(DenseKernelsTest, AProductIsTheSumInOrder) {
  std::mt19937_64 random(3);
  for (int rows = 1; rows <= 9; ++rows) {
    for (int cols = rows; cols <= 23; ++cols) {
      for (const bool is_symmetric : {false, true}) {
        const int terms = 1 + (rows + cols) % 7, stride = rows + cols + 1, stride_c = cols + 3;
        const std::vector<double> panel =
            RandomDoubles(static_cast<std::size_t>(terms * stride), &random);
        std::vector<double> C = RandomDoubles(static_cast<std::size_t>(rows * stride_c), &random);
        std::vector<double> expected = C;
        const double* const A = panel.data();
        const double* const B = is_symmetric ? A : A + rows;
        for (int i = 0; i < rows; ++i) {
          for (int j = is_symmetric ? i - i % 4 : 0; j < cols; ++j) {
            double sum = 0;
            for (int k = 0; k < terms; ++k) sum += A[k * stride + i] * B[k * stride + j];
            expected[static_cast<std::size_t>(i * stride_c + j)] -= sum;
          }
        }
        SubtractProduct(A, B, {terms, stride, rows, cols, stride_c, is_symmetric}, C.data());
        EXPECT_EQ(C, expected) << rows << " x " << cols << (is_symmetric ? " symmetric" : "");
      }
    }
  }
}

TEST(DenseKernelsTest, APanelIsFactorised) {
  using Panel = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  std::mt19937_64 random(5);
  for (int n = 1; n <= 21; ++n) {
    const int width = n + n % 6;
    const std::vector<double> values =
        RandomDoubles(static_cast<std::size_t>(n * n + n * width), &random);
    const Eigen::Map<const Panel> root(values.data(), n, n);
    Panel panel = Eigen::Map<const Panel>(values.data() + n * n, n, width);
    panel.leftCols(n) = root * root.transpose() + Panel::Identity(n, n);
    const Panel before = panel;
    ASSERT_TRUE(FactorisePanel(panel.data(), n, width, width));
    const Panel U = panel.leftCols(n).triangularView<Eigen::Upper>();
    EXPECT_LT((U.transpose() * U - before.leftCols(n)).norm(), 1e-12 * before.norm());
    EXPECT_LT((U.transpose() * panel.rightCols(width - n) - before.rightCols(width - n)).norm(),
              1e-12 * before.norm());
  }
}

TEST(DenseKernelsTest, WhatIsNotPositiveDefiniteIsRefused) {
  std::vector<double> panel = {1, 2, 2, 1};
  EXPECT_FALSE(FactorisePanel(panel.data(), 2, 2, 2));
}

TEST(DenseKernelsTest, AShareOfTheHessianIsAddedForEachSizeThereIs) {
  std::mt19937_64 random(7);
  for (int rows = 1; rows <= 6; ++rows) {
    for (const int a : {1, 3, 6}) {
      for (const int b : {1, 3, 6}) {
        const std::vector<double> A = RandomDoubles(static_cast<std::size_t>(rows * 7), &random);
        const std::vector<double> B = RandomDoubles(static_cast<std::size_t>(rows * 8), &random);
        std::vector<double> C = RandomDoubles(static_cast<std::size_t>(a * b + 1), &random);
        std::vector<double> expected = C;  // what follows C stays
        for (int i = 0; i < a; ++i) {
          for (int j = 0; j < b; ++j) {
            double& sum = expected[static_cast<std::size_t>(i * b + j)];
            for (int k = 0; k < rows; ++k) {
              sum +=
                  A[static_cast<std::size_t>(k * 7 + i)] * B[static_cast<std::size_t>(k * 8 + j)];
            }
          }
        }
        FindAddProduct(rows, a, b)(A.data(), 7, B.data(), 8, C.data());
        EXPECT_EQ(C, expected) << rows << " rows, " << a << " x " << b;
      }
    }
  }
}

TEST(DenseKernelsDeathTest, OtherSizesAreRefused) {
  for (const int size : {0, 2, 4, 5, 7}) {
    EXPECT_DEATH(FindAddProduct(3, size, 3), "check failed: size == 1") << size;
    EXPECT_DEATH(FindAddProduct(3, 6, size), "check failed: size == 1") << size;
  }
  EXPECT_DEATH(FindAddProduct(0, 3, 3), "check failed");
  EXPECT_DEATH(FindAddProduct(7, 3, 3), "check failed");
}

}  // namespace
}  // namespace airdos
