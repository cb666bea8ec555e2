/// @file
/// Every kind of module that a network can hold.
#pragma once

#include <concepts>
#include <cstddef>
#include <type_traits>
#include <utility>
#include <variant>

#include <repel/network/arm_obstacle.hpp>
#include <repel/network/junction.hpp>
#include <repel/network/kbb2.hpp>
#include <repel/network/limits.hpp>
#include <repel/network/line.hpp>
#include <repel/network/multiplex.hpp>
#include <repel/network/obstacle.hpp>
#include <repel/network/one_ports.hpp>
#include <repel/network/puma_joints.hpp>
#include <repel/network/puma_kin.hpp>
#include <repel/network/relief.hpp>
#include <repel/network/spaceball.hpp>
#include <repel/network/torque_arm.hpp>
#include <repel/network/visual.hpp>

namespace repel::network {

/// One of them. What a network does with each is settled when it is compiled: there is no base
/// class. A module of your own goes into this list.
using Module =
    std::variant<TorqueArm, Multiplex, Spaceball, Relief, Kbb2, Obstacle, PumaKin, ArmObstacle,
                 Limits, Visual, PumaJoints, Junction, Line, Spring<any_size>, Mass<any_size>,
                 Damper<any_size>, EffortSource<any_size>, FlowSource<any_size>>;

namespace detail {

template <class Variant, class Action, std::size_t... I>
void act(Variant& module, const Action& action, std::index_sequence<I...> /*each*/) {
  (void)((module.index() == I ? (action(*std::get_if<I>(&module)), true) : false) || ...);
}
/// std::visit without the throw for a variant that holds nothing, which a tick must not contain.
template <class Action>
void visit(const Action& action, Module& module) {
  act(module, action, std::make_index_sequence<std::variant_size_v<Module>>());
}
template <class Action>
void visit(const Action& action, const Module& module) {
  act(module, action, std::make_index_sequence<std::variant_size_v<Module>>());
}

template <class M>
inline constexpr bool is_source =
    std::is_same_v<M, EffortSource<any_size>> || std::is_same_v<M, FlowSource<any_size>>;
template <class M>
inline constexpr bool is_junction = std::is_same_v<M, Junction>;
template <class M>
inline constexpr bool is_line = std::is_same_v<M, Line>;
template <class M>
inline constexpr bool is_two_port = TwoPort<M>;
/// One-ports that are matched, and those that insist on an effort or a flow.
template <class M>
inline constexpr bool is_one_port = !is_junction<M> && !is_line<M> && !is_two_port<M>;

template <class M>
constexpr Traits traits_of(const M& module) noexcept {
  if constexpr (is_junction<M>) {
    return {.keeps_flow = module.common() == Common::flow};
  } else if constexpr (requires { module.kind(); }) {
    return {.passive = module.kind() == LineKind::waves};
  } else if constexpr (requires { M::traits; }) {
    return M::traits;
  } else {
    return {.passive = !is_source<M>};
  }
}

/// The resistance of a one-port as a matrix of the network's size.
template <class M>
void show_one_port(const M& module, Equivalent<any_size>& shown) noexcept {
  if constexpr (requires { module.equivalent(shown); }) {
    module.equivalent(shown);
  } else {
    shown.form = Form::impedance;
    shown.matrix = module.resistance();
    shown.offset = module.reflected();
  }
}

template <class M>
void settle_one_port(M& module, const PortState<any_size>& state) noexcept {
  if constexpr (requires { module.resistance(); }) {
    const auto& R = module.resistance();
    module.incident(state.effort + R.lazyProduct(state.flow));
  } else if constexpr (requires { module.incident(state); }) {
    module.incident(state);
  }
}

/// Power [W] that a source inside the module supplies.
template <class M>
[[nodiscard]] double supplied_by(const M& module) noexcept {
  if constexpr (requires { module.supplied(); }) {
    return module.supplied();
  } else {
    return 0.0;
  }
}

/// How much more the power of the left port counts.
template <class M>
[[nodiscard]] double left_weight_of(const M& module) noexcept {
  if constexpr (requires { module.left_weight(); }) {
    return module.left_weight();
  } else {
    return 1.0;
  }
}

}  // namespace detail

}  // namespace repel::network
