// SPDX-License-Identifier: BSD-3-Clause
// What the adapter and its stand-in take for the interface of libfranka. It is checked while it
// compiles: with the stand-in here, with the headers of libfranka where they are (the page of the
// torque callback has the command).
#include <array>
#include <concepts>
#include <functional>
#include <string>
#include <type_traits>
#include <utility>

#include <franka/control_types.h>
#include <franka/duration.h>
#include <franka/exception.h>
#include <franka/lowpass_filter.h>
#include <franka/model.h>
#include <franka/robot.h>
#include <franka/robot_state.h>

namespace repel::test {
namespace franka_interface_test {

using franka::CartesianPose, franka::CartesianVelocities, franka::Duration, franka::Frame;
using franka::JointPositions, franka::JointVelocities, franka::Model, franka::Robot;
using franka::RobotState, franka::Torques;
using Three = std::array<double, 3>;
using Six = std::array<double, 6>;
using Seven = std::array<double, 7>;
using Nine = std::array<double, 9>;
using Sixteen = std::array<double, 16>;

/// Whether a pointer to a member function is of this type: overloads and their order of arguments.
template <class Function>
constexpr bool is(Function /*member*/) {
  return true;
}

// A MotionFinished for each kind of command. Seven bare numbers fit three of them.
template <class Command>
concept IsFinished = requires(const Command& command) {
  { franka::MotionFinished(command) } -> std::same_as<Command>;
};
static_assert(IsFinished<Torques> && IsFinished<JointPositions> && IsFinished<JointVelocities> &&
              IsFinished<CartesianPose> && IsFinished<CartesianVelocities>);
template <class Numbers>
concept IsTakenForACommand = requires(const Numbers& numbers) {
  franka::MotionFinished(numbers);
};
static_assert(!IsTakenForACommand<Seven>, "the stand-in takes what libfranka refuses");

template <class Command>
using By = std::function<Command(const RobotState&, Duration)>;
template <class Motion>
constexpr bool is_controlled() {
  return is<void (Robot::*)(By<Torques>, By<Motion>, bool, double)>(&Robot::control) &&
         is<void (Robot::*)(By<Motion>, franka::ControllerMode, bool, double)>(&Robot::control);
}
static_assert(is<void (Robot::*)(By<Torques>, bool, double)>(&Robot::control));
static_assert(is_controlled<JointPositions>() && is_controlled<JointVelocities>() &&
              is_controlled<CartesianPose>() && is_controlled<CartesianVelocities>());

// With and without the last arguments, from a function that fits one kind of command alone.
template <class Command>
using Leads = Command (*)(const RobotState&, Duration);
template <class... Arguments>
concept IsControlled = requires(Robot& robot, Arguments... arguments) {
  robot.control(arguments...);
};
static_assert(IsControlled<Leads<Torques>> && IsControlled<Leads<Torques>, bool, double> &&
              IsControlled<Leads<Torques>, Leads<JointVelocities>> &&
              IsControlled<Leads<Torques>, Leads<JointPositions>, bool, double> &&
              IsControlled<Leads<JointVelocities>> &&
              IsControlled<Leads<JointPositions>, franka::ControllerMode, bool>);

static_assert(std::constructible_from<Robot, std::string> &&
              std::constructible_from<Robot, std::string, franka::RealtimeConfig> &&
              std::constructible_from<Robot, std::string, franka::RealtimeConfig, std::size_t>);
static_assert(!std::convertible_to<std::string, Robot> && !std::default_initializable<Robot>);
static_assert(!std::copyable<Robot> && std::movable<Robot>);
static_assert(requires(Robot & robot) {
  { robot.loadModel() } -> std::same_as<Model>;
  { robot.readOnce() } -> std::same_as<RobotState>;
  { robot.serverVersion() } -> std::same_as<Robot::ServerVersion>;
  robot.read([](const RobotState&) { return false; });
  robot.automaticErrorRecovery();
  robot.stop();
});
static_assert(
    is<void (Robot::*)(const Sixteen&)>(&Robot::setEE) &&
    is<void (Robot::*)(double, const Three&, const Nine&)>(&Robot::setLoad) &&
    is<void (Robot::*)(const Seven&, const Seven&, const Six&, const Six&)>(
        &Robot::setCollisionBehavior) &&
    is<void (Robot::*)(const Seven&, const Seven&, const Seven&, const Seven&, const Six&,
                       const Six&, const Six&, const Six&)>(&Robot::setCollisionBehavior));
// Absent before 0.14.
template <class R>
concept TellsItsModelAsTextIfAtAll = !requires(R & robot) {
  robot.getRobotModel();
}
|| requires(R& robot) {
  { robot.getRobotModel() } -> std::same_as<std::string>;
};
static_assert(TellsItsModelAsTextIfAtAll<Robot>);

static_assert(!std::default_initializable<Model> && !std::copyable<Model> && std::movable<Model>);
template <class Matrix>
using OfFrame = Matrix (Model::*)(Frame, const RobotState&) const;
template <class Matrix>
using OfFrameAt = Matrix (Model::*)(Frame, const Seven&, const Sixteen&, const Sixteen&) const;
using Jacobian = std::array<double, 42>;
using Mass = std::array<double, 49>;
static_assert(is<OfFrame<Sixteen>>(&Model::pose) && is<OfFrameAt<Sixteen>>(&Model::pose));
static_assert(is<OfFrame<Jacobian>>(&Model::zeroJacobian) &&
              is<OfFrameAt<Jacobian>>(&Model::zeroJacobian));
static_assert(is<OfFrame<Jacobian>>(&Model::bodyJacobian) &&
              is<OfFrameAt<Jacobian>>(&Model::bodyJacobian));
static_assert(is<Mass (Model::*)(const RobotState&) const noexcept>(&Model::mass) &&
              is<Mass (Model::*)(const Seven&, const Nine&, double, const Three&) const noexcept>(
                  &Model::mass));
static_assert(is<Seven (Model::*)(const RobotState&) const noexcept>(&Model::coriolis));
static_assert(requires(const Model& model, const RobotState& state) {
  { model.gravity(state.q, state.m_total, state.F_x_Ctotal) } -> std::same_as<Seven>;
  {
    model.gravity(state.q, state.m_total, state.F_x_Ctotal, state.F_x_Ctotal)
    } -> std::same_as<Seven>;
});
static_assert(static_cast<int>(Frame::kJoint1) == 0 && static_cast<int>(Frame::kJoint7) == 6,
              "links of the adapter are frames by their number");

template <class Member>
constexpr bool is_of_state(Member RobotState::*) {
  return true;
}
static_assert(is_of_state<Seven>(&RobotState::q) && is_of_state<Seven>(&RobotState::dq) &&
              is_of_state<Seven>(&RobotState::q_d) && is_of_state<Seven>(&RobotState::dq_d) &&
              is_of_state<Seven>(&RobotState::tau_J) && is_of_state<Seven>(&RobotState::tau_J_d) &&
              is_of_state<Seven>(&RobotState::dtau_J) &&
              is_of_state<Seven>(&RobotState::tau_ext_hat_filtered) &&
              is_of_state<Six>(&RobotState::O_F_ext_hat_K) &&
              is_of_state<Sixteen>(&RobotState::O_T_EE) &&
              is_of_state<Sixteen>(&RobotState::F_T_EE) &&
              is_of_state<Sixteen>(&RobotState::EE_T_K));
static_assert(is_of_state<double>(&RobotState::m_ee) && is_of_state<double>(&RobotState::m_load) &&
              is_of_state<double>(&RobotState::m_total) && is_of_state<Nine>(&RobotState::I_load) &&
              is_of_state<Nine>(&RobotState::I_total) &&
              is_of_state<Three>(&RobotState::F_x_Cload) &&
              is_of_state<Three>(&RobotState::F_x_Ctotal) &&
              is_of_state<double>(&RobotState::control_command_success_rate) &&
              is_of_state<franka::RobotMode>(&RobotState::robot_mode) &&
              is_of_state<Duration>(&RobotState::time));

using Milliseconds = std::chrono::duration<uint64_t, std::milli>;
static_assert(std::constructible_from<Duration, uint64_t> &&
              !std::convertible_to<uint64_t, Duration> &&
              std::convertible_to<Milliseconds, Duration> &&
              std::convertible_to<Duration, Milliseconds>);
static_assert(requires(Duration a, const Duration b, uint64_t n) {
  { b.toSec() } -> std::same_as<double>;
  { b.toMSec() } -> std::same_as<uint64_t>;
  { b + b - b } -> std::same_as<Duration>;
  { n* b* n } -> std::same_as<Duration>;
  { b / b } -> std::same_as<uint64_t>;
  { b / n % b % n } -> std::same_as<Duration>;
  { ((((((a += b) -= b) *= n) /= n) %= b) %= n) } -> std::same_as<Duration&>;
  { b == b&& b != b&& b<b && b <= b && b> b&& b >= b } -> std::same_as<bool>;
});

static_assert(std::derived_from<franka::ControlException, franka::Exception> &&
              std::derived_from<franka::Exception, std::runtime_error>);
static_assert(franka::kMaxCutoffFrequency == 1000.0 && franka::kDefaultCutoffFrequency == 100.0);

}  // namespace franka_interface_test
}  // namespace repel::test
