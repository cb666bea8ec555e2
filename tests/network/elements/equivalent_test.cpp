// SPDX-License-Identifier: BSD-3-Clause
#include <repel/network/elements/equivalent.hpp>

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include "network/drawn.hpp"

namespace repel::network {
namespace equivalent_test {

constexpr unsigned seed = 77;
constexpr int draws = families::draws(3000);

/// Of size `n`; in one of three cases the matrix has `zeros` zero eigenvalues, exact up to
/// rounding.
Equivalent<any_size> drawn(Rng& rng, int n, Form form, int zeros) {
  Equivalent<any_size> some;
  some.form = form;
  some.matrix = test::drawn_gain(rng, n, 1e-2, 1e2, zeros);
  some.offset = test::drawn_vector(rng, n, 10.0);
  return some;
}

/// Residual of effort and flow in the equation of `of`, relative to its terms.
double off(const Equivalent<any_size>& of, const Vector& effort, const Vector& flow) {
  const bool impedance = of.form == Form::impedance;
  const Vector answer = of.matrix * (impedance ? flow : effort);
  const Vector& is = impedance ? effort : flow;
  return (answer + of.offset - is).norm() / (1e-6 + answer.norm() + of.offset.norm() + is.norm());
}

void expect_symmetric_semidefinite(const Matrix& matrix) {
  const double scale = matrix.norm();
  ASSERT_LE((matrix - matrix.transpose()).norm(), 1e-12 * scale);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(matrix, Eigen::EigenvaluesOnly);
  ASSERT_GE(solver.eigenvalues().minCoeff(), -1e-11 * scale);
}

/// Effort and flow of `first` and of `second` at a junction of common flow (of common effort),
/// where the sum of the efforts (flows) is `sum` and the junction shows `shown`: by brute force,
/// solving all equations at once.
void expect_joined(const Equivalent<any_size>& first, const Equivalent<any_size>& second,
                   bool common_flow, const Equivalent<any_size>& shown, const Vector& given) {
  const Eigen::Index n = first.offset.size();
  // Unknowns: f1, v1, f2, v2.
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(4 * n, 4 * n);
  Eigen::VectorXd b = Eigen::VectorXd::Zero(4 * n);
  const Eigen::MatrixXd I = Eigen::MatrixXd::Identity(n, n);
  const auto put = [&](Eigen::Index row, const Equivalent<any_size>& e, Eigen::Index column) {
    const bool impedance = e.form == Form::impedance;
    A.block(row, column, n, n) = impedance ? I : Eigen::MatrixXd(-e.matrix);
    A.block(row, column + n, n, n) = impedance ? Eigen::MatrixXd(-e.matrix) : I;
    b.segment(row, n) = e.offset;
  };
  put(0, first, 0);
  put(n, second, 2 * n);
  const Eigen::Index same = common_flow ? n : 0;
  const Eigen::Index added = common_flow ? 0 : n;
  A.block(2 * n, same, n, n) = I;
  A.block(2 * n, 2 * n + same, n, n) = -I;
  // From outside: the common quantity, or the sum, whichever `shown` takes.
  const bool takes_common = (shown.form == Form::impedance) == common_flow;
  A.block(3 * n, takes_common ? same : added, n, n) = I;
  if (!takes_common) A.block(3 * n, 2 * n + added, n, n) = I;
  b.segment(3 * n, n) = given;
  const Eigen::VectorXd x = A.fullPivLu().solve(b);
  ASSERT_LE((A * x - b).norm(), 1e-8 * (1.0 + b.norm() + x.norm()));
  const Vector common = x.segment(same, n);
  const Vector sum = x.segment(added, n) + x.segment(2 * n + added, n);
  ASSERT_LE(off(shown, common_flow ? sum : common, common_flow ? common : sum), 1e-7);
}

TEST(Equivalent, SumsAreWhatAllEquationsTogetherGive) {
  Rng rng(seed);
  for (int i = 0; i < draws; ++i) {
    SCOPED_TRACE(families::of_seed(seed, "draw", i));
    const int n = families::count_between(rng, 1, 7);
    const Form form = i % 2 == 0 ? Form::impedance : Form::admittance;
    // Free and rigid directions of all kinds, except pairs in which both sides prescribe the same.
    const auto first = drawn(rng, n, form, families::count_between(rng, 0, n));
    const Vector given = test::drawn_vector(rng, n, 3.0);
    const auto R = drawn(rng, n, Form::impedance, families::count_between(rng, 0, n));
    auto sum = first;
    sum.add_impedance(R.matrix, R.offset);
    EXPECT_EQ(sum.form, form);
    expect_symmetric_semidefinite(sum.matrix);
    expect_joined(first, R, true, sum, given);
    const auto G = drawn(rng, n, Form::admittance, families::count_between(rng, 0, n));
    sum = first;
    sum.add_admittance(G.matrix, G.offset);
    expect_symmetric_semidefinite(sum.matrix);
    expect_joined(first, G, false, sum, given);
    if (HasFatalFailure()) return;
  }
}

TEST(Equivalent, SourcesAreElementsWithoutResistance) {
  Rng rng(seed);
  for (int i = 0; i < draws; ++i) {
    const int n = families::count_between(rng, 1, 7);
    const auto first = drawn(rng, n, i % 2 == 0 ? Form::impedance : Form::admittance, i % 3 == 0);
    const Vector x = test::drawn_vector(rng, n, 3.0);
    for (const bool effort : {true, false}) {
      auto by_source = first;
      auto by_element = first;
      if (effort) {
        by_source.add_effort(x);
        by_element.add_impedance(Matrix::Zero(n, n), x);
      } else {
        by_source.add_flow(x);
        by_element.add_admittance(Matrix::Zero(n, n), x);
      }
      EXPECT_EQ(by_source.form, first.form);
      EXPECT_LE((by_source.matrix - by_element.matrix).norm(), 1e-12 * first.matrix.norm());
      EXPECT_LE((by_source.offset - by_element.offset).norm(), 1e-10 * (1.0 + first.matrix.norm()))
          << families::of_seed(seed, "draw", i);
    }
  }
}

// Duality: with effort and flow, and both forms, exchanged, every operation becomes the other.
TEST(Equivalent, IsItsOwnDual) {
  Rng rng(seed);
  for (int i = 0; i < draws; ++i) {
    const int n = families::count_between(rng, 1, 7);
    auto one = drawn(rng, n, i % 2 == 0 ? Form::impedance : Form::admittance, i % 3 == 0);
    auto dual = one;
    dual.form = one.form == Form::impedance ? Form::admittance : Form::impedance;
    const Matrix gain = test::drawn_gain(rng, n, 1e-2, 1e2);
    const Vector x = test::drawn_vector(rng, n, 3.0);
    one.add_impedance(gain, x);
    dual.add_admittance(gain, x);
    one.add_flow(x);
    dual.add_effort(x);
    EXPECT_EQ(one.matrix, dual.matrix) << families::of_seed(seed, "draw", i);
    EXPECT_EQ(one.offset, dual.offset) << families::of_seed(seed, "draw", i);
    PortState<any_size> state;
    PortState<any_size> mirrored;
    if (one.form == Form::impedance) {
      one.at_flow(x, state);
      dual.at_effort(x, mirrored);
    } else {
      one.at_effort(x, state);
      dual.at_flow(x, mirrored);
    }
    EXPECT_EQ(state.effort, mirrored.flow);
    EXPECT_EQ(state.flow, mirrored.effort);
  }
}

TEST(Equivalent, FormsSayTheSameAndLeadBack) {
  Rng rng(seed);
  for (int i = 0; i < draws; ++i) {
    SCOPED_TRACE(families::of_seed(seed, "draw", i));
    const int n = families::count_between(rng, 1, 16);
    const auto first = drawn(rng, n, Form::impedance, 0);
    auto other = first;
    ASSERT_TRUE(other.take_form(Form::admittance));
    EXPECT_EQ(other.form, Form::admittance);
    expect_symmetric_semidefinite(other.matrix);
    PortState<any_size> state;
    first.at_flow(test::drawn_vector(rng, n, 3.0), state);
    EXPECT_LE(off(other, state.effort, state.flow), 1e-9);
    ASSERT_TRUE(other.take_form(Form::impedance));
    EXPECT_LE((other.matrix - first.matrix).norm(), 1e-8 * first.matrix.norm());
  }
}

TEST(Equivalent, RefusesAFormThatARigidOrFreeDirectionHasNot) {
  Rng rng(seed);
  for (int i = 0; i < 2 * draws; ++i) {
    const int n = families::count_between(rng, 1, 7);
    // Singular exactly, or up to rounding.
    auto first = drawn(rng, n, i % 2 == 0 ? Form::impedance : Form::admittance,
                       families::count_between(rng, 1, n));
    if (i % 4 < 2) first.matrix = test::drawn_singular(rng, n);
    auto tried = first;
    const Form other = first.form == Form::impedance ? Form::admittance : Form::impedance;
    ASSERT_EQ(tried.take_form(other), false) << families::of_seed(seed, "draw", i) << ", " << n;
    EXPECT_EQ(tried.form, first.form);
    EXPECT_EQ(tried.matrix, first.matrix);
    EXPECT_EQ(tried.offset, first.offset);
    EXPECT_TRUE(tried.take_form(first.form));
  }
}

// Newtons and newton metres, metres and millimetres: invertibility must not depend on units.
TEST(Equivalent, UnitsMakeNoDifferenceToWhatIsRefused) {
  Rng rng(seed);
  for (int i = 0; i < draws; ++i) {
    const int n = families::count_between(rng, 2, 7);
    const bool singular = i % 2 == 0;
    Vector units(n);
    for (double& unit : units) unit = std::exp2(families::count_between(rng, -40, 40));
    Matrix gain = test::drawn_singular(rng, n);
    if (!singular) gain.diagonal().array() += 1.0;
    Equivalent<any_size> some;
    some.set_impedance(units.asDiagonal() * gain * units.asDiagonal(), Vector::Zero(n));
    ASSERT_EQ(some.take_form(Form::admittance), !singular) << families::of_seed(seed, "draw", i);
  }
}

TEST(Equivalent, DiagonalAdmittanceIsAddedAsAnyOther) {
  Rng rng(seed);
  for (const Form form : {Form::impedance, Form::admittance}) {
    const Equivalent<any_size> some = drawn(rng, 6, form, 0);
    const Vector g = test::drawn_vector(rng, 6, 1.0).cwiseAbs();
    const Vector w = test::drawn_vector(rng, 6, 1.0);
    Equivalent<any_size> whole = some, diagonal = some;
    whole.add_admittance(g.asDiagonal(), w);
    diagonal.add_diagonal_admittance(g, w);
    EXPECT_EQ(whole.matrix, diagonal.matrix);
    EXPECT_EQ(whole.offset, diagonal.offset);
    EXPECT_FALSE(some.is_source());
    whole.matrix.setZero();
    EXPECT_TRUE(whole.is_source());
  }
}

}  // namespace equivalent_test
}  // namespace repel::network
