// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Products of small matrices of sizes known at set-up, in plain loops: Eigen expressions of such
/// sizes add seconds to the compile time of every source that includes a network.
#pragma once

#include <Eigen/Core>

namespace repel::network::dense {

/// Rows of the largest matrix.
inline constexpr int most_rows = 16;

/// Six numbers, as many as a tool port has, in registers of two.
class Six {
 public:
  Six() = default;
  /// The six from `p` on.
  explicit Six(const double* p) noexcept : a_(two(p)), b_(two(p + 2)), c_(two(p + 4)) {}
  /// Writes the six numbers to p.
  void store(double* p) const noexcept;
  /// Adds `scale` times the other six.
  void add(double scale, const Six& other) noexcept;
  /// Scalar product.
  [[nodiscard]] double dot(const Six& other) const noexcept;
  /// Multiple.
  [[nodiscard]] Six times(double scale) const noexcept;

 private:
  using Two = double __attribute__((vector_size(16)));
  static Two two(const double* p) noexcept;
  Two a_{}, b_{}, c_{};
};

/// y += scale A x. Sizes must match; y must not alias A or x.
template <class A, class X, class Y>
void add_product(const A& matrix, const X& x, Y& y, double scale = 1.0) noexcept {
  const double* column = matrix.data();
  const Eigen::Index rows = matrix.rows();
  if (rows == 6) {
    Six sum(y.data());
    for (Eigen::Index k = 0; k < matrix.cols(); ++k)
      sum.add(scale * x.coeff(k), Six(column + 6 * k));
    return sum.store(y.data());
  }
  for (Eigen::Index k = 0; k < matrix.cols(); ++k, column += rows) {
    const double share = scale * x.coeff(k);
    for (Eigen::Index i = 0; i < rows; ++i) y.data()[i] += share * column[i];
  }
}

/// A x as a `Y`. Sizes must match.
template <class Y, class A, class X>
[[nodiscard]] Y product(const A& matrix, const X& x) noexcept {
  Y y(matrix.rows());
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) y.coeffRef(i) = 0.0;
  add_product(matrix, x, y);
  return y;
}

/// y = A' x. Sizes must match; y must not alias A or x.
template <class A, class X, class Y>
void transposed_product(const A& matrix, const X& x, Y& y) noexcept {
  y.resize(matrix.cols());
  if constexpr (A::RowsAtCompileTime == 6 && !A::IsRowMajor) {
    const Six six(x.data());
    for (Eigen::Index k = 0; k < matrix.cols(); ++k) {
      y.coeffRef(k) = six.dot(Six(matrix.data() + 6 * k));
    }
    return;
  }
  for (Eigen::Index k = 0; k < matrix.cols(); ++k) {
    double sum = 0.0;
    for (Eigen::Index i = 0; i < matrix.rows(); ++i) sum += matrix.coeff(i, k) * x.coeff(i);
    y.coeffRef(k) = sum;
  }
}

/// A = L D L' of a symmetric positive definite n x n matrix by columns. L replaces it, its unit
/// diagonal not written; the inverse of D is in `inverse`. False when the matrix is singular.
///
/// Without a square root: the next pivot would wait for it (Eigen's would pull in heap allocation
/// for sizes that cannot occur). Rounding makes the pivot of a rigid direction tiny instead of
/// zero, the more so where its diagonal entry is a small part of the matrix. Each pivot is compared
/// with its own diagonal entry, so that the test does not depend on units. Entries above the
/// diagonal do not matter.
[[nodiscard]] bool factor_positive(double* L, double* inverse, int n) noexcept;

/// The inverse of a symmetric positive definite n x n matrix by columns, in place, from its factors
/// and the inverse of L. False, and the matrix is as it was, when it is singular.
template <int fixed>
[[nodiscard]] bool invert_positive_of(double* A, Eigen::Index size) noexcept {
  constexpr int capacity = fixed > 0 ? fixed : most_rows;
  const int n = fixed > 0 ? fixed : static_cast<int>(size);
  double L[capacity * capacity];
  double inverse[capacity];  // of the pivots
  for (int k = 0; k < n * n; ++k) L[k] = A[k];
  if (!factor_positive(L, inverse, n)) return false;
  for (int j = 0; j < n; ++j) {
    for (int i = j + 1; i < n; ++i) {
      double sum = L[n * j + i];
      for (int k = j + 1; k < i; ++k) sum += L[n * k + i] * L[n * j + k];
      L[n * j + i] = -sum;
    }
  }
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j <= i; ++j) {
      double sum = i == j ? inverse[i] : inverse[i] * L[n * j + i];
      for (int k = i + 1; k < n; ++k) sum += inverse[k] * L[n * i + k] * L[n * j + k];
      A[n * j + i] = A[n * i + j] = sum;
    }
  }
  return true;
}
/// The inverse of a symmetric positive definite n x n matrix, in place. False when it is singular.
[[nodiscard]] bool invert_positive(double* A, Eigen::Index n) noexcept;

/// A symmetric positive definite matrix as L D L', for solutions where its inverse is not needed.
class Factored {
 public:
  /// Factors the n x n matrix whose entries, by columns, are entry(0), entry(1) and so on. False
  /// when it is singular.
  template <class Entry>
  [[nodiscard]] bool factor(Eigen::Index n, const Entry& entry) noexcept {
    L_.resize(n, n);
    inverse_.resize(n);
    for (Eigen::Index k = 0; k < n * n; ++k) L_.data()[k] = entry(k);
    return factor_positive(L_.data(), inverse_.data(), static_cast<int>(n));
  }

  /// Number of rows.
  [[nodiscard]] int size() const noexcept { return static_cast<int>(inverse_.size()); }
  /// Entry i, k of L, below the diagonal.
  [[nodiscard]] double lower(int i, int k) const noexcept { return L_.data()[size() * k + i]; }
  /// Entry k of D^-1.
  [[nodiscard]] double inverse(int k) const noexcept { return inverse_.data()[k]; }

  /// x = L^-1 x.
  template <class X>
  void descend(X& x) const noexcept {
    for (int k = 0; k < size(); ++k) {
      const double share = x.coeff(k);
      for (int i = k + 1; i < size(); ++i) x.coeffRef(i) -= share * lower(i, k);
    }
  }
  /// x = A^-1 x.
  template <class X>
  void solve(X& x) const noexcept {
    descend(x);
    for (int i = size() - 1; i >= 0; --i) {
      double sum = inverse(i) * x.coeff(i);
      for (int k = i + 1; k < size(); ++k) sum -= lower(k, i) * x.coeff(k);
      x.coeffRef(i) = sum;
    }
  }

 private:
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, most_rows, most_rows> L_;
  Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, most_rows, 1> inverse_;
};

/// Turns a symmetric n x n matrix by columns into the diagonal of its eigenvalues, in place, and
/// writes its eigenvectors, of unit length, to the columns of `V`, in no order. Finite entries
/// only. Cost: at most `most_sweeps` sweeps of Jacobi rotations, 6 n^3 multiplications each; 4 to 7
/// in practice.
void diagonalize(double* A, double* V, int n) noexcept;
/// Sweeps after which `diagonalize` ends in any case.
inline constexpr int most_sweeps = 16;

/// C = A' S A, S symmetric. Sizes must match; C must not alias the others. Cost: half of
/// `sandwich`.
template <class A, class S, class C>
void congruence(const A& outer, const S& middle, C& product) noexcept {
  const Eigen::Index n = middle.rows();
  product.resize(outer.cols(), outer.cols());
  for (Eigen::Index j = 0; j < outer.cols(); ++j) {
    double column[16] = {};  // of S A
    for (Eigen::Index k = 0; k < n; ++k) {
      const double share = outer.coeff(k, j);
      for (Eigen::Index i = 0; i < n; ++i) column[i] += share * middle.coeff(i, k);
    }
    for (Eigen::Index i = 0; i <= j; ++i) {
      double sum = 0.0;
      for (Eigen::Index k = 0; k < n; ++k) sum += outer.coeff(k, i) * column[k];
      product.coeffRef(i, j) = product.coeffRef(j, i) = sum;
    }
  }
}

/// C = A' S B, S symmetric. Sizes must match; C must not alias the others.
template <class A, class S, class B, class C>
void sandwich(const A& left, const S& middle, const B& right, C& product) noexcept {
  product.resize(left.cols(), right.cols());
  for (Eigen::Index j = 0; j < right.cols(); ++j) {
    for (Eigen::Index i = 0; i < left.cols(); ++i) product.coeffRef(i, j) = 0.0;
    for (Eigen::Index k = 0; k < middle.cols(); ++k) {
      double column = 0.0;  // (S B)(k, j)
      for (Eigen::Index i = 0; i < middle.rows(); ++i)
        column += middle.coeff(i, k) * right.coeff(i, j);
      for (Eigen::Index i = 0; i < left.cols(); ++i)
        product.coeffRef(i, j) += left.coeff(k, i) * column;
    }
  }
}

}  // namespace repel::network::dense
