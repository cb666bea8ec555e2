// SPDX-License-Identifier: BSD-3-Clause
#include <repel/network/elements/dense.hpp>

#include <cmath>
#include <cstring>

#include <Eigen/Core>

namespace repel::network::dense {

void Six::store(double* p) const noexcept {
  std::memcpy(p, &a_, sizeof a_);
  std::memcpy(p + 2, &b_, sizeof b_);
  std::memcpy(p + 4, &c_, sizeof c_);
}

void Six::add(double scale, const Six& other) noexcept {
  a_ += scale * other.a_;
  b_ += scale * other.b_;
  c_ += scale * other.c_;
}

double Six::dot(const Six& other) const noexcept {
  const Two sum = a_ * other.a_ + b_ * other.b_ + c_ * other.c_;
  return sum[0] + sum[1];
}

Six Six::times(double scale) const noexcept {
  Six multiple = *this;
  multiple.a_ *= scale;
  multiple.b_ *= scale;
  multiple.c_ *= scale;
  return multiple;
}

Six::Two Six::two(const double* p) noexcept {
  Two loaded;
  std::memcpy(&loaded, p, sizeof loaded);
  return loaded;
}

bool factor_positive(double* L, double* inverse, int n) noexcept {
  double least[most_rows];  // of the pivots
  for (int k = 0; k < n; ++k) least[k] = 1e-9 * L[n * k + k];
  for (int k = 0; k < n; ++k) {
    double* const column = L + std::ptrdiff_t{n} * k;
    if (!(column[k] > least[k])) return false;
    inverse[k] = 1.0 / column[k];
    if (n == 6) {  // whole columns: what is above the diagonal costs less than odd lengths
      const Six pivot(column);
      for (int j = k + 1; j < 6; ++j) {
        Six other(L + std::ptrdiff_t{6} * j);
        other.add(-column[j] * inverse[k], pivot);
        other.store(L + std::ptrdiff_t{6} * j);
      }
      pivot.times(inverse[k]).store(column);
      continue;
    }
    for (int j = k + 1; j < n; ++j) {
      const double share = column[j] * inverse[k];
      for (int i = j; i < n; ++i) L[n * j + i] -= share * column[i];
    }
    for (int i = k + 1; i < n; ++i) column[i] *= inverse[k];
  }
  return true;
}

bool invert_positive(double* A, Eigen::Index n) noexcept {
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

namespace {

/// Turns rows and columns p and q of A so that its entry there becomes zero, and the columns of V.
void rotate(double* A, double* V, int n, int p, int q) noexcept {
  const double x = A[n * q + p];
  if (x == 0.0) return;
  const double half = 0.5 * (A[n * q + q] - A[n * p + p]);
  const double t = x / (half + std::copysign(std::sqrt(half * half + x * x), half));
  const double c = 1.0 / std::sqrt(1.0 + t * t);
  const double s = t * c;
  const auto turn = [c, s](double& a, double& b) {
    const double first = c * a - s * b;
    b = s * a + c * b;
    a = first;
  };
  for (int k = 0; k < n; ++k) turn(A[n * p + k], A[n * q + k]);
  for (int k = 0; k < n; ++k) turn(A[n * k + p], A[n * k + q]);
  for (int k = 0; k < n; ++k) turn(V[n * p + k], V[n * q + k]);
  A[n * q + p] = A[n * p + q] = 0.0;
}

}  // namespace

void diagonalize(double* A, double* V, int n) noexcept {
  double size = 0.0;
  for (int k = 0; k < n * n; ++k) {
    V[k] = k % (n + 1) == 0 ? 1.0 : 0.0;
    size += A[k] * A[k];
  }
  for (int sweep = 0; sweep < most_sweeps; ++sweep) {
    double left = 0.0;
    for (int q = 1; q < n; ++q) {
      for (int p = 0; p < q; ++p) left += A[n * q + p] * A[n * q + p];
    }
    if (!(left > 1e-30 * size)) return;
    for (int q = 1; q < n; ++q) {
      for (int p = 0; p < q; ++p) rotate(A, V, n, p, q);
    }
  }
}

}  // namespace repel::network::dense
