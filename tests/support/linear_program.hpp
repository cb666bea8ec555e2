// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// A simple linear programming solver as a test reference: simplex tableau with Bland's rule.
#pragma once

#include <cstddef>
#include <vector>

#include <support/quad.hpp>

namespace repel::oracle {

/// max sum c_j x_j  with  sum a_ij x_j <= b_i,  x_j >= 0  and b_i >= 0, so that x = 0 is feasible
/// as a start. Must be bounded.
class LinearProgram {
 public:
  explicit LinearProgram(std::vector<Real> objective) : costs_(std::move(objective)) {}

  void add(std::vector<Real> row, Real bound) {
    row.push_back(bound);
    rows_.push_back(std::move(row));
  }

  /// The largest value of the objective.
  Real solve() {
    const std::size_t n = costs_.size();
    const std::size_t m = rows_.size();
    std::vector<std::size_t> basis(m);
    for (std::size_t i = 0; i < m; ++i) {
      const Real bound = rows_[i].back();
      rows_[i].pop_back();
      rows_[i].resize(n + m);
      rows_[i][n + i] = 1;
      rows_[i].push_back(bound);
      basis[i] = n + i;
    }
    costs_.resize(n + m);
    Real value = 0;
    while (true) {
      std::size_t entering = 0;
      while (entering < n + m && !(costs_[entering] > Real(1e-25))) ++entering;
      if (entering == n + m) return value;
      std::size_t leaving = m;
      for (std::size_t i = 0; i < m; ++i) {
        if (!(rows_[i][entering] > Real(1e-25))) continue;
        if (leaving == m) {
          leaving = i;
          continue;
        }
        const Real left = rows_[i].back() * rows_[leaving][entering];
        const Real right = rows_[leaving].back() * rows_[i][entering];
        if (left < right || (left == right && basis[i] < basis[leaving])) leaving = i;
      }
      if (leaving == m) return Real(1e300);  // unbounded
      const Real pivot = rows_[leaving][entering];
      for (Real& x : rows_[leaving]) x = x / pivot;
      for (std::size_t i = 0; i < m; ++i) {
        if (i != leaving) subtract(rows_[i], rows_[i][entering], rows_[leaving]);
      }
      const Real cost = costs_[entering];
      value = value + cost * rows_[leaving].back();
      for (std::size_t j = 0; j < n + m; ++j) {
        costs_[j] = costs_[j] - cost * rows_[leaving][j];
      }
      basis[leaving] = entering;
    }
  }

 private:
  static void subtract(std::vector<Real>& from, Real times, const std::vector<Real>& row) {
    for (std::size_t j = 0; j < from.size(); ++j) from[j] = from[j] - times * row[j];
  }

  std::vector<Real> costs_;
  std::vector<std::vector<Real>> rows_;
};

}  // namespace repel::oracle
