#ifndef AIRDOS_COMMON_OPTIMIZATION_SOLVER_DENSE_KERNELS_H_
#define AIRDOS_COMMON_OPTIMIZATION_SOLVER_DENSE_KERNELS_H_

#include <Eigen/Core>

namespace airdos {

/// Dimensions of a product C -= A^T B and of the memory that holds its matrices.
struct ProductShape {
  int num_terms = 0;       ///< rows of A and B
  int stride = 0;          ///< of A and B, which belong to one panel
  int rows = 0, cols = 0;  ///< of C
  int stride_c = 0;
  bool is_symmetric = false;  ///< only the upper triangle of C is needed
};

/// C -= A^T B, all row-major. Allocates nothing; the order of summation is fixed.
void SubtractProduct(const double* a, const double* b, const ProductShape& shape, double* c);

/// In-place Cholesky factorisation of the symmetric n x n left part A of a row-major panel [A B]: A
/// = U^T U, and B becomes U^-T B. Reads only the upper triangle of A. Returns false if A is not
/// positive definite.
bool FactorisePanel(double* panel, int n, int width, int stride);

/// C += A^T B for row-major A (rows x a) and B (rows x b): one factor's contribution to the
/// Hessian.
using AddProduct = void (*)(const double* A, int stride_a, const double* B, int stride_b,
                            double* C);
/// For 1 to 6 rows; a and b of 1, 3 or 6. Ends the process on others: a product of the wrong size
/// would write beyond C.
AddProduct FindAddProduct(int rows, int a, int b);

}  // namespace airdos

#endif  // AIRDOS_COMMON_OPTIMIZATION_SOLVER_DENSE_KERNELS_H_
