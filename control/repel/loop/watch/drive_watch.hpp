// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Finds a dead drive, a reversed one, or one later than told.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <repel/loop/arms/arm_inertia.hpp>
#include <repel/loop/options.hpp>
#include <repel/world/arm.hpp>

namespace repel {

/// Asks of each joint by which torques its motion is explained best. Its momentum without the
/// drive,
///
///     p' = M dv/dt + B v + F sgn(v) + g - e
///
/// is the integral of the torques, w' = tau, at their delay and with a gain within the uncertainty
/// of masses. e is the steady disturbance of a moving joint. The residual may be beyond the noise,
/// and one of these may have a residual several times smaller. Then the drive does not follow its
/// command, or readings are late:
///
/// - torques later by two ticks or more, over 20 ms;
/// - no torque, or the opposite one, from the onset of the difference.
///
/// An external force, as of a person pushing, fits none of them. After the momentum observer of De
/// Luca and Mattone (2003). Allocates at construction only. Cost: a few operations for each delay
/// and joint.
class DriveWatch {
 public:
  using Vector = ArmInertia::Vector;  ///< one entry for each joint

  /// @param delay [ticks] of the drive
  DriveWatch(const ArmModel& model, double delay);

  /// The torque sent after the last reading: the sum of `net` and `weight` [N m].
  void note_sent(const Vector& net, std::span<const double> weight) noexcept;

  /// Brakes are on: no torque acts.
  void note_held() noexcept { sent_.setZero(index(joints_.size())); }

  /// Advances by a reading. @param last, v [rad/s] rates of the last reading and of this one
  /// @param M the inertia between both @param elapsed [s]
  void step(const std::vector<double>& last, const std::vector<double>& v,
            const ArmInertia::Matrix& M, double elapsed, const JointWatchOptions& options) noexcept;
  /// The next reading does not follow from the last one, or a brake held the arm.
  void begin_anew(double elapsed) noexcept;

  /// The drive of some joint does not follow its command.
  [[nodiscard]] bool strays() const noexcept { return strays_; }

 private:
  static constexpr double memory = 0.02;                    // [s] of momenta
  static constexpr double window = 0.008;                   // [s] of their comparison
  static constexpr double steadily = 1.0;                   // [s]
  static constexpr double at_first = 0.06;                  // [s] in which a dead drive shows
  static constexpr double clearly = 1.0 / 12.0;             // of the energy that is left
  static constexpr double beside = 0.15;                    // of the momentum that is left
  static constexpr double friction_error = 1.25;            // of the gain
  static constexpr double opposites[3] = {0.65, 1.0, 1.5};  // gains
  static constexpr double evident = 3.0;                    // times the noise
  static constexpr std::size_t lead = 4;                    // ticks until a difference shows
  static constexpr int enough = 2;                          // ticks
  static constexpr std::size_t lates = 7;
  static constexpr std::size_t late[lates] = {2, 3, 4, 5, 6, 8, 12};  // [ticks]

  // [N m s] Residual of p at any gain.
  static double left_of(double p, double w, double u) noexcept;

  /// Sums for the gain of torques.
  struct Fit {
    double pw = 0.0, ww = 0.0;
  };
  /// Momentum since a difference began [N m s], and the greatest error of each hypothesis.
  struct Since {
    double time = 0.0;  // [s] 0: there is no difference
    double p = 0.0, w = 0.0;
    double told = 0.0, none = 0.0;
    double opposite[3] = {};

    void add(double added, double sent, double u) noexcept;
  };
  struct Joint {
    double p = 0.0;       // [N m s]
    double steady = 0.0;  // e [N m]
    double noise = 0.0;   // [N m s]
    double pp = 0.0;
    Fit told;
    Fit later[lates];
    Since since;
    double added[lead] = {}, sent[lead] = {};  // [N m s] of the last ticks
    std::size_t oldest = 0;
    int ticks = 0;
  };

  static Eigen::Index index(std::size_t i) noexcept { return static_cast<Eigen::Index>(i); }

  void advance(double kept, double elapsed) noexcept;
  [[nodiscard]] double at(std::size_t ticks, std::size_t joint) const noexcept;
  // [N m s] of torques later than told.
  [[nodiscard]] double w(double later, std::size_t joint) const noexcept;
  void rest(std::size_t i) noexcept;

  static double unexplained(double pp, const Fit& fit, double u) noexcept;
  // By late torques.
  void compare(std::size_t i, double share, const JointWatchOptions& options) noexcept;

  // By no torque, or the opposite one. @param added, sent [N m s] in this tick @param w of the
  // torques as told
  static void follow(Joint& joint, double added, double sent, double w, double elapsed,
                     const JointWatchOptions& options) noexcept;

  const ArmModel& model_;
  double delay_;              // [ticks]
  std::vector<Vector> ring_;  // w [N m s]
  std::size_t newest_ = 0;
  Vector sent_, weight_;
  std::vector<Joint> joints_;
  bool strays_ = false;
};

}  // namespace repel
