// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Thevenin or Norton equivalent of everything behind a port.
#pragma once

#include <cmath>
#include <utility>

#include <repel/network/elements/dense.hpp>
#include <repel/network/elements/port.hpp>

namespace repel::network {

/// Form of the relation between effort and flow.
enum class Form {
  impedance,   ///< effort as a function of flow: f = b + R v
  admittance,  ///< flow as a function of effort: v = w + G f
};

/// Everything behind a port, in one tick, as an affine relation between effort and flow (Thevenin,
/// Norton equivalent). In the impedance form R is the port resistance without instantaneous
/// reflection, and the offset b is the reflected wave, whatever the incident one: f - R v = b. The
/// admittance form has the roles exchanged. It also represents an imposed flow in some direction,
/// by G = 0: no finite R can.
///
/// The matrix is symmetric positive semidefinite. Every operation preserves this, and with it the
/// exact power balance of each tick: no term is neglected or delayed.
template <int N>
struct Equivalent {
  Form form = Form::impedance;  ///< which of effort and flow depends on the other
  Mat<N> matrix;                ///< R [N s/m], [N m s/rad] or G, its inverse
  Vec<N> offset;                ///< b [N], [N m] or w [m/s], [rad/s]

  /// An element with resistance `R` that reflects `b`.
  void set_impedance(const Mat<N>& R, const Vec<N>& b) noexcept {
    form = Form::impedance;
    matrix = R;
    offset = b;
  }
  /// Sets flow = G effort + w.
  void set_admittance(const Mat<N>& G, const Vec<N>& w) noexcept {
    form = Form::admittance;
    matrix = G;
    offset = w;
  }

  /// True if effort and flow are independent: the diagonal of the matrix is zero, and so is all of
  /// it.
  [[nodiscard]] bool is_source() const noexcept {
    for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
      if (matrix.coeff(i, i) != 0.0) return false;
    }
    return true;
  }

  /// Adds an effort source at the same flow: a common-flow junction with f = `b`, no resistance.
  void add_effort(const Vec<N>& b) noexcept {
    if (form == Form::impedance) {
      offset += b;
    } else {
      dense::add_product(matrix, b, offset, -1.0);
    }
  }
  /// Adds a flow source at the same effort: a common-effort junction with v = `w`.
  void add_flow(const Vec<N>& w) noexcept {
    if (form == Form::admittance) {
      offset += w;
    } else {
      dense::add_product(matrix, w, offset, -1.0);
    }
  }

  /// Adds an element f = b + R v at the same flow (common-flow junction: efforts add). Cost: one
  /// sum, or 2 n^3 multiplications in the admittance form.
  void add_impedance(const Mat<N>& R, const Vec<N>& b) noexcept {
    if (form == Form::impedance) {
      matrix += R;
      offset += b;
    } else {
      combine(R, b);
    }
  }
  /// Adds an element v = w + G f at the same effort (common-effort junction: flows add).
  void add_admittance(const Mat<N>& G, const Vec<N>& w) noexcept {
    if (form == Form::admittance) {
      matrix += G;
      offset += w;
    } else {
      combine(G, w);
    }
  }
  /// The same with the diagonal `g` of G.
  void add_diagonal_admittance(const Vec<N>& g, const Vec<N>& w) noexcept {
    if (form != Form::admittance) return combine(g.asDiagonal(), w);
    for (Eigen::Index i = 0; i < g.size(); ++i) {
      matrix.coeffRef(i, i) += g.coeff(i);
      offset.coeffRef(i) += w.coeff(i);
    }
  }

  /// Converts to the form `wanted`. False, and nothing is changed, when the matrix is singular:
  /// some direction is rigid (G singular) or free (R singular). Cost: n^3 multiplications.
  [[nodiscard]] bool take_form(Form wanted) noexcept {
    if (form == wanted) return true;
    if (!invert()) return false;
    form = wanted;
    return true;
  }

  /// Effort and flow for the imposed flow `v` (impedance form only).
  void at_flow(const Vec<N>& v, PortState<N>& state) const noexcept {
    state.flow = v;
    state.effort = offset;
    if (!is_source()) dense::add_product(matrix, v, state.effort);
  }
  /// Effort and flow for the imposed effort `f` (admittance form only).
  void at_effort(const Vec<N>& f, PortState<N>& state) const noexcept {
    state.effort = f;
    state.flow = offset;
    dense::add_product(matrix, f, state.flow);
  }

 private:
  [[nodiscard]] bool invert() noexcept {
    if (!dense::invert_positive(matrix.data(), matrix.rows())) return false;
    const Vec<N> b = offset;
    offset.setZero();
    dense::add_product(matrix, b, offset, -1.0);
    return true;
  }

  // f = b + R v with v = v' + w + G f, or the same with the roles exchanged:
  //     (I + R G) f = b - R w + R v'
  // R G has no negative eigenvalue, so I + R G is invertible.
  void combine(const Mat<N>& other, const Vec<N>& other_offset) noexcept {
    const Eigen::Index n = matrix.rows();
    Mat<N> left;
    left.setIdentity(n, n);
    for (Eigen::Index j = 0; j < n; ++j) {
      for (Eigen::Index k = 0; k < n; ++k) {
        const double share = other.coeff(k, j);
        for (Eigen::Index i = 0; i < n; ++i) left.coeffRef(i, j) += matrix.coeff(i, k) * share;
      }
    }
    dense::add_product(matrix, other_offset, offset, -1.0);
    eliminate(left);
    for (Eigen::Index j = 0; j < n; ++j) {
      for (Eigen::Index i = 0; i < j; ++i) {
        const double mean = 0.5 * (matrix.coeff(i, j) + matrix.coeff(j, i));
        matrix.coeffRef(i, j) = matrix.coeffRef(j, i) = mean;
      }
    }
  }

  // Replaces matrix and offset by left^-1 times them: Gauss-Jordan elimination with partial
  // pivoting (Eigen's LU would pull in heap allocation for sizes that cannot occur).
  void eliminate(Mat<N>& left) noexcept {
    const Eigen::Index n = left.rows();
    for (Eigen::Index k = 0; k < n; ++k) {
      Eigen::Index pivot = k;
      for (Eigen::Index i = k + 1; i < n; ++i) {
        if (std::abs(left.coeff(i, k)) > std::abs(left.coeff(pivot, k))) pivot = i;
      }
      for (Eigen::Index j = 0; j < n; ++j) {
        std::swap(left.coeffRef(k, j), left.coeffRef(pivot, j));
        std::swap(matrix.coeffRef(k, j), matrix.coeffRef(pivot, j));
      }
      std::swap(offset.coeffRef(k), offset.coeffRef(pivot));
      for (Eigen::Index i = 0; i < n; ++i) {
        if (i != k) subtract_row(left, i, left.coeff(i, k) / left.coeff(k, k), k);
      }
    }
    for (Eigen::Index k = 0; k < n; ++k) {
      const double scale = 1.0 / left.coeff(k, k);
      for (Eigen::Index j = 0; j < n; ++j) matrix.coeffRef(k, j) *= scale;
      offset.coeffRef(k) *= scale;
    }
  }
  // Subtracts `share` times row k from row i; columns of `left` before k are already eliminated.
  void subtract_row(Mat<N>& left, Eigen::Index i, double share, Eigen::Index k) noexcept {
    const Eigen::Index n = left.rows();
    for (Eigen::Index j = k; j < n; ++j) left.coeffRef(i, j) -= share * left.coeff(k, j);
    for (Eigen::Index j = 0; j < n; ++j) matrix.coeffRef(i, j) -= share * matrix.coeff(k, j);
    offset.coeffRef(i) -= share * offset.coeff(k);
  }
};

}  // namespace repel::network
