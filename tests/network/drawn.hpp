// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Random gains and signals, and a network of one module, for the tests of networks.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <repel/network/elements/signals.hpp>
#include <repel/network/elements/two_port.hpp>
#include <repel/network/machinery/ledger.hpp>

#include "support/draws.hpp"
#include "support/families.hpp"

namespace repel::test {

using families::Rng;
using network::any_size;
using network::Side;
using Vector = network::Vec<any_size>;
using Matrix = network::Mat<any_size>;
using Equivalent = network::Equivalent<any_size>;
using State = network::PortState<any_size>;

inline constexpr double period = 0.0025;

/// Uniform in every component, up to `most`.
inline Vector drawn_vector(Rng& rng, int size, double most) {
  Vector v(size);
  for (double& x : v) x = families::uniform(rng, -most, most);
  return v;
}
/// Random symmetric matrix with eigenvalues from `low` to `high`, `zeros` of which are 0, and a
/// random orthogonal basis from reflections.
inline Matrix drawn_gain(Rng& rng, int size, double low, double high, int zeros = 0) {
  Matrix gain = Matrix::Zero(size, size);
  for (int i = zeros; i < size; ++i) gain(i, i) = families::log_uniform(rng, low, high);
  for (int mirrors = 0; mirrors < size; ++mirrors) {
    const Vector normal = drawn_vector(rng, size, 1.0).normalized();
    const Matrix mirror = Matrix::Identity(size, size) - 2.0 * normal * normal.transpose();
    gain = mirror.lazyProduct(gain.lazyProduct(mirror).eval()).eval();
  }
  return 0.5 * (gain + gain.transpose());
}

/// Symmetric positive semidefinite integer matrix, so that it is exactly singular.
inline Matrix drawn_singular(Rng& rng, int size) {
  Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(std::max(1, size - 1), size);
  if (size == 1) return rows;
  for (double& x : rows.reshaped()) x = families::count_between(rng, -3, 3);
  return rows.transpose().lazyProduct(rows);
}

/// Worst-case inputs of arm, world and two hands: everything moves at random, directions and frames
/// jump, walls appear and vanish, the Jacobian loses rank, the fail-safe engages.
class DrawnSignals {
 public:
  DrawnSignals(Rng& rng, int joints) : rng_(rng) {
    signals.joints.setZero(joints);
    signals.rates = signals.mean_rates = signals.arm_torques = signals.joints;
    signals.jacobian.setZero(6, joints);
    signals.period = period;
  }

  const network::Signals& next() {
    ++tick_;
    const auto n = static_cast<int>(signals.joints.size());
    const Vector noise = drawn_vector(rng_, n, 0.2);
    signals.mean_rates = signals.rates + noise;
    signals.joints += period * signals.mean_rates;
    signals.rates = 0.95 * signals.rates + noise;
    if (tick_ % 50 == 0) draw_frames(n);
    if (tick_ % 16 == 0) draw_hands();
    if (tick_ % 8 == 0) {
      const double most = tick_ % 400 < 200 ? 60.0 : 0.0;
      signals.walls = {drawn_vector(rng_, 3, most), drawn_vector(rng_, 3, 0.1 * most)};
      signals.arm_torques = drawn_vector(rng_, n, most);
    }
    signals.is_measured = tick_ % 1000 > 10;
    signals.measured.force = Vec3(30.0 * std::sin(0.1 * tick_), 10.0, 0.0);
    signals.measured.torque.z() = 3.0 * std::cos(0.03 * tick_);
    signals.at_rest = tick_ % 5000 > 4980;
    return signals;
  }

  network::Signals signals;

 private:
  void draw_frames(int joints) {
    signals.X_WT = families::random_pose(rng_, 0.0, 1.0);
    for (double& x : signals.jacobian.reshaped()) x = families::uniform(rng_, -1.0, 1.0);
    if (tick_ % 100 == 0 && joints > 1) signals.jacobian.col(1) = signals.jacobian.col(0);
    if (tick_ % 200 == 0) signals.jacobian.row(2).setZero();
  }
  void draw_hands() {
    signals.hand.ball = {families::uniform(rng_, 0.0, 0.4) * families::direction(rng_),
                         families::uniform(rng_, 0.0, 2.0) * families::direction(rng_)};
    signals.hand.lever_rate = families::uniform(rng_, -2.0, 2.0);
    if (tick_ % 160 == 0) {
      signals.hand.direction_W = families::direction(rng_);
      // At times the lever turns the tool as well.
      signals.hand.turning_W = families::uniform(rng_, -5.0, 10.0) * families::direction(rng_);
      if (tick_ % 320 == 0) signals.hand.turning_W = Vec3::Zero();
    }
  }

  Rng& rng_;
  int tick_ = 0;
};

/// Random one-ports at the ends of the module: new in each tick, without memory.
class DrawnEnds {
 public:
  DrawnEnds(Rng& rng, int size, double most_effort) : rng_(rng), most_effort_(most_effort) {
    for (int i = 0; i < 32; ++i) {
      definite_.push_back(drawn_gain(rng, size, 1e-2, 1e3));
      slack_.push_back(drawn_gain(rng, size, 1e-2, 1e3, (size + 1) / 2));
    }
  }
  /// A positive definite impedance: it can also be given as an admittance.
  [[nodiscard]] Equivalent definite() { return of(definite_); }
  /// A semidefinite impedance: a pure effort source in half of its directions.
  [[nodiscard]] Equivalent slack() { return of(slack_); }
  /// A flow source, independent of the effort.
  [[nodiscard]] Equivalent moved(double most) {
    const auto size = static_cast<int>(definite_[0].rows());
    Equivalent end;
    end.set_admittance(Matrix::Zero(size, size), drawn_vector(rng_, size, most));
    return end;
  }

 private:
  [[nodiscard]] Equivalent of(const std::vector<Matrix>& gains) {
    const Matrix& R = gains[rng_() % gains.size()];
    Equivalent end;
    end.set_impedance(R, drawn_vector(rng_, static_cast<int>(R.rows()), most_effort_));
    return end;
  }

  Rng& rng_;
  double most_effort_;
  std::vector<Matrix> definite_, slack_;
};

/// A two-port between leaf and root one-ports, with its ledger.
template <class M>
class Cell {
 public:
  Cell(M m, Side root) : module(std::move(m)) {
    if constexpr (requires { module.face(root); }) module.face(root);
    if constexpr (requires { module.prepare(period); }) module.prepare(period);
  }

  /// One tick; false if it cannot be solved.
  [[nodiscard]] bool run(const network::Signals& signals, Equivalent behind,
                         const Equivalent& root) {
    if constexpr (requires { module.read(signals); }) module.read(signals);
    if (!module.reflected(behind, shown)) return false;
    Equivalent sum = shown;
    if (root.form == network::Form::impedance) {
      sum.add_impedance(root.matrix, root.offset);
      if (!sum.take_form(network::Form::admittance)) return false;
      root.at_flow(sum.offset, at_root);
      at_root.effort = -at_root.effort;
    } else {
      if (!sum.take_form(network::Form::impedance)) return false;
      sum.at_flow(root.offset, at_root);
    }
    module.incident(at_root, behind, at_leaf);
    account();
    return true;
  }

  /// Residual of the state behind the module in the equation of the one-port there, relative to its
  /// terms.
  [[nodiscard]] double error_behind(const Equivalent& behind) const {
    const bool by_flow = behind.form == network::Form::impedance;
    const Vector answer = behind.matrix * (by_flow ? at_leaf.flow : at_leaf.effort);
    const Vector& is = by_flow ? at_leaf.effort : at_leaf.flow;
    const double scale = answer.norm() + behind.offset.norm() + is.norm() + 1e-6;
    return (answer + behind.offset - is).norm() / scale;
  }

  M module;
  Equivalent shown;
  State at_root, at_leaf;  ///< effort away from the root
  network::Ledger ledger;

 private:
  void account() {
    double weight = 1.0;
    double supplied = 0.0;
    if constexpr (requires { module.left_weight(); }) weight = module.left_weight();
    if constexpr (requires { module.supplied(); }) supplied = module.supplied();
    const bool leaf_is_left = at_leaf.effort.size() == 1;  // for a multiplex at the tool
    const double in = (leaf_is_left ? 1.0 : weight) * at_root.power();
    const double out = (leaf_is_left ? weight : 1.0) * at_leaf.power();
    ledger.add(period * (in - out), period * (std::abs(in) + std::abs(out)), period * supplied);
  }
};

inline const char* to_text(Side side) {
  return side == Side::left ? "root on the left" : "root on the right";
}

}  // namespace repel::test

// For the tests of the network, which are in namespaces within this one.
namespace repel::network {

using test::Cell;
using test::DrawnEnds;
using test::DrawnSignals;
using test::Matrix;
using test::Rng;
using test::State;
using test::Vector;

}  // namespace repel::network
