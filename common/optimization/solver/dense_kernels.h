#ifndef AIRDOS_COMMON_OPTIMIZATION_SOLVER_DENSE_KERNELS_H_
#define AIRDOS_COMMON_OPTIMIZATION_SOLVER_DENSE_KERNELS_H_

#include <Eigen/Core>

namespace airdos {

/// Where a product goes and how large it is.
struct ProductShape {
  int num_terms = 0;       ///< rows of A and B
  int stride = 0;          ///< of A and B, which are parts of one panel
  int rows = 0, cols = 0;  ///< of C
  int stride_c = 0;
  bool is_symmetric = false;  ///< only what stands on and above the diagonal of C is needed
};

/// C -= A^T B, all row-major. Nothing is allocated; the order of the sums is fixed.
void SubtractProduct(const double* a, const double* b, const ProductShape& shape, double* c);

/// Cholesky factorisation in place of the symmetric n x n left part A of a row-major panel [A B],
/// of which the upper half is read: A = U^T U, and B becomes U^-T B. Returns false where A is not
/// positive definite.
bool FactorisePanel(double* panel, int n, int width, int stride);

/// C += A^T B for row-major A (rows x a) and B (rows x b): one factor's share of the Hessian.
using AddProduct = void (*)(const double* A, int stride_a, const double* B, int stride_b,
                            double* C);
/// For 1 to 6 rows; a and b of 1, 3 or 6. Ends the process on others: a product of the wrong size
/// would write beyond C.
AddProduct FindAddProduct(int rows, int a, int b);

}  // namespace airdos

#endif  // AIRDOS_COMMON_OPTIMIZATION_SOLVER_DENSE_KERNELS_H_
