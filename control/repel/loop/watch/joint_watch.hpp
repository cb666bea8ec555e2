// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Plausibility check of joint readings, and prediction of the motion while they fail it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <repel/base/status.hpp>
#include <repel/loop/arms/arm_inertia.hpp>
#include <repel/loop/arms/motion_account.hpp>
#include <repel/loop/arms/sent_torques.hpp>
#include <repel/loop/options.hpp>
#include <repel/loop/watch/drive_watch.hpp>
#include <repel/loop/watch/rate_check.hpp>
#include <repel/loop/watch/still_joint.hpp>
#include <repel/world/arm.hpp>

namespace repel {

/// Compares every reading with the last one, with the torques sent in between and with the inertia
/// of the arm, joint by joint:
///
/// - positions and rates are finite, rates below twice the speed limit;
/// - positions and rates tell of the same motion (RateCheck);
/// - a rate grows no faster than the full effort of the joint, and the coupling from other joints,
///   can accelerate it: M_ii |dv_i| <= T (|tau_i - g_i| + effort_i) + sum |M_ik dv_k|. Speed may be
///   lost at once, by an impact;
/// - a joint moving, or driven beyond its friction, does not report exactly the same position
///   repeatedly (StillJoint).
///
/// A reading that fails is not used; meanwhile the motion is predicted from the last believed one.
/// A joint is believed again if each reading followed from the one before, or at the place of its
/// loss after braking; else the program has to confirm its position (`confirm`). Losses in short
/// succession double the number of sound readings needed.
///
/// Allocates at construction only; a tick costs a few operations for each pair of joints.
class JointWatch {
 public:
  using Vector = ArmInertia::Vector;  ///< one entry for each joint

  /// @param period [s] from reading to reading @param drive_delay [ticks] of the torques
  /// @throws SetupError for an option out of range
  JointWatch(const ArmModel& model, double period, const JointWatchOptions& options = {},
             double drive_delay = 0.0);

  /// Checks a reading `q` [rad], `v` [rad/s]; `position` and `rate` then return it if believed,
  /// else the prediction. @param elapsed [s] since the last reading
  /// @return bits of status::blind; 0 for a believed reading
  [[nodiscard]] Status step(const std::vector<double>& q, const std::vector<double>& v,
                            double elapsed, const ArmInertia::Matrix& M) noexcept;

  /// The torques sent after the reading: `net` = tau - g [N m], its part `alone` effective even
  /// with the other joints held, `weight` g, and the `rate` predicted one period later [rad/s].
  /// `held`: brakes are on.
  void expect(const Vector& net, const Vector& alone, std::span<const double> weight,
              const Vector& rate, bool held) noexcept;

  /// Brakes are on, whoever engaged them: the joints need not move.
  void hold() noexcept { held_ = true; }

  /// Accepts the next reading without comparison: the arm moved on while the loop was suspended.
  void begin_anew() noexcept;
  /// The positions are confirmed by a reference independent of the encoders: the next readings are
  /// believed, in spite of earlier losses.
  void confirm() noexcept;

  /// Read or predicted [rad] or [m].
  [[nodiscard]] double position(std::size_t joint) const noexcept { return joints_[joint].q; }
  /// Read or predicted [rad/s] or [m/s].
  [[nodiscard]] double rate(std::size_t joint) const noexcept { return joints_[joint].v; }
  /// [rad/s] Rate of the positions less `rate`, signed; 0 while predicted, and within the noise.
  [[nodiscard]] double untold_rate(std::size_t joint) const noexcept;
  /// [N m] Net torque, signed, to tell a joint at rest from a frozen encoder; 0: there is no doubt.
  [[nodiscard]] double probe(std::size_t joint) const noexcept;
  /// The energy gained without torques.
  [[nodiscard]] const MotionAccount& account() const noexcept { return account_; }
  /// The response of the drive to its torques.
  [[nodiscard]] const DriveWatch& drive() const noexcept { return drive_; }
  /// No reading has been believed yet.
  [[nodiscard]] bool knows_nothing() const noexcept { return !has_believed_; }

 private:
  struct Joint {
    double q = 0.0, v = 0.0;            // believed or predicted
    double read_q = 0.0, read_v = 0.0;  // the last finite reading
    double expected_rate = 0.0;         // [rad/s]
    double lost_q = 0.0;                // [rad] where the readings failed
    double path = 0.0;                  // [rad] predicted since then
    bool is_continuous = true;          // since then, each reading follows from the one before
    bool is_stuck = false;
    JointLoad load;
    RateCheck rates;
    StillJoint still;

    void forget() noexcept;
  };

  static constexpr double braking = 0.04;    // [s] an arm moves on at its speed at the loss
  static constexpr double succession = 5.0;  // [s] between losses
  static constexpr int most_losses = 8;      // that count

  static bool is_number(double x) noexcept { return x - x == 0.0; }

  [[nodiscard]] Status compare(const std::vector<double>& q, const std::vector<double>& v,
                               double elapsed, const ArmInertia::Matrix& M) noexcept;

  // [kg m^2] or [kg] Of a joint while all others give way, by its row of the inverse of M: much
  // less than M says where axes are nearly in line. Cost: a factorization.
  [[nodiscard]] double free_inertia(std::size_t i, const ArmInertia::Matrix& M) noexcept;

  // By the speed limit and the largest possible acceleration.
  [[nodiscard]] bool can_be_true(std::size_t i, const std::vector<double>& v,
                                 const ArmInertia::Matrix& M) const noexcept;

  // Whether the readings continue the motion from the place of the loss.
  [[nodiscard]] bool agrees(const std::vector<double>& q) const noexcept;

  void keep(const std::vector<double>& q, const std::vector<double>& v) noexcept;

  [[nodiscard]] Status believe(Status found, double elapsed) noexcept;

  // Starts the prediction. The motion of a joint with frozen readings was lost some ticks ago.
  void lose(double elapsed) noexcept;

  static Eigen::Index index(std::size_t i) noexcept { return static_cast<Eigen::Index>(i); }

  const ArmModel& model_;
  JointWatchOptions options_;
  double period_;  // [s]
  SentTorques sent_, alone_;
  MotionAccount account_;
  DriveWatch drive_;
  std::vector<Joint> joints_;
  network::dense::Factored factored_;
  Vector response_;             // to a torque on one joint
  std::vector<double> change_;  // [rad/s] of the rates since the last reading
  std::vector<double> read_v_;  // [rad/s] the last finite reading
  Status blind_ = 0U;           // why the readings are not believed
  std::int64_t sound_ = 0;      // consecutive sound readings since
  double lost_speed_ = 0.0;     // [rad/s] greatest joint speed when the readings failed
  double believed_for_ = 0.0;   // [s]
  int losses_ = 0;              // in short succession
  bool has_reading_ = false, has_believed_ = false, has_been_lost_ = false, held_ = false;
};

}  // namespace repel
