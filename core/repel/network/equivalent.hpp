/// @file
/// What a port shows of everything behind it.
#pragma once

#include <cmath>
#include <utility>

#include <repel/network/dense.hpp>
#include <repel/network/port.hpp>

namespace repel::network {

/// In which direction a port answers.
enum class Form {
  impedance,   ///< effort for a flow: f = b + R v
  admittance,  ///< flow for an effort: v = w + G f
};

/// All that lies behind a port, in one tick, as one line through effort and flow (Thevenin,
/// Norton). In the impedance form R is the port resistance at which nothing is reflected at once,
/// and the offset b is the wave that comes out whatever goes in: f - R v = b. The admittance form
/// is the same with the roles exchanged; it holds what no finite R can, a side that is moved and
/// cannot be pushed back in some direction, for which G is zero.
///
/// The matrix is symmetric positive semidefinite. Every operation keeps it so, and with it the
/// power balance of each tick: no term is left out or delayed.
template <int N>
struct Equivalent {
  Form form = Form::impedance;
  Mat<N> matrix;  ///< R [N s/m], [N m s/rad] or G, its inverse
  Vec<N> offset;  ///< b [N], [N m] or w [m/s], [rad/s]

  /// An element with resistance `R` that reflects `b`.
  void set_impedance(const Mat<N>& R, const Vec<N>& b) noexcept {
    form = Form::impedance;
    matrix = R;
    offset = b;
  }
  void set_admittance(const Mat<N>& G, const Vec<N>& w) noexcept {
    form = Form::admittance;
    matrix = G;
    offset = w;
  }

  /// A source of effort on the same flow: a common-flow junction with f = `b`, no resistance.
  void add_effort(const Vec<N>& b) noexcept {
    if (form == Form::impedance) {
      offset += b;
    } else {
      dense::add_product(matrix, b, offset, -1.0);
    }
  }
  /// A source of flow under the same effort: a common-effort junction with v = `w`.
  void add_flow(const Vec<N>& w) noexcept {
    if (form == Form::admittance) {
      offset += w;
    } else {
      dense::add_product(matrix, w, offset, -1.0);
    }
  }

  /// An element f = b + R v on the same flow (common-flow junction: efforts add).
  /// Cost: one sum, or 2 n^3 multiplications in the admittance form.
  void add_impedance(const Mat<N>& R, const Vec<N>& b) noexcept {
    if (form == Form::impedance) {
      matrix += R;
      offset += b;
    } else {
      combine(R, b);
    }
  }
  /// An element v = w + G f under the same effort (common-effort junction: flows add).
  void add_admittance(const Mat<N>& G, const Vec<N>& w) noexcept {
    if (form == Form::admittance) {
      matrix += G;
      offset += w;
    } else {
      combine(G, w);
    }
  }

  /// Brings it into `wanted`. False, and nothing is changed, when the matrix has no inverse: some
  /// direction is rigid (G has a zero) or free (R has a zero). Cost: n^3 multiplications.
  [[nodiscard]] bool take_form(Form wanted) noexcept {
    if (form == wanted) return true;
    if (!invert()) return false;
    form = wanted;
    return true;
  }

  /// Effort and flow where something else decides the flow (impedance form).
  void at_flow(const Vec<N>& v, PortState<N>& state) const noexcept {
    state.flow = v;
    state.effort = offset;
    dense::add_product(matrix, v, state.effort);
  }
  /// Effort and flow where something else decides the effort (admittance form).
  void at_effort(const Vec<N>& f, PortState<N>& state) const noexcept {
    state.effort = f;
    state.flow = offset;
    dense::add_product(matrix, f, state.flow);
  }

 private:
  // By Cholesky's factor L and its inverse (Eigen's would bring in the heap for sizes that cannot
  // occur). Rounding leaves a rigid direction with a pivot that is tiny, not zero; more so where
  // the entry on the diagonal is itself a small part of the matrix. Each is measured by its own
  // entry, so that units of different size make no difference. What is above the diagonal is not
  // read.
  [[nodiscard]] bool invert() noexcept {
    Mat<N> L = matrix;
    if (!factor(L)) return false;
    invert_triangle(L);
    const Eigen::Index n = matrix.rows();
    const Vec<N> b = offset;
    offset.setZero();
    for (Eigen::Index i = 0; i < n; ++i) {
      for (Eigen::Index j = 0; j <= i; ++j) {
        double sum = 0.0;
        for (Eigen::Index k = i; k < n; ++k) sum += L.coeff(k, i) * L.coeff(k, j);
        matrix.coeffRef(i, j) = matrix.coeffRef(j, i) = sum;
      }
    }
    dense::add_product(matrix, b, offset, -1.0);
    return true;
  }
  // L L' = what L comes with.
  [[nodiscard]] bool factor(Mat<N>& L) const noexcept {
    const Eigen::Index n = L.rows();
    for (Eigen::Index k = 0; k < n; ++k) {
      const double pivot = L.coeff(k, k);
      if (!(pivot > 1e-9 * matrix.coeff(k, k))) return false;
      const double scale = 1.0 / std::sqrt(pivot);
      for (Eigen::Index i = k; i < n; ++i) L.coeffRef(i, k) *= scale;
      for (Eigen::Index j = k + 1; j < n; ++j) {
        const double share = L.coeff(j, k);
        for (Eigen::Index i = j; i < n; ++i) L.coeffRef(i, j) -= share * L.coeff(i, k);
      }
    }
    return true;
  }
  // In place, column by column.
  static void invert_triangle(Mat<N>& L) noexcept {
    const Eigen::Index n = L.rows();
    for (Eigen::Index j = 0; j < n; ++j) {
      L.coeffRef(j, j) = 1.0 / L.coeff(j, j);
      for (Eigen::Index i = j + 1; i < n; ++i) {
        double sum = 0.0;
        for (Eigen::Index k = j; k < i; ++k) sum += L.coeff(i, k) * L.coeff(k, j);
        L.coeffRef(i, j) = -sum / L.coeff(i, i);
      }
    }
  }

  // f = b + R v with v = v' + w + G f, or the same with the roles exchanged:
  //     (I + R G) f = b - R w + R v'
  // R G has no negative eigenvalue, so that the left side can always be solved.
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

  // Turns matrix and offset into left^-1 of them, by rows, with the largest pivot of each column
  // (Eigen's LU would bring in the heap for sizes that cannot occur).
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
  // Row i less `share` of row k; of `left`, what is before column k is done with.
  void subtract_row(Mat<N>& left, Eigen::Index i, double share, Eigen::Index k) noexcept {
    const Eigen::Index n = left.rows();
    for (Eigen::Index j = k; j < n; ++j) left.coeffRef(i, j) -= share * left.coeff(k, j);
    for (Eigen::Index j = 0; j < n; ++j) matrix.coeffRef(i, j) -= share * matrix.coeff(k, j);
    offset.coeffRef(i) -= share * offset.coeff(k);
  }
};

}  // namespace repel::network
