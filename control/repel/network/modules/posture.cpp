// SPDX-License-Identifier: BSD-3-Clause
#include <repel/network/modules/posture.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

#include <repel/base/setup_error.hpp>

namespace repel::network {
namespace {

constexpr double tool_lever = 0.3;  // [m] at which a rotation of the tool counts as its motion

PassivityController<any_size> controller_of(const PostureOptions& options, int size) {
  return PassivityController<any_size>(
      {.most_energy = options.most_energy, .most_damping = options.most_damping, .lever = 1.0},
      Vec<any_size>::Ones(size));
}

}  // namespace

Posture::Posture(PostureOptions options)
    : options_(std::move(options)), controller_(controller_of(options_, 1)) {
  checked_fields(options_);
  for (const double q : options_.joints) checked("joint", q, -1e3, 1e3, "rad or m");
}

void Posture::fit(Space /*space*/, int size) {
  if (const std::size_t given = options_.joints.size(); given != 0) {
    checked("number of joints with a position", static_cast<double>(given), size, size, "");
  }
  controller_ = controller_of(options_, size);
  slack_.setZero(size);
  projector_.setZero(size, size);
  effort_.setZero(size);
}

void Posture::prepare(double period) {
  const double least = wall_ticks_ * detail::checked_period(period) * options_.stiffness;
  options_.damping = std::max(options_.damping, least);
}

void Posture::read(const Signals& signals) noexcept {
  if (signals.released) return release();
  supplied_ = 0.0;
  if (!has_begun_) begin(signals);
  // The torque of the last tick was held, so what it took in the period is by the P of that tick.
  const auto mean_rates = dense::product<Vec<any_size>>(projector_, signals.mean_rates);
  project(signals.jacobian);
  const auto rates = dense::product<Vec<any_size>>(projector_, signals.rates);
  const Vec<any_size> law =
      options_.stiffness * (signals.joints - slack_) + options_.damping * rates;
  effort_ = dense::product<Vec<any_size>>(projector_, law);
  double most = 0.0;
  for (Eigen::Index i = 0; i < effort_.size(); ++i) most = std::max(most, std::abs(effort_(i)));
  // One share for all joints keeps the torque in the null space.
  const double share = most > options_.torque_limit ? options_.torque_limit / most : 1.0;
  const Vec<any_size> effort = share * law;
  const double damping =
      controller_.step(effort, rates, mean_rates, signals.period, supplied_, signals.since_last());
  const Vec<any_size> corrected = effort + damping * rates;
  effort_ = dense::product<Vec<any_size>>(projector_, corrected);
  damping_ = share * options_.damping + damping;
}

void Posture::add_wall_damping(const Jacobian& /*of_tool*/, Mat<any_size>& damping) const noexcept {
  for (Eigen::Index k = 0; k < damping.cols(); ++k) {
    for (Eigen::Index j = 0; j < damping.cols(); ++j) {
      const double share = damping_ * projector_.coeff(j, k);
      for (Eigen::Index i = 0; i < damping.rows(); ++i) {
        damping.coeffRef(i, k) += share * projector_.coeff(i, j);
      }
    }
  }
}

void Posture::release() noexcept {
  controller_.reset();
  has_begun_ = false;
  projector_.setZero();
  effort_.setZero();
  damping_ = supplied_ = 0.0;
}

void Posture::begin(const Signals& signals) noexcept {
  has_begun_ = true;
  slack_ = signals.joints;
  if (options_.joints.empty()) return;
  double square = 0.0;
  for (Eigen::Index i = 0; i < slack_.size(); ++i) {
    slack_(i) = options_.joints[static_cast<std::size_t>(i)];
    square += (signals.joints(i) - slack_(i)) * (signals.joints(i) - slack_(i));
  }
  const double charge = std::min(0.5 * options_.stiffness * square, options_.most_energy);
  supplied_ = charge / signals.period;
}

void Posture::project(const Jacobian& jacobian) noexcept {
  const auto n = static_cast<int>(jacobian.cols());
  Mat<any_size> squares(n, n), directions(n, n);
  double greatest = 0.0;
  for (Eigen::Index k = 0; k < n; ++k) {
    for (Eigen::Index i = 0; i < n; ++i) {
      double linear = 0.0, angular = 0.0;
      for (Eigen::Index row = 0; row < 3; ++row) {
        linear += jacobian.coeff(row, i) * jacobian.coeff(row, k);
        angular += jacobian.coeff(row + 3, i) * jacobian.coeff(row + 3, k);
      }
      squares.coeffRef(i, k) = linear + tool_lever * tool_lever * angular;
    }
  }
  dense::diagonalize(squares.data(), directions.data(), n);
  for (Eigen::Index k = 0; k < n; ++k) greatest = std::max(greatest, squares.coeff(k, k));
  const double border = singular * singular * greatest;
  projector_.setZero();
  for (Eigen::Index k = 0; k < n; ++k) {
    const double square = std::max(0.0, squares.coeff(k, k));
    if (!(square < border)) continue;
    const double share = (1.0 - square / border) * (1.0 - square / border);
    for (Eigen::Index j = 0; j < n; ++j) {
      for (Eigen::Index i = 0; i < n; ++i) {
        projector_.coeffRef(i, j) += share * directions.coeff(i, k) * directions.coeff(j, k);
      }
    }
  }
}

}  // namespace repel::network
