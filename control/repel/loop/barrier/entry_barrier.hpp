// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Keeps an arm from entering hard walls, by the least change of torques.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <repel/base/status.hpp>
#include <repel/loop/arms/arm_inertia.hpp>
#include <repel/loop/barrier/barrier_rows.hpp>
#include <repel/loop/barrier/least_constraint.hpp>
#include <repel/loop/barrier/rate_forecast.hpp>
#include <repel/loop/options.hpp>
#include <repel/loop/record.hpp>
#include <repel/world/arm.hpp>

namespace repel {

/// What the barrier has done since set-up.
struct BarrierTotals {
  std::int64_t ticks = 0;   ///< in which it changed a torque
  std::int64_t lost = 0;    ///< in which some wall could not be held
  double peak_force = 0.0;  ///< [N] hardest push withstood by a wall
  double energy = 0.0;      ///< [J] taken from closing gaps, less the energy given to open them
};

/// A barrier on the approach to hard walls. A gap d (BarrierRows) may close no faster than
///
///     d = b t + b^2 / (2 a)        b(d) = sqrt(a^2 t^2 + 2 a d) - a t
///
/// with a the deceleration available from the efforts of the joints, by the inertia times
/// `mass_uncertainty` and less the bending of the gap, and t the time until a torque acts: drive
/// delay, slew time, and some ticks for an exponential approach at last. The speed of a gap is the
/// lower bound of a RateForecast.
///
/// The torques sent bring every gap to its speed within a step at the least change of acceleration
/// (LeastConstraint), like pushes of frictionless walls. So retreat and sliding are free. The
/// forces brake an approach or reduce torques asked for. They add energy only to flee from an
/// approaching wall, and to return to the margin as much as was taken before.
///
/// If no torque within the limits can stop the arm any more, `account` reports it while the gap is
/// still open. Allocates at construction only. Cost: a solution with the mass matrix for each gap,
/// and that of LeastConstraint.
class EntryBarrier {
 public:
  using Vector = ArmInertia::Vector;  ///< one entry for each joint

  /// @param period [s] @param drive_delay [ticks] of the arm @param slew_time [s] of its torques
  /// @param pairs of the world; 0: none is hard, and nothing is changed
  /// @throws SetupError for an option out of range
  EntryBarrier(const ArmModel& model, double period, double drive_delay, double slew_time,
               std::size_t pairs, const EntryBarrierOptions& options = {});

  /// Some wall is hard.
  [[nodiscard]] bool is_on() const noexcept { return !withstood_.empty(); }
  /// t [s]. Gaps that stay open for several of these may be unknown.
  [[nodiscard]] double reaction() const noexcept { return reaction_; }

  /// Takes the contacts of this arm, in its present pose. @param q [rad] or [m]
  /// @param v [rad/s] or [m/s] of the joints, and their untold rates (JointWatch::untold_rate)
  /// @param jacobian of the tool
  void watch(const Contacts& contacts, BodyId tool, const Jacobian& jacobian,
             const ArmBodies& links, std::span<const double> q, std::span<const double> v,
             std::span<const double> untold) noexcept;
  /// Without contacts, until the next `watch`: something else holds the arm.
  /// @return `hold_lost` if a moving wall will reach the arm soon, or 0
  [[nodiscard]] Status forget() noexcept;

  /// To be called in every tick, before the others. @param v [rad/s]
  /// @return true where a hard wall is near
  [[nodiscard]] bool observe(std::span<const double> v, const ArmInertia& inertia) noexcept;
  /// Adds the bounds of the gaps to a problem, as its first rows: torques within them enter no hard
  /// wall. @param weight [N m] the torques carrying the weight
  void bound(LeastConstraint& problem, std::span<const double> weight, std::span<const double> v,
             const ArmInertia& inertia) noexcept;
  /// Accounts for the solution, and solves again if no torques keep all gaps.
  /// @param efforts [N m] limits for the withstood push: slew rates do not count in it
  /// @return `hold_lost`, or 0
  [[nodiscard]] Status account(LeastConstraint& problem, std::span<const double> lower,
                               std::span<const double> upper,
                               std::span<const double> efforts) noexcept;

  /// To be called in every tick, with the torques sent less those of the weight [N m].
  void note_sent(const Vector& net) noexcept { forecast_.note_sent(net); }

  /// [N] Largest constraint force of the last tick.
  [[nodiscard]] double force() const noexcept { return force_; }
  /// The pair of the hardest contact; invalid where none held.
  [[nodiscard]] PairId pushed() const noexcept { return pushed_; }
  /// The proof left by the last tick and its torques.
  [[nodiscard]] const HoldProof& proof() const noexcept { return proof_; }
  /// [N] Hardest push withstood by the wall of this pair since set-up.
  [[nodiscard]] double withstood(PairId pair) const noexcept;
  [[nodiscard]] const BarrierTotals& totals() const noexcept { return totals_; }  ///< since set-up

 private:
  static constexpr double least_speed = 1e-6;  // [m/s]

  /// How a gap can be braked [m/s^2].
  struct Stopping {
    double surely = 0.0;   ///< a: by a push along the gap, at the uncertain inertia
    double at_most = 0.0;  ///< if all joints did their utmost for this gap alone
  };

  static Eigen::Index index(std::size_t i) noexcept { return static_cast<Eigen::Index>(i); }
  // [m] Turning and bending within a tick grow with it.
  [[nodiscard]] double margin() const noexcept;

  void add(LeastConstraint& problem, const BarrierRow& row, Stopping& stop,
           std::span<const double> weight) noexcept;

  [[nodiscard]] Stopping stopping(const LeastConstraint::Row& row,
                                  std::span<const double> weight) const noexcept;

  // b [m/s] at a gap of d [m]; below zero to open it. @param a [m/s^2]
  [[nodiscard]] double allowed(double d, double a) const noexcept;

  void count(const LeastConstraint& problem, std::span<const double> efforts) noexcept;

  // [m] Remaining gap of a row after the torques of this tick.
  // @param freely [m/s] its rate then without them @param after with them
  [[nodiscard]] double soon(const BarrierRow& row, double freely, double after) const noexcept;
  // [m] Braking distance from `after` [m/s] at `a` [m/s^2].
  [[nodiscard]] double stopping_distance(double after, double a) const noexcept;

  // Finds the proof. A wall is lost if the arm passes the margin and full braking is not proven to
  // stop it before the wall.
  [[nodiscard]] Status judge(const LeastConstraint& problem) noexcept;

  // The first of the rows of a problem are those of the gaps.
  [[nodiscard]] std::size_t held(const LeastConstraint& problem) const noexcept {
    return std::min(rows_.all().size(), problem.rows().size());
  }

  EntryBarrierOptions options_;
  double period_;     // [s]
  double delay_;      // [ticks]
  double slew_time_;  // [s]
  double step_;       // [s] to bring a gap to its speed
  double reaction_;   // t [s]
  BarrierRows rows_;
  RateForecast forecast_;
  std::vector<Stopping> stops_;    // of each row
  std::vector<double> withstood_;  // [N] by PairId; empty: it is off
  std::vector<double> effort_;     // [N m] limits
  double force_ = 0.0;
  PairId pushed_;
  HoldProof proof_;
  std::int32_t left_out_ = 0;
  BarrierTotals totals_;
};

}  // namespace repel
