/// @file
/// What a port shows of everything behind it.
#pragma once

#include <cmath>
#include <utility>

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
      offset -= matrix.lazyProduct(b);
    }
  }
  /// A source of flow under the same effort: a common-effort junction with v = `w`.
  void add_flow(const Vec<N>& w) noexcept {
    if (form == Form::admittance) {
      offset += w;
    } else {
      offset -= matrix.lazyProduct(w);
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
    state.effort += matrix.lazyProduct(v);
  }
  /// Effort and flow where something else decides the effort (admittance form).
  void at_effort(const Vec<N>& f, PortState<N>& state) const noexcept {
    state.effort = f;
    state.flow = offset;
    state.flow += matrix.lazyProduct(f);
  }

 private:
  // By Cholesky's factor L and its inverse (Eigen's would bring in the heap for sizes that cannot
  // occur). Rounding leaves a rigid direction with a pivot that is tiny, not zero; more so where
  // the entry on the diagonal is itself a small part of the matrix. Each is measured by its own
  // entry, so that units of different size make no difference. What is above the diagonal of L is
  // not read.
  [[nodiscard]] bool invert() noexcept {
    const Eigen::Index n = matrix.rows();
    Mat<N> L = matrix;
    for (Eigen::Index k = 0; k < n; ++k) {
      const double pivot = L(k, k);
      if (!(pivot > 1e-9 * matrix(k, k))) return false;
      L.col(k).tail(n - k) /= std::sqrt(pivot);
      for (Eigen::Index j = k + 1; j < n; ++j)
        L.col(j).tail(n - j) -= L(j, k) * L.col(k).tail(n - j);
    }
    Mat<N> inverse = Mat<N>::Identity(n, n);
    for (Eigen::Index k = 0; k < n; ++k) {
      inverse.row(k).head(k + 1) /= L(k, k);
      for (Eigen::Index i = k + 1; i < n; ++i) {
        inverse.row(i).head(k + 1) -= L(i, k) * inverse.row(k).head(k + 1);
      }
    }
    matrix = inverse.transpose().lazyProduct(inverse);
    const Vec<N> half = inverse.lazyProduct(offset);
    offset = -inverse.transpose().lazyProduct(half);
    return true;
  }

  // f = b + R v with v = v' + w + G f, or the same with the roles exchanged:
  //     (I + R G) f = b - R w + R v'
  // R G has no negative eigenvalue, so that the left side can always be solved.
  void combine(const Mat<N>& other, const Vec<N>& other_offset) noexcept {
    Mat<N> left = matrix.lazyProduct(other);
    left.diagonal().array() += 1.0;
    offset -= matrix.lazyProduct(other_offset);
    eliminate(left);
    matrix = 0.5 * (matrix + matrix.transpose()).eval();
  }

  // Turns matrix and offset into left^-1 of them, by rows, with the largest pivot of each column
  // (Eigen's LU would bring in the heap for sizes that cannot occur).
  void eliminate(Mat<N>& left) noexcept {
    const Eigen::Index n = left.rows();
    for (Eigen::Index k = 0; k < n; ++k) {
      Eigen::Index pivot = k;
      for (Eigen::Index i = k + 1; i < n; ++i) {
        if (std::abs(left(i, k)) > std::abs(left(pivot, k))) pivot = i;
      }
      left.row(k).swap(left.row(pivot));
      matrix.row(k).swap(matrix.row(pivot));
      std::swap(offset(k), offset(pivot));
      for (Eigen::Index i = 0; i < n; ++i) {
        if (i == k) continue;
        const double share = left(i, k) / left(k, k);
        left.row(i) -= share * left.row(k);
        matrix.row(i) -= share * matrix.row(k);
        offset(i) -= share * offset(k);
      }
    }
    for (Eigen::Index k = 0; k < n; ++k) {
      matrix.row(k) /= left(k, k);
      offset(k) /= left(k, k);
    }
  }
};

}  // namespace repel::network
