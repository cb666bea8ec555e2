// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Ports: effort and flow, and the corresponding waves.
///
/// The modules of a network are one-ports and two-ports. A port carries an effort f (force, torque,
/// wrench) and a flow v (velocity, joint rate, twist), both counted into the element, so f.v is the
/// power into it. With a port resistance R, symmetric and positive definite,
///
///     a = f + R v   the incident wave       b = f - R v   the reflected wave
///     f.v = (a' R^-1 a - b' R^-1 b) / 4
///
/// (R. J. Anderson's SMART, expressed as wave digital filters, A. Fettweis 1986.)
#pragma once

#include <concepts>

#include <Eigen/Core>

#include <repel/base/spatial.hpp>
#include <repel/network/elements/dense.hpp>

namespace repel::network {

/// Size of a port that is known only at set-up: 1 for a lever, 6 for a tool, one for each joint.
inline constexpr int any_size = Eigen::Dynamic;
/// Maximum number of joints, and so the largest port. Storage has this capacity: nothing allocates.
inline constexpr int most_joints = 16;
/// Numbers that a vector of size N has room for.
template <int N>
inline constexpr int room_for = N == any_size ? most_joints : N;

/// Vector of one port; of size `any_size` in storage of fixed capacity.
template <int N>
using Vec = Eigen::Matrix<double, N, 1, Eigen::ColMajor, room_for<N>, 1>;
/// Matrix between flow and effort of one port.
template <int N>
using Mat = Eigen::Matrix<double, N, N, Eigen::ColMajor, room_for<N>, room_for<N>>;

// Operators that return values instead of Eigen expressions, as those of Vec3 in base/types.hpp.
using repel::operator+;
using repel::operator-;
using repel::operator*;
using repel::operator/;
/// The vectors that these operators take.
template <class V>
concept PortVector =
    std::same_as<V, Vec<any_size>> || std::same_as<V, Vec<1>> || std::same_as<V, Vec<6>>;

/// Sum, entry by entry.
template <PortVector V>
[[nodiscard]] V operator+(const V& a, const V& b) noexcept {
  V sum(a.size());
  for (Eigen::Index i = 0; i < a.size(); ++i) sum.coeffRef(i) = a.coeff(i) + b.coeff(i);
  return sum;
}
/// Difference, entry by entry.
template <PortVector V>
[[nodiscard]] V operator-(const V& a, const V& b) noexcept {
  V rest(a.size());
  for (Eigen::Index i = 0; i < a.size(); ++i) rest.coeffRef(i) = a.coeff(i) - b.coeff(i);
  return rest;
}
/// Negative, entry by entry.
template <PortVector V>
[[nodiscard]] V operator-(const V& a) noexcept {
  V turned(a.size());
  for (Eigen::Index i = 0; i < a.size(); ++i) turned.coeffRef(i) = -a.coeff(i);
  return turned;
}
/// Multiple, entry by entry.
template <std::same_as<double> S, PortVector V>
[[nodiscard]] V operator*(S s, const V& a) noexcept {
  V multiple(a.size());
  for (Eigen::Index i = 0; i < a.size(); ++i) multiple.coeffRef(i) = s * a.coeff(i);
  return multiple;
}
/// Multiple, entry by entry.
template <std::same_as<double> S, PortVector V>
[[nodiscard]] V operator*(const V& a, S s) noexcept {
  return s * a;
}
/// Quotient, entry by entry.
template <std::same_as<double> S, PortVector V>
[[nodiscard]] V operator/(const V& a, S s) noexcept {
  V part(a.size());
  for (Eigen::Index i = 0; i < a.size(); ++i) part.coeffRef(i) = a.coeff(i) / s;
  return part;
}
/// Entrywise product.
template <PortVector V>
[[nodiscard]] V product(const V& a, const V& b) noexcept {
  V both(a.size());
  for (Eigen::Index i = 0; i < a.size(); ++i) both.coeffRef(i) = a.coeff(i) * b.coeff(i);
  return both;
}

/// What effort and flow refer to. Ports of different spaces cannot be connected, whatever their
/// sizes.
enum class Space {
  any,     ///< takes that of its neighbour
  lever,   ///< torque and rate of a lever [N m, rad/s]
  tool,    ///< wrench and twist at the origin of the tool, linear first, world axes [N, N m; m/s]
  joints,  ///< torques and rates of the joints, base outward [N m, rad/s]
};

/// Name of a space, for error messages.
[[nodiscard]] constexpr const char* name_of(Space space) noexcept {
  switch (space) {
    case Space::lever:
      return "lever";
    case Space::tool:
      return "tool";
    case Space::joints:
      return "joints";
    default:
      return "any";
  }
}

/// The two ports of a two-port. Networks are written from left, the operator, to right, the robot.
enum class Side { left, right };

/// Which forces of the world model a module brings into the network.
enum class Walls {
  none,
  tool,   ///< those on the tool
  links,  ///< those on the links of the arm
};

/// Properties of a module in a network.
struct Traits {
  Space left = Space::any;     ///< of its left port
  Space right = Space::any;    ///< of its right port
  bool measures_flow = false;  ///< imposes its own flow: must be the root, and the only one
  bool needs_flow = false;     ///< nonlinear: needs a flow measured by the root
  bool keeps_flow = false;     ///< a flow measured on one side is known on the other
  Walls walls = Walls::none;   ///< the forces it takes from the world model
  bool at_robot = false;       ///< stands beside the module that measures its flow, on its left
  double lightens = 0.0;       ///< g: what is on its left moves 1 / (1 + g) of the inertia
  bool passive = true;         ///< returns no more energy than it absorbed and was supplied; the
                               ///< latter is by its own source, as `supplied` reports it
};

/// Effort and flow of one port in one tick, both into the element.
template <int N>
struct PortState {
  Vec<N> effort;  ///< [N], [N m]
  Vec<N> flow;    ///< [m/s], [rad/s]

  /// Power into the element [W].
  [[nodiscard]] double power() const noexcept {
    double sum = 0.0;
    for (Eigen::Index i = 0; i < flow.size(); ++i) sum += effort.coeff(i) * flow.coeff(i);
    return sum;
  }
  /// The wave a into the element, for the port resistance `R` [N s/m], [N m s/rad].
  [[nodiscard]] Vec<N> incident(const Mat<N>& R) const noexcept {
    return effort + dense::product<Vec<N>>(R, flow);
  }
  /// The wave b out of it.
  [[nodiscard]] Vec<N> reflected(const Mat<N>& R) const noexcept {
    return effort - dense::product<Vec<N>>(R, flow);
  }
};

/// The three entries of `first`, then those of `last`.
[[nodiscard]] Vec<any_size> to_vec(const Vec3& first, const Vec3& last) noexcept;
/// Three entries of a port vector, from the i-th on.
template <PortVector V>
[[nodiscard]] Vec3 three(const V& all, Eigen::Index i) noexcept {
  return {all.coeff(i), all.coeff(i + 1), all.coeff(i + 2)};
}
/// A twist or a wrench as the vector of a tool port.
[[nodiscard]] Vec<any_size> to_vec(const Twist& V) noexcept;
/// As six numbers: force [N], then torque [N m].
[[nodiscard]] Vec<any_size> to_vec(const Wrench& F) noexcept;
/// From six numbers: force [N], then torque [N m].
[[nodiscard]] Wrench to_wrench(const Vec<any_size>& six) noexcept;

namespace detail {
/// Returns `period` [s]; throws SetupError unless it is 1e-9 to 3600.
double checked_period(double period);
}  // namespace detail

}  // namespace repel::network
