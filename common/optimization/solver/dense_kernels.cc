#include "common/optimization/solver/dense_kernels.h"

#include <algorithm>
#include <cmath>

#include "common/util/check.h"

namespace airdos {
namespace {

/// kNum adjacent doubles; a register holds two, or four with AVX. Each is accumulated on its own,
/// in the same order either way, and without fused multiply-adds, so results are identical to the
/// bit on every processor.
template <int kNum>
struct Doubles {
  // The vector need only be aligned like a double.
  typedef double Vector __attribute__((vector_size(kNum * sizeof(double)), aligned(8), may_alias));
};

constexpr int kTileRows = 4;  // a tile is 4 x 8 doubles, which stay in registers
constexpr int kRowsPerStep = 8;

/// A tile of kRows x (kNum kCols) entries of C, in vectors of kCols doubles.
template <int kRows, int kNum, int kCols>
[[gnu::always_inline]] inline void SubtractTile(const double* a, const double* b,
                                                const ProductShape& shape, double* c) {
  using Row = typename Doubles<kCols>::Vector;
  Row sum[kRows][kNum];
#pragma GCC unroll 4
  for (int i = 0; i < kRows; ++i) {
#pragma GCC unroll 2
    for (int n = 0; n < kNum; ++n) sum[i][n] = Row{};
  }
  for (int k = 0; k < shape.num_terms; ++k) {
    Row factor[kNum];
#pragma GCC unroll 2
    for (int n = 0; n < kNum; ++n) factor[n] = *reinterpret_cast<const Row*>(b + n * kCols);
#pragma GCC unroll 4
    for (int i = 0; i < kRows; ++i) {
#pragma GCC unroll 2
      for (int n = 0; n < kNum; ++n) sum[i][n] += a[i] * factor[n];
    }
    a += shape.stride;
    b += shape.stride;
  }
#pragma GCC unroll 4
  for (int i = 0; i < kRows; ++i) {
#pragma GCC unroll 2
    for (int n = 0; n < kNum; ++n) {
      *reinterpret_cast<Row*>(c + i * shape.stride_c + n * kCols) -= sum[i][n];
    }
  }
}

/// kRows rows of C, from column `j` on.
template <int kRows>
[[gnu::always_inline]] inline void SubtractRows(const double* a, const double* b,
                                                const ProductShape& shape, int j, double* c) {
  for (; j + 8 <= shape.cols; j += 8) SubtractTile<kRows, 2, 4>(a, b + j, shape, c + j);
  if (j + 4 <= shape.cols) {
    SubtractTile<kRows, 1, 4>(a, b + j, shape, c + j);
    j += 4;
  }
  if (j + 2 <= shape.cols) {
    SubtractTile<kRows, 1, 2>(a, b + j, shape, c + j);
    j += 2;
  }
  if (j == shape.cols) return;
  for (int i = 0; i < kRows; ++i) {
    double sum = 0;
    for (int k = 0; k < shape.num_terms; ++k)
      sum += a[k * shape.stride + i] * b[k * shape.stride + j];
    c[i * shape.stride_c + j] -= sum;
  }
}

[[gnu::always_inline]] inline void SubtractProductInline(const double* a, const double* b,
                                                         const ProductShape& shape, double* c) {
  int i = 0;
  for (; i + kTileRows <= shape.rows; i += kTileRows) {
    SubtractRows<kTileRows>(a + i, b, shape, shape.is_symmetric ? i : 0, c + i * shape.stride_c);
  }
  const int first = shape.is_symmetric ? i : 0;
  double* const rest = c + i * shape.stride_c;
  if (shape.rows - i == 3) {
    SubtractRows<3>(a + i, b, shape, first, rest);
  } else if (shape.rows - i == 2) {
    SubtractRows<2>(a + i, b, shape, first, rest);
  } else if (shape.rows - i == 1) {
    SubtractRows<1>(a + i, b, shape, first, rest);
  }
}

/// target -= factor * row
[[gnu::always_inline]] inline void SubtractScaled(const double* row, double factor, int num,
                                                  double* target) {
  using Four = Doubles<4>::Vector;
  int i = 0;
  for (; i + 4 <= num; i += 4) {
    *reinterpret_cast<Four*>(target + i) -= factor * *reinterpret_cast<const Four*>(row + i);
  }
  for (; i < num; ++i) target[i] -= factor * row[i];
}

[[gnu::always_inline]] inline bool FactorisePanelInline(double* panel, int n, int width,
                                                        int stride) {
  for (int first = 0; first < n; first += kRowsPerStep) {
    const int last = std::min(first + kRowsPerStep, n);
    for (int i = first; i < last; ++i) {
      double* const row = panel + i * stride;
      const double pivot = row[i];
      if (!(pivot > 0) || !std::isfinite(pivot)) return false;
      const double scale = 1 / std::sqrt(pivot);
      for (int j = i; j < width; ++j) row[j] *= scale;
      for (int below = i + 1; below < last; ++below) {
        SubtractScaled(row + below, row[below], width - below, panel + below * stride + below);
      }
    }
    if (last == n) break;
    const double* const rows = panel + first * stride + last;
    SubtractProductInline(rows, rows, {last - first, stride, n - last, width - last, stride, true},
                          panel + last * stride + last);
  }
  return true;
}

#if defined(__x86_64__)
[[gnu::target("avx")]] void SubtractProductAvx(const double* a, const double* b,
                                               const ProductShape& shape, double* c) {
  SubtractProductInline(a, b, shape, c);
}
[[gnu::target("avx")]] bool FactorisePanelAvx(double* panel, int n, int width, int stride) {
  return FactorisePanelInline(panel, n, width, stride);
}
bool HasAvx() { return __builtin_cpu_supports("avx") != 0; }
#endif

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
#if defined(__x86_64__)
  if (HasAvx()) return SubtractProductAvx(a, b, shape, c);
#endif
  SubtractProductInline(a, b, shape, c);
}

bool FactorisePanel(double* panel, int n, int width, int stride) {
#if defined(__x86_64__)
  if (HasAvx()) return FactorisePanelAvx(panel, n, width, stride);
#endif
  return FactorisePanelInline(panel, n, width, stride);
}

AddProduct FindAddProduct(int rows, int a, int b) {
  for (const int size : {a, b}) AIRDOS_CHECK(size == 1 || size == 3 || size == 6);
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
