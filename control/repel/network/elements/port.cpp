// SPDX-License-Identifier: BSD-3-Clause
#include <repel/network/elements/port.hpp>

#include <Eigen/Core>

#include <repel/base/setup_error.hpp>

namespace repel::network {

Vec<any_size> to_vec(const Vec3& first, const Vec3& last) noexcept {
  Vec<any_size> six(6);
  for (Eigen::Index i = 0; i < 3; ++i) {
    six.coeffRef(i) = first.coeff(i);
    six.coeffRef(i + 3) = last.coeff(i);
  }
  return six;
}

Vec<any_size> to_vec(const Twist& V) noexcept {
  return to_vec(V.linear, V.angular);
}

Vec<any_size> to_vec(const Wrench& F) noexcept {
  return to_vec(F.force, F.torque);
}

Wrench to_wrench(const Vec<any_size>& six) noexcept {
  return {three(six, 0), three(six, 3)};
}

}  // namespace repel::network

namespace repel::network::detail {

double checked_period(double period) {
  return checked("period", period, 1e-9, 3600.0, "s");
}

}  // namespace repel::network::detail
