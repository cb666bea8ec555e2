/// @file
/// Products of small matrices of sizes known at set-up, in plain loops: Eigen expressions of such
/// sizes add seconds to the compile time of every source that includes a network.
#pragma once

#include <Eigen/Core>

namespace repel::network::dense {

/// y += scale A x. Sizes must match; y must not alias A or x.
template <class A, class X, class Y>
void add_product(const A& matrix, const X& x, Y& y, double scale = 1.0) noexcept {
  for (Eigen::Index k = 0; k < matrix.cols(); ++k) {
    const double share = scale * x.coeff(k);
    for (Eigen::Index i = 0; i < matrix.rows(); ++i) y.coeffRef(i) += share * matrix.coeff(i, k);
  }
}

/// A x as a `Y`. Sizes must match.
template <class Y, class A, class X>
[[nodiscard]] Y product(const A& matrix, const X& x) noexcept {
  Y y(matrix.rows());
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
    double sum = 0.0;
    for (Eigen::Index k = 0; k < matrix.cols(); ++k) sum += matrix.coeff(i, k) * x.coeff(k);
    y.coeffRef(i) = sum;
  }
  return y;
}

/// y = A' x. Sizes must match; y must not alias A or x.
template <class A, class X, class Y>
void transposed_product(const A& matrix, const X& x, Y& y) noexcept {
  y.resize(matrix.cols());
  for (Eigen::Index k = 0; k < matrix.cols(); ++k) {
    double sum = 0.0;
    for (Eigen::Index i = 0; i < matrix.rows(); ++i) sum += matrix.coeff(i, k) * x.coeff(i);
    y.coeffRef(k) = sum;
  }
}

/// The inverse of a symmetric positive definite n x n matrix by columns, in place. False, and the
/// matrix is as it was, when it is singular. `fixed`: n, if it is known, so that loops are
/// unrolled; 0: it is not.
///
/// By A = L D L', L with a diagonal of ones, and the inverse of L: without a square root, which the
/// next pivot would wait for (Eigen's would pull in heap allocation for sizes that cannot occur).
/// Rounding makes the pivot of a rigid direction tiny instead of zero, the more so where its
/// diagonal entry is a small part of the matrix. Each pivot is compared with its own diagonal
/// entry, so that the test does not depend on units. Entries above the diagonal are not read.
template <int fixed>
[[nodiscard]] bool invert_positive_of(double* A, Eigen::Index size) noexcept {
  constexpr int capacity = fixed > 0 ? fixed : 16;
  const int n = fixed > 0 ? fixed : static_cast<int>(size);
  double L[capacity * capacity];
  double inverse[capacity];  // of the pivots
  for (int k = 0; k < n * n; ++k) L[k] = A[k];
  for (int k = 0; k < n; ++k) {
    double* const column = L + n * k;
    if (!(column[k] > 1e-9 * A[n * k + k])) return false;
    inverse[k] = 1.0 / column[k];
    for (int j = k + 1; j < n; ++j) {
      const double share = column[j] * inverse[k];
      for (int i = j; i < n; ++i) L[n * j + i] -= share * column[i];
    }
    for (int i = k + 1; i < n; ++i) column[i] *= inverse[k];
  }
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
[[nodiscard]] inline bool invert_positive(double* A, Eigen::Index n) noexcept {
  switch (n) {
    case 1:
      return invert_positive_of<1>(A, n);
    case 6:
      return invert_positive_of<6>(A, n);
    case 7:
      return invert_positive_of<7>(A, n);
    default:
      return invert_positive_of<0>(A, n);
  }
}

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
