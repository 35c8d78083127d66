#include "common/optimization/dense_kernels.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "common/util/check.h"

namespace airdos {
namespace {

constexpr int kTile = 4;  // of 4 x 4 doubles, which stay in registers
constexpr int kRowsPerStep = 8;

template <int kRows, int kCols>
void SubtractTile(const double* a, const double* b, const ProductShape& shape, double* c) {
  using Row = Eigen::Array<double, 1, kCols>;
  std::array<Row, kRows> sum;
  for (Row& row : sum) row.setZero();
  for (int k = 0; k < shape.num_terms; ++k) {
    const Row factor = Eigen::Map<const Row>(b);
    for (int i = 0; i < kRows; ++i) sum[i] += a[i] * factor;
    a += shape.stride;
    b += shape.stride;
  }
  for (int i = 0; i < kRows; ++i) Eigen::Map<Row>(c + i * shape.stride_c) -= sum[i];
}

using Tile = void (*)(const double*, const double*, const ProductShape&, double*);
template <int kRows>
Tile FindTile(int cols) {
  switch (cols) {
    case 1:
      return SubtractTile<kRows, 1>;
    case 2:
      return SubtractTile<kRows, 2>;
    case 3:
      return SubtractTile<kRows, 3>;
    default:
      return SubtractTile<kRows, 4>;
  }
}

Tile FindTile(int rows, int cols) {
  switch (rows) {
    case 1:
      return FindTile<1>(cols);
    case 2:
      return FindTile<2>(cols);
    case 3:
      return FindTile<3>(cols);
    default:
      return FindTile<4>(cols);
  }
}

template <int kRows, int kA, int kB>
void AddFixedProduct(const double* A, int stride_a, const double* B, int stride_b, double* C) {
  for (int i = 0; i < kA; ++i) {
    for (int j = 0; j < kB; ++j) {
      double sum = C[i * kB + j];
      for (int k = 0; k < kRows; ++k) sum += A[k * stride_a + i] * B[k * stride_b + j];
      C[i * kB + j] = sum;
    }
  }
}

template <int kRows, int kA>
AddProduct FindAddProduct(int b) {
  return b == 1   ? AddFixedProduct<kRows, kA, 1>
         : b == 3 ? AddFixedProduct<kRows, kA, 3>
                  : AddFixedProduct<kRows, kA, 6>;
}

template <int kRows>
AddProduct FindAddProduct(int a, int b) {
  return a == 1   ? FindAddProduct<kRows, 1>(b)
         : a == 3 ? FindAddProduct<kRows, 3>(b)
                  : FindAddProduct<kRows, 6>(b);
}

}  // namespace

void SubtractProduct(const double* a, const double* b, const ProductShape& shape, double* c) {
  for (int i = 0; i < shape.rows; i += kTile) {
    const int rows = std::min(kTile, shape.rows - i);
    double* const c_row = c + i * shape.stride_c;
    int j = shape.is_symmetric ? i : 0;
    if (rows == kTile) {
      for (; j + kTile <= shape.cols; j += kTile) {
        SubtractTile<kTile, kTile>(a + i, b + j, shape, c_row + j);
      }
      if (j < shape.cols) FindTile<kTile>(shape.cols - j)(a + i, b + j, shape, c_row + j);
      continue;
    }
    for (; j < shape.cols; j += kTile) {
      FindTile(rows, std::min(kTile, shape.cols - j))(a + i, b + j, shape, c_row + j);
    }
  }
}

bool FactorisePanel(double* panel, int n, int width, int stride) {
  for (int first = 0; first < n; first += kRowsPerStep) {
    const int last = std::min(first + kRowsPerStep, n);
    for (int i = first; i < last; ++i) {
      double* const row = panel + i * stride;
      const double pivot = row[i];
      if (!(pivot > 0) || !std::isfinite(pivot)) return false;
      const double scale = 1 / std::sqrt(pivot);
      Eigen::Map<Eigen::ArrayXd>(row + i, width - i) *= scale;
      for (int below = i + 1; below < last; ++below) {
        const int num = width - below;
        Eigen::Map<Eigen::ArrayXd>(panel + below * stride + below, num) -=
            row[below] * Eigen::Map<const Eigen::ArrayXd>(row + below, num);
      }
    }
    if (last == n) break;
    const double* const rows = panel + first * stride + last;
    SubtractProduct(rows, rows, {last - first, stride, n - last, width - last, stride, true},
                    panel + last * stride + last);
  }
  return true;
}

AddProduct FindAddProduct(int rows, int a, int b) {
  switch (rows) {
    case 1:
      return FindAddProduct<1>(a, b);
    case 2:
      return FindAddProduct<2>(a, b);
    case 3:
      return FindAddProduct<3>(a, b);
    case 4:
      return FindAddProduct<4>(a, b);
    case 5:
      return FindAddProduct<5>(a, b);
    case 6:
      return FindAddProduct<6>(a, b);
    default:
      AIRDOS_CHECK(false);
  }
}

}  // namespace airdos
