/// @file
/// Ports: effort and flow, and the waves they make.
///
/// The modules of a network are one-ports and two-ports. A port carries an effort f (force, torque,
/// wrench) and a flow v (velocity, joint rate, twist), both counted into the element, so that f.v
/// is the power that enters it. With a port resistance R, symmetric and positive definite,
///
///     a = f + R v   the incident wave       b = f - R v   the reflected wave
///     f.v = (a' R^-1 a - b' R^-1 b) / 4
///
/// (R. J. Anderson's SMART in terms of wave digital filters, A. Fettweis 1986.)
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include <repel/base/setup_error.hpp>
#include <repel/base/spatial.hpp>

namespace repel::network {

/// The size of a port that is known at set-up only: 1 for a lever, 6 for a tool, one for each
/// joint.
inline constexpr int any_size = Eigen::Dynamic;
/// The most joints, and so the largest port. Storage is of this size: nothing allocates.
inline constexpr int most_joints = 16;
template <int N>
inline constexpr int room_for = N == any_size ? most_joints : N;

/// N numbers of one port; of size `any_size` in storage of fixed size.
template <int N>
using Vec = Eigen::Matrix<double, N, 1, Eigen::ColMajor, room_for<N>, 1>;
/// N x N numbers between flow and effort of one port.
template <int N>
using Mat = Eigen::Matrix<double, N, N, Eigen::ColMajor, room_for<N>, room_for<N>>;

/// What a port belongs to. Ports of different spaces do not fit together, whatever their sizes.
enum class Space {
  any,     ///< takes that of its neighbour
  lever,   ///< torque and rate of a lever [N m, rad/s]
  tool,    ///< wrench and twist at the origin of the tool, linear first, world axes [N, N m; m/s]
  joints,  ///< torques and rates of the joints, base outward [N m, rad/s]
};

/// Name of a space, as errors give it.
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

/// What a module is to the network that it stands in.
struct Traits {
  Space left = Space::any;     ///< of its left port
  Space right = Space::any;    ///< of its right port
  bool measures_flow = false;  ///< decides its own flow: it must be the root, and the only one
  bool needs_flow = false;     ///< nonlinear: needs a flow that the root has measured
  bool keeps_flow = false;     ///< what is measured on one side is known on the other
  Walls walls = Walls::none;   ///< what it takes from the world model
  bool passive = true;         ///< gives no more energy than it took and was supplied with
};

/// Effort and flow of one port in one tick, both into the element.
template <int N>
struct PortState {
  Vec<N> effort;  ///< [N], [N m]
  Vec<N> flow;    ///< [m/s], [rad/s]

  /// Power into the element [W].
  [[nodiscard]] double power() const noexcept { return effort.dot(flow); }
  /// The wave a into the element, for the port resistance `R` [N s/m], [N m s/rad].
  [[nodiscard]] Vec<N> incident(const Mat<N>& R) const noexcept {
    return effort + R.lazyProduct(flow);
  }
  /// The wave b out of it.
  [[nodiscard]] Vec<N> reflected(const Mat<N>& R) const noexcept {
    return effort - R.lazyProduct(flow);
  }
};

/// Effort and flow of the port with waves `a` and `b` and resistance `R`. Cost: a Cholesky
/// factorization of R.
template <int N>
[[nodiscard]] PortState<N> state_of(const Vec<N>& a, const Vec<N>& b, const Mat<N>& R) noexcept {
  const Eigen::LLT<Mat<N>> factor(R);
  const Vec<N> half = 0.5 * (a - b);
  return {0.5 * (a + b), factor.solve(half)};
}

/// The six numbers of a twist and of a wrench, as a tool port has them.
[[nodiscard]] inline Vec<any_size> to_vec(const Twist& V) noexcept {
  Vec<any_size> six(6);
  six << V.linear, V.angular;
  return six;
}
[[nodiscard]] inline Vec<any_size> to_vec(const Wrench& F) noexcept {
  Vec<any_size> six(6);
  six << F.force, F.torque;
  return six;
}
[[nodiscard]] inline Wrench to_wrench(const Vec<any_size>& six) noexcept {
  return {six.head<3>(), six.segment<3>(3)};
}

namespace detail {
/// [s] up to an hour
inline double checked_period(double period) {
  return checked("period", period, 1e-9, 3600.0, "s");
}
}  // namespace detail

}  // namespace repel::network
