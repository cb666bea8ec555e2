// SPDX-License-Identifier: BSD-3-Clause
// The elbow of an arm with a joint to spare comes back and rests, and gains no energy.
#include <repel/network/modules/posture.hpp>

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <deque>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <repel/base/setup_error.hpp>
#include <repel/network/modules.hpp>
#include <repel/network/plan.hpp>
#include <repel/world/kinematics.hpp>

#include "network/drawn.hpp"
#include "world/arms.hpp"

namespace repel::network {
namespace posture_test {

constexpr unsigned seed = 53;

/// Seven joints about alternating axes, as those of most redundant arms, with a light wrist.
ArmModel seven_joint_arm() {
  constexpr double along[] = {0.36, 0.0, 0.42, 0.0, 0.4, 0.0, 0.126};  // [m]
  ArmModel arm;
  arm.name = "seven joints";
  arm.X_LT = Pose(Eigen::Translation3d(0.0, 0.0, 0.06));
  for (int i = 0; i < 7; ++i) {
    ArmLink link;
    link.name = "link_" + std::to_string(i);
    link.joint_name = "joint_" + std::to_string(i);
    link.X_PJ = Pose(Eigen::Translation3d(0.0, 0.0, along[i]));
    link.axis_J = i % 2 == 0 ? Vec3::UnitZ() : Vec3::UnitY();
    link.mass = 4.0 / (1.0 + i);
    link.p_LC = Vec3(0.01, 0.02, 0.1 - 0.01 * i);
    link.I_C_L = (Vec3(0.03, 0.03, 0.02) / (1.0 + i * i)).asDiagonal();
    link.lower = -3.0;
    link.upper = 3.0;
    arm.links.push_back(link);
  }
  return arm;
}

Vector elbow_out() {
  Vector q(7);
  q << 0.3, 0.7, -0.4, -1.4, 0.5, 0.9, 0.2;
  return q;
}

Jacobian jacobian_at(Kinematics& kinematics, const Vector& q) {
  kinematics.update({q.data(), static_cast<std::size_t>(q.size())});
  Eigen::MatrixXd J(6, q.size());
  kinematics.tool_jacobian(J);
  return J;
}

/// The motion of the joints that the tool does not feel, in the sense of `like`.
Vector null_direction(const Jacobian& J, const Vector& like) {
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(Eigen::MatrixXd(J), Eigen::ComputeFullV);
  const Vector n = svd.matrixV().col(J.cols() - 1);
  return n.dot(like) < 0.0 ? -n : n;
}

/// An arm without friction whose tool is held by a coupling, with its true mass and Coriolis
/// forces.
class Rig {
 public:
  struct Options {
    std::optional<PostureOptions> posture = PostureOptions{};
    double rate = 1000.0;  // [Hz]
    int delay = 0;         // [ticks] of the drive
  };

  explicit Rig(const Options& options)
      : period_(1.0 / options.rate),
        kinematics_(seven_joint_arm()),
        q_(elbow_out()),
        momentum_(Vector::Zero(7)),
        v_(momentum_),
        flow_(7),
        network_(network_of(options)),
        signals_(detail::neutral_signals(7, period_)),
        under_way_(static_cast<std::size_t>(options.delay), Vector::Zero(7)) {
    flow_.reset(q_);
    (void)jacobian_at(kinematics_, q_);
    p0_ = origin(kinematics_.X_WT());
  }

  /// Runs for so many seconds while `push` [N m] turns the elbow.
  void run(double seconds, double push = 0.0) {
    const int ticks = static_cast<int>(std::lround(seconds / period_));
    for (int i = 0; i < ticks; ++i) tick(push);
  }

  [[nodiscard]] const Vector& q() const { return q_; }
  [[nodiscard]] double speed() const { return v_.norm(); }
  [[nodiscard]] double away() const { return (q_ - elbow_out()).norm(); }
  [[nodiscard]] double most_away() const { return most_away_; }
  [[nodiscard]] double tool_moved() const { return tool_moved_; }
  [[nodiscard]] const Network& network() const { return network_; }
  /// From now on the greatest displacements count.
  void forget() { most_away_ = tool_moved_ = 0.0; }

 private:
  [[nodiscard]] Network network_of(const Options& options) const {
    Plan plan;
    plan.add("hand", FlowSource<any_size>(Vec<any_size>::Zero(6)))
        .add("kbb2", Kbb2({.stiffness = 5000.0,
                           .damping = 300.0,
                           .force_limit = 600.0,
                           .angular_stiffness = 200.0,
                           .angular_damping = 10.0,
                           .torque_limit = 60.0}))
        .add("puma_kin", PumaKin());
    if (options.posture) plan.add("posture", Posture(*options.posture));
    plan.add("puma_joints", PumaJoints(7));
    const double delay = options.delay;
    return plan.build(period_, PredictionOptions{.drive_delay = delay},
                      RobotEnd{.wall_ticks = 0.5 + 2.0 * delay});
  }

  void tick(double push) {
    flow_.step(q_, v_, period_);
    signals_.joints = q_;
    signals_.rates = flow_.flow();
    signals_.mean_rates = flow_.mean();
    signals_.jacobian = jacobian_at(kinematics_, q_);
    signals_.inertia = mass_at(q_);
    direction_ = null_direction(signals_.jacobian, direction_);
    ASSERT_TRUE(network_.run(signals_));
    const Vec<any_size> torque = network_.find<PumaJoints>()->torques();
    under_way_.push_back(torque - network_.given_up(network_.foreseen(torque)));
    const Vector drive = under_way_.front() + push * direction_;
    under_way_.pop_front();
    const int steps = std::max(1, static_cast<int>(std::lround(period_ / 0.001)));
    for (int i = 0; i < steps; ++i) move(drive, period_ / steps);
    most_away_ = std::max(most_away_, away());
    (void)jacobian_at(kinematics_, q_);
    tool_moved_ = std::max(tool_moved_, norm(Vec3(origin(kinematics_.X_WT()) - p0_)));
  }

  Eigen::MatrixXd mass_at(const Vector& q) {
    kinematics_.update({q.data(), static_cast<std::size_t>(q.size())});
    Eigen::MatrixXd M(7, 7);
    (void)kinematics_.mass_matrix(M);
    return M;
  }

  // p' = tau + the gradient of v' M v / 2, and v = M^-1 p.
  void move(const Vector& torque, double h) {
    constexpr double step = 1e-5;
    Vector gradient(7);
    for (int i = 0; i < 7; ++i) {
      const Vector offset = step * Vector::Unit(7, i);
      const Eigen::MatrixXd slope = mass_at(q_ + offset) - mass_at(q_ - offset);
      gradient(i) = 0.25 / step * v_.dot(slope * v_);
    }
    momentum_ += h * (torque + gradient);
    q_ += h * Vector(mass_at(q_).llt().solve(Eigen::VectorXd(momentum_)));
    v_ = mass_at(q_).llt().solve(Eigen::VectorXd(momentum_));
  }

  double period_;
  Kinematics kinematics_;
  Vector q_, momentum_, v_;
  MeasuredFlow flow_;
  Network network_;
  Signals signals_;
  std::deque<Vector> under_way_;
  Vector direction_ = Vector::Unit(7, 0);
  Vec3 p0_{0.0, 0.0, 0.0};
  double most_away_ = 0.0, tool_moved_ = 0.0;
};

TEST(Posture, AnElbowThatWasPushedComesBackAndRestsWhileTheToolStays) {
  Rig rig({});
  rig.run(0.5, 4.0);
  EXPECT_GT(rig.most_away(), 0.2) << "the elbow must have moved";
  rig.run(8.0);
  EXPECT_LT(rig.speed(), 1e-3);
  EXPECT_LT(rig.away(), 0.01);
  EXPECT_LT(rig.tool_moved(), 0.003);
  EXPECT_LE(rig.network().find("posture")->ledger.deficit(), 1e-9);

  Rig without({.posture = std::nullopt});
  without.run(0.5, 4.0);
  without.run(8.0);
  EXPECT_GT(without.speed(), 0.1) << "without it the elbow turns on";
}

TEST(Posture, GoesToThePositionsThatAreGiven) {
  PostureOptions options;
  Kinematics kinematics(seven_joint_arm());
  const Jacobian J = jacobian_at(kinematics, elbow_out());
  const Vector there = elbow_out() + 0.5 * null_direction(J, Vector::Unit(7, 0));
  options.joints.assign(there.begin(), there.end());
  Rig rig({.posture = options});
  rig.run(8.0);
  EXPECT_GT(rig.away(), 0.4) << "it must have gone";
  EXPECT_LT((rig.q() - there).norm(), 0.2) << "where the tool allows it";
  EXPECT_LT(rig.speed(), 1e-3);
  EXPECT_LT(rig.tool_moved(), 0.003);
  const Ledger& ledger = rig.network().find("posture")->ledger;
  EXPECT_NEAR(ledger.supplied, 0.5 * options.stiffness * 0.25, 1e-9);
  EXPECT_LE(ledger.deficit(), 1e-9);
}

TEST(Posture, NothingGrowsAtAnyRateAndDelayOfTheDrive) {
  for (const double rate : {200.0, 400.0, 1000.0, 4000.0}) {
    for (const int delay : {0, 1, 2, 3}) {
      for (const auto& [stiffness, damping] : {std::pair(10.0, 2.0), std::pair(300.0, 0.0)}) {
        SCOPED_TRACE(repel::to_text(rate) + " Hz, delay " + std::to_string(delay) + ", stiffness " +
                     repel::to_text(stiffness));
        PostureOptions options;
        options.stiffness = stiffness;
        options.damping = damping;
        Rig rig({.posture = options, .rate = rate, .delay = delay});
        rig.run(0.2, 4.0);
        rig.forget();
        rig.run(0.5);
        const double first = rig.most_away();
        rig.forget();
        rig.run(0.5);
        EXPECT_LT(rig.most_away(), first);
        EXPECT_LE(rig.network().find("posture")->ledger.deficit(), 1e-9);
      }
    }
  }
}

/// A module for the arm of these signals.
Posture fitted(const PostureOptions& options, const Signals& signals) {
  Posture module(options);
  module.fit(Space::joints, static_cast<int>(signals.joints.size()));
  module.prepare(test::period);
  return module;
}

/// Signals of an arm that moves at random, with inaccurate rates; now and then its Jacobian jumps
/// or loses a direction.
class Swinging {
 public:
  Swinging(Rng& rng, int joints)
      : signals(detail::neutral_signals(joints, test::period)), rng_(rng) {}
  const Signals& next() {
    const auto n = static_cast<int>(signals.joints.size());
    signals.mean_rates = signals.rates + test::drawn_vector(rng_, n, 0.5);
    signals.joints += test::period * signals.mean_rates;
    signals.rates += test::drawn_vector(rng_, n, 0.3) - 0.05 * signals.joints;
    signals.rates *= 0.999;
    signals.jacobian += 0.01 * Jacobian(Jacobian::Random(6, n));
    if (++tick_ % 50 == 0) {
      for (double& x : signals.jacobian.reshaped()) x = families::uniform(rng_, -1.0, 1.0);
      if (tick_ % 100 == 0) signals.jacobian.col(1) = signals.jacobian.col(0);
    }
    signals.released = tick_ % 1000 == 999;
    return signals;
  }
  Signals signals;

 private:
  Rng& rng_;
  int tick_ = 0;
};

TEST(Posture, NeverGivesMoreThanItTookOnArmsThatMoveAtRandom) {
  for (const int joints : {3, 6, 7, 8, 16}) {
    for (const bool is_given : {false, true}) {
      SCOPED_TRACE(families::of_seed(seed, "joints", joints));
      Rng rng(seed);
      Swinging arm(rng, joints);
      PostureOptions options{.stiffness = 100.0};
      if (is_given) options.joints.assign(static_cast<std::size_t>(joints), 0.3);
      Cell cell(fitted(options, arm.signals), Side::right);
      int gave = 0;
      const int ticks = families::draws(1000000) / 50;
      for (int tick = 0; tick < ticks; ++tick) {
        const Signals& signals = arm.next();
        Equivalent<any_size> measured, none;
        measured.set_admittance(Matrix::Zero(joints, joints), signals.rates);
        none.set_impedance(Matrix::Zero(joints, joints), Vector::Zero(joints));
        ASSERT_TRUE(cell.run(signals, none, measured));
        ASSERT_EQ(cell.at_root.flow, cell.at_leaf.flow);
        const Vector torques = cell.module.torques();
        gave += torques.dot(signals.rates) > 0.0 ? 1 : 0;
        Matrix damping = Matrix::Zero(joints, joints);
        cell.module.add_wall_damping(signals.jacobian, damping);
        ASSERT_TRUE(torques.allFinite() && damping.allFinite()) << "tick " << tick;
        ASSERT_GE(cell.ledger.least, -1e-9 * cell.ledger.passed) << "tick " << tick;
      }
      EXPECT_GT(gave, ticks / 100) << "the sample must ask for energy";
    }
  }
}

TEST(Posture, PushesNothingThatTheToolFeels) {
  Rng rng(seed);
  Kinematics kinematics(seven_joint_arm());
  for (int draw = 0; draw < 200; ++draw) {
    SCOPED_TRACE(families::of_seed(seed, "draw", draw));
    Signals signals = detail::neutral_signals(7, test::period);
    Posture module = fitted({.torque_limit = 1.0}, signals);
    module.read(signals);
    signals.joints = elbow_out() + test::drawn_vector(rng, 7, 0.3);
    signals.rates = test::drawn_vector(rng, 7, 1.0);
    signals.jacobian = jacobian_at(kinematics, signals.joints);
    module.read(signals);
    const Eigen::MatrixXd J = signals.jacobian;
    const Eigen::MatrixXd inverse = J.completeOrthogonalDecomposition().pseudoInverse();
    EXPECT_LE((module.projector() - (Matrix::Identity(7, 7) - inverse * J)).norm(), 1e-9);
    EXPECT_LE((inverse.transpose() * module.torques()).norm(), 1e-8) << "work on the tool";
    Matrix damping = Matrix::Zero(7, 7);
    module.add_wall_damping(signals.jacobian, damping);
    EXPECT_LE((J * damping).norm(), 1e-6 * damping.norm());
    if (module.passivity().dissipated == 0.0) {
      EXPECT_LE(module.torques().cwiseAbs().maxCoeff(), 1.0 + 1e-12);
    }
  }
}

TEST(Posture, SixJointsHaveNothingToSpareInARegularPose) {
  Rng rng(seed);
  const ArmModel arm = test::six_joint_arm();
  Kinematics kinematics(arm);
  Signals signals = detail::neutral_signals(6, test::period);
  Posture module = fitted({}, signals);
  module.read(signals);
  for (int draw = 0; draw < 200; ++draw) {
    signals.joints = Vector::Constant(6, 0.8) + test::drawn_vector(rng, 6, 0.3);
    signals.rates = signals.mean_rates = test::drawn_vector(rng, 6, 1.0);
    signals.jacobian = jacobian_at(kinematics, signals.joints);
    module.read(signals);
    ASSERT_EQ(module.torques(), Vector::Zero(6)) << families::of_seed(seed, "draw", draw);
  }
}

/// The largest change of P between two of `steps` poses on the way, which must be a damped
/// projector in each.
double largest_change(const ArmModel& arm, const Vector& from, const Vector& to, int steps) {
  const auto n = static_cast<int>(from.size());
  Kinematics kinematics(arm);
  Signals signals = detail::neutral_signals(n, test::period);
  Posture module = fitted({}, signals);
  Matrix last;
  double most = 0.0;
  for (int i = 0; i <= steps; ++i) {
    signals.joints = from + static_cast<double>(i) / steps * (to - from);
    signals.jacobian = jacobian_at(kinematics, signals.joints);
    module.read(signals);
    const Matrix P = module.projector();
    EXPECT_TRUE(P.allFinite() && module.torques().allFinite()) << i;
    EXPECT_LE((P - P.transpose()).norm(), 1e-12);
    const Vector rates = Vector::Ones(n);
    const double kept = rates.dot(P * rates);
    EXPECT_GE(kept, (P * rates).squaredNorm() - 1e-12) << "eigenvalues from 0 to 1";
    if (i > 0) most = std::max(most, (P - last).norm());
    last = P;
  }
  return most;
}

TEST(Posture, SingularPosesArePassedContinuously) {
  Vector bent = Vector::Constant(6, 0.5);
  Vector straight = bent;
  bent(4) = -0.1;
  straight(4) = 0.1;  // the axes of the wrist meet on the way
  const double coarse = largest_change(test::six_joint_arm(), bent, straight, 100);
  EXPECT_GT(coarse, 0.03) << "a direction must have come and gone";
  EXPECT_LT(largest_change(test::six_joint_arm(), bent, straight, 10000), 0.02 * coarse);
  const Vector folded = elbow_out();
  Vector stretched = folded;
  stretched.setZero();  // singular in several directions
  EXPECT_LT(largest_change(seven_joint_arm(), folded, stretched, 100000), 0.01);
  EXPECT_LT(largest_change(seven_joint_arm(), stretched, -folded, 100000), 0.01);
}

TEST(Posture, BeginsAgainWhereTheArmIsAfterARelease) {
  Kinematics kinematics(seven_joint_arm());
  Signals signals = detail::neutral_signals(7, test::period);
  Posture module = fitted({}, signals);
  signals.joints = elbow_out();
  signals.jacobian = jacobian_at(kinematics, signals.joints);
  module.read(signals);
  EXPECT_EQ(module.torques(), Vector::Zero(7));
  const Vector n = null_direction(signals.jacobian, Vector::Unit(7, 0));
  signals.joints += 0.1 * n;
  signals.rates = 0.1 * n;
  module.read(signals);
  EXPECT_NEAR(module.torques().dot(n), -(10.0 * 0.1 + 2.0 * 0.1), 1e-9);
  signals.released = true;
  module.read(signals);
  EXPECT_EQ(module.torques(), Vector::Zero(7));
  signals.released = false;
  signals.rates.setZero();
  module.read(signals);
  EXPECT_EQ(module.torques(), Vector::Zero(7)) << "slack at the new pose";
}

TEST(Posture, DampsWhatRateAndDelayNeed) {
  Posture module({.stiffness = 1000.0, .damping = 1.0});
  module.suit(RobotEnd{.wall_ticks = 2.5});
  module.prepare(0.005);
  EXPECT_DOUBLE_EQ(module.options().damping, 2.5 * 0.005 * 1000.0);
}

TEST(Posture, NumbersOutOfRangeAreRefused) {
  EXPECT_THROW(Posture({.stiffness = -1.0}), SetupError);
  EXPECT_THROW(Posture({.damping = std::nan("")}), SetupError);
  EXPECT_THROW(Posture({.torque_limit = -1.0}), SetupError);
  EXPECT_THROW(Posture({.most_energy = 1e7}), SetupError);
  EXPECT_THROW(Posture({.most_damping = -1.0}), SetupError);
  EXPECT_THROW(Posture({.joints = {0.0, std::nan("")}}), SetupError);
  const Plan plan = Plan()
                        .add("hand", FlowSource<any_size>(Vec<any_size>::Zero(6)))
                        .add("kbb2", Kbb2())
                        .add("puma_kin", PumaKin())
                        .add("posture", Posture({.joints = {0.0, 0.0, 0.0}}))
                        .add("puma_joints", PumaJoints(7));
  try {
    (void)plan.build(test::period);
    ADD_FAILURE() << "three positions for seven joints";
  } catch (const SetupError& error) {
    EXPECT_EQ(std::string(error.what()),
              "module 'posture': number of joints with a position is 3; allowed: 7 to 7");
  }
}

}  // namespace posture_test
}  // namespace repel::network
