// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The force law: force as a function of a signed distance and its rate. Change this file to change
/// how walls feel.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include <repel/base/setup_error.hpp>

namespace repel {

namespace detail {
/// `a` where `first` is true, else `b`: as for SIMD lanes.
template <class Number>
[[nodiscard]] Number either(bool first, const Number& a, const Number& b) noexcept {
  return first ? a : b;
}
}  // namespace detail

/// The force of a pair that is not passable, for any number type: double, an extended precision, or
/// SIMD lanes with one pair each. The only place of the formula; its letters are those of ForceLaw.
template <class Number>
struct LawFormula {
  Number range;          ///< r [m]
  Number surface_force;  ///< F [N]
  Number damping;        ///< c0 [N s/m]
  Number ceiling;        ///< [N]

  /// [m] A distance at which the damper is weakest for the slope of the spring.
  static constexpr double least_damped = 0.0;

  /// phi(d) [N] within the range, without the ceiling.
  [[nodiscard]] Number spring(const Number& distance) const noexcept {
    const Number share = distance / range;
    const Number inward = 1.0 - share;
    const Number bent = surface_force * inward * inward;
    const Number straight = surface_force * (1.0 - 2.0 * share);
    using detail::either;
    return either(distance > 0.0, bent, straight);
  }
  /// c(d) [N s/m].
  [[nodiscard]] Number damper(const Number& distance) const noexcept {
    const Number none = Number{};
    const Number all = none + 1.0;
    const Number share = 1.0 - distance / range;
    using detail::either;
    const Number positive = either(share > none, share, none);
    return damping * either(positive < all, positive, all);
  }
  /// f [N], 0 to the ceiling.
  [[nodiscard]] Number operator()(const Number& distance, const Number& rate) const noexcept {
    const Number none = Number{};
    const Number wanted = spring(distance) - damper(distance) * rate;
    using detail::either;
    const Number pushed = either(wanted > none, wanted, none);
    const Number size = either(pushed < ceiling, pushed, ceiling);
    return either(distance < range, size, none);
  }
};

/// Where the numbers of a law hold for a part of a link.
enum class GivenAt : std::uint8_t {
  part,  ///< at the point where the part is pushed
  tool,  ///< at the tool: at the part a cell scales them by the leverage of the tool over it
};

/// What keeps the shapes of a pair apart.
enum class HoldKind : std::uint8_t {
  soft,  ///< the force of the law: who pushes harder goes deeper
  hard,  ///< besides it, an arm that could soon not stop any more is slowed while it still can
         ///< (repel/loop/barrier/entry_barrier.hpp)
};

/// The nonlinear spring-damper of one pair (Anderson 1993, section 2: zero outside a threshold
/// region, a large force at the surface).
///
///     phi(d) = F (1 - d/r)^2    0 <= d < r       zero slope at the range r
///            = F (1 - 2 d/r)    d < 0            linear, with the slope at 0
///     c(d)   = c0 min(1, 1 - d/r)                zero at the range, c0 from distance 0 on
///     f      = min(max(0, phi(d) - c(d) d'), ceiling)
///
/// So the force is continuous, never pulls, and is smaller on retreat (d' > 0): leaving is never
/// resisted.
///
/// A passable body, membrane or tissue, may be entered and left on its far side. Its spring
/// saturates at the ceiling and falls to zero towards the depth D at which the extraction direction
/// reverses, with k the `stiffness`:
///
///     s(d) = min(phi(d), ceiling) min(1, (D + d) / L)    L = max((1 - plateau) D, ceiling / k)
///     f    = min(s max(0, 1 - (c0 / ceiling) d'), ceiling)
struct ForceLaw {
  static constexpr double usual_damping = 50.0;              ///< [N s/m]
  double range = 0.02;                                       ///< r [m] where the force begins
  double surface_force = 100.0;                              ///< F [N] at distance 0
  double damping = usual_damping;                            ///< c0 [N s/m]
  double ceiling = std::numeric_limits<double>::infinity();  ///< [N] greatest force of the pair
  bool passable = false;                                     ///< may be entered
  GivenAt given_at = GivenAt::part;                          ///< see repel/cell/leverage.hpp
  double depth = most;   ///< D [m] penetration depth at which a passable body releases;
                         ///< World::add_pair clamps it to the deepest that the two shapes can have
  double plateau = 0.5;  ///< share of D up to which the ceiling holds, 0 to 1
  /// e [rad], 0 to `most_tilt`: where features are parallel within e, the force acts on the contact
  /// patch, whose distance is the mean over tilts up to e (repel/contact/patch.hpp).
  /// World::add_pair lowers it so that the patch is at most `most_nearer` nearer than the nearest
  /// points, and to 0 for passable bodies. 0: the force acts at the nearest point, which jumps
  /// between the corners of parallel faces.
  double tilt = 0.005;
  /// A cell raises c0 to what keeps the wall stable at its rate; so it does with `usual_damping`,
  /// which nobody has chosen, unless `damping_is_meant`.
  bool damping_may_rise = false;
  bool damping_is_meant = false;   ///< c0 is a choice even where it is the usual one
  HoldKind hold = HoldKind::soft;  ///< whether a hand can get in, see docs/walls.md
  double watched = 0.0;  ///< [m] beyond the range, where the approach to a hard wall is watched; a
                         ///< cell raises it to what its arms need to stop

  static constexpr double most_tilt = 0.05;      ///< [rad]
  static constexpr double most_nearer = 0.5e-3;  ///< [m]
  static constexpr double most = 1e9;            ///< upper bound of every number but the ceiling

  /// c0 is no choice: a cell may raise it.
  [[nodiscard]] bool is_damping_open() const noexcept {
    return damping_may_rise || (damping == usual_damping && !damping_is_meant);
  }
  /// [m] The distance within which a pair with this law is evaluated.
  [[nodiscard]] double reach() const noexcept { return range + watched; }

  /// The law as a formula of doubles.
  [[nodiscard]] LawFormula<double> formula() const noexcept {
    return {range, surface_force, damping, ceiling};
  }

  /// phi(d) [N], never negative, without the ceiling.
  [[nodiscard]] double spring(double distance) const noexcept {
    return distance >= range ? 0.0 : formula().spring(distance);
  }

  /// The work [J] against the spring to bring a pair that is not passable from beyond its range to
  /// this distance: the potential whose slope is the spring, clamped to `ceiling`.
  [[nodiscard]] double potential(double distance) const noexcept {
    // `full`: distance at which the spring reaches the ceiling; below it the clamped spring is
    // constant.
    const double share = ceiling / surface_force;
    const double full = range * (share > 1.0 ? 0.5 - 0.5 * share : 1.0 - std::sqrt(share));
    const double held = std::max(0.0, full - distance) * ceiling;
    const double d = std::max(distance, full);
    if (d >= range) return 0.0;
    const double bent = std::max(0.0, d) / range;
    const double inward = 1.0 - bent;
    const double straight = std::max(0.0, -d);
    return surface_force *
               (range / 3.0 * inward * inward * inward + straight + straight * straight / range) +
           (held > 0.0 ? held : 0.0);
  }

  /// s(d) [N] of a passable body: 0 to `ceiling`, and nowhere steeper than `stiffness`.
  [[nodiscard]] double passing_spring(double distance) const noexcept {
    const double length = std::max((1.0 - plateau) * depth, ceiling / stiffness());
    const double share = std::clamp((depth + distance) / length, 0.0, 1.0);
    return std::min(spring(distance), ceiling) * share;
  }

  /// The force [N] of a passable body whose spring force is `spring` [N]: the damper takes a share
  /// of the spring, so that both vanish together. With `rate` [m/s] as below.
  [[nodiscard]] double damped(double spring, double rate) const noexcept {
    return std::min(spring * std::max(0.0, 1.0 - damping / ceiling * rate), ceiling);
  }

  /// Size of the force along the extraction direction [N], 0 to `ceiling`.
  /// @param distance [m] signed
  /// @param rate [m/s] its rate of change; positive on retreat
  [[nodiscard]] double operator()(double distance, double rate) const noexcept {
    if (!(distance < range)) return 0.0;
    return passable ? damped(passing_spring(distance), rate) : formula()(distance, rate);
  }

  /// [N s/m] The damping that keeps the steepest spring from oscillating at a tick rate: where it
  /// is weakest for the slope. A law whose damper fades with the depth has less than `damping`.
  [[nodiscard]] double steepest_damping() const noexcept {
    return passable ? damping : formula().damper(LawFormula<double>::least_damped);
  }

  /// Largest slope of the spring [N/m]: the wall stiffness to check against the clean-stiffness
  /// limit.
  [[nodiscard]] double stiffness() const noexcept { return 2.0 * surface_force / range; }
};

/// Returns `law`; throws SetupError naming the first number that is out of range.
inline const ForceLaw& checked(const ForceLaw& law) {
  constexpr double most = ForceLaw::most;
  checked("range", law.range, 1e-9, most, "m");
  checked("surface force", law.surface_force, 0.0, most, "N");
  checked("damping", law.damping, 0.0, most, "N s/m");
  checked("ceiling", law.ceiling, 0.0, std::numeric_limits<double>::infinity(), "N");
  checked("depth", law.depth, 0.0, most, "m");
  checked("plateau", law.plateau, 0.0, 1.0, "");
  checked("tilt", law.tilt, 0.0, ForceLaw::most_tilt, "rad");
  checked("watched", law.watched, 0.0, 10.0, "m");
  if (law.passable && law.hold == HoldKind::hard) {
    throw SetupError("hold is hard for a passable body; allowed: soft, since it may be entered");
  }
  if (law.passable) {
    // With at most half of the surface force, the ceiling is reached before the spring may begin to
    // fall.
    checked("ceiling of a passable body, with this surface force,", law.ceiling, 1e-9,
            0.5 * law.surface_force, "N");
  }
  return law;
}

}  // namespace repel
