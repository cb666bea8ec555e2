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
