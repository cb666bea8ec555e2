// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The optional functions of a module: their signatures. Any other signature under these names is
/// refused, as it would never be called.
#pragma once

#include <concepts>
#include <optional>
#include <type_traits>

#include <repel/network/elements/equivalent.hpp>
#include <repel/network/elements/passivity.hpp>
#include <repel/network/elements/port.hpp>
#include <repel/network/elements/robot_end.hpp>
#include <repel/network/elements/signals.hpp>
#include <repel/network/elements/two_port.hpp>

namespace repel::network::detail {

template <class M>
concept Fits = requires(M& m, Space space, int size) {
  m.fit(space, size);
};
template <class M>
concept KnowsItsSize = requires(const M& m) {
  { m.size() } -> std::convertible_to<int>;
};
template <class M>
concept Faces = requires(M& m, Side root) {
  m.face(root);
};
template <class M>
concept Suits = requires(M& m, const RobotEnd& robot) {
  m.suit(robot);
};
template <class M>
concept Prepares = requires(M& m, double period) {
  m.prepare(period);
};
template <class M>
concept Reads = requires(M& m, const Signals& signals) {
  m.read(signals);
};
template <class M>
concept Supplies = requires(const M& m) {
  { m.supplied() } -> std::convertible_to<double>;
};
template <class M>
concept WeighsItsLeft = requires(const M& m) {
  { m.left_weight() } -> std::convertible_to<double>;
};
template <class M>
concept Saturates = requires(const M& m) {
  { m.saturated() } -> std::convertible_to<bool>;
};
template <class M>
concept AddsWalls = requires(const M& m, const Jacobian& jacobian, Vec<any_size>& torques) {
  m.add_walls(jacobian, torques);
};
template <class M>
concept AddsWallDamping = requires(const M& m, const Jacobian& of_tool, Mat<any_size>& damping) {
  m.add_wall_damping(of_tool, damping);
};
template <class M>
concept Predicts = requires(M& m, const Signals& signals, const Vec<any_size>& walls,
                            const Mat<any_size>& damping) {
  m.predict(signals, walls, damping);
};
template <class M>
concept ReportsPassivity = requires(const M& m) {
  { m.passivity() } -> std::convertible_to<std::optional<PassivityReport>>;
};
template <class M>
concept TellsItsTraits = requires(const M& m) {
  { m.traits() } -> std::convertible_to<Traits>;
};
template <class M>
concept HasTraits = requires {
  { M::traits } -> std::convertible_to<Traits>;
};
template <class M>
concept TakesItsState = requires(M& m, const PortState<any_size>& state) {
  m.incident(state);
};

/// Whether a class has any member of a name: a base with the same name then makes it ambiguous. A
/// final class can have no heirs; of it only members that are not overloaded are found.
#define REPEL_HAS_ANY(name)                            \
  struct Named_##name {                                \
    int name = 0;                                      \
  };                                                   \
  template <class M>                                   \
  struct Also_##name : M, Named_##name {};             \
  template <class M>                                   \
  [[nodiscard]] constexpr bool has_##name() noexcept { \
    if constexpr (std::is_final_v<M>) {                \
      return requires {                                \
        &M::name;                                      \
      };                                               \
    } else {                                           \
      return !requires {                               \
        &Also_##name<M>::name;                         \
      };                                               \
    }                                                  \
  }
REPEL_HAS_ANY(fit)
REPEL_HAS_ANY(size)
REPEL_HAS_ANY(face)
REPEL_HAS_ANY(suit)
REPEL_HAS_ANY(prepare)
REPEL_HAS_ANY(read)
REPEL_HAS_ANY(supplied)
REPEL_HAS_ANY(left_weight)
REPEL_HAS_ANY(saturated)
REPEL_HAS_ANY(add_walls)
REPEL_HAS_ANY(add_wall_damping)
REPEL_HAS_ANY(predict)
REPEL_HAS_ANY(passivity)
REPEL_HAS_ANY(traits)
REPEL_HAS_ANY(incident)
#undef REPEL_HAS_ANY

/// Fails to compile, naming the function, if `M` has an optional function with another signature.
template <class M>
constexpr void require_callable() noexcept {
  static_assert(Fits<M> || !has_fit<M>(),
                "repel: 'fit' of a module must be 'void fit(Space space, int size)'");
  static_assert(KnowsItsSize<M> || !has_size<M>(),
                "repel: 'size' of a module must be 'int size() const noexcept'");
  static_assert(Faces<M> || !has_face<M>(),
                "repel: 'face' of a module must be 'void face(Side root) noexcept'");
  static_assert(Suits<M> || !has_suit<M>(),
                "repel: 'suit' of a module must be 'void suit(const RobotEnd& robot)'");
  static_assert(Prepares<M> || !has_prepare<M>(),
                "repel: 'prepare' of a module must be 'void prepare(double period)'");
  static_assert(Reads<M> || !has_read<M>(),
                "repel: 'read' of a module must be 'void read(const Signals& signals) noexcept'");
  static_assert(Supplies<M> || !has_supplied<M>(),
                "repel: 'supplied' of a module must be 'double supplied() const noexcept'");
  static_assert(WeighsItsLeft<M> || !has_left_weight<M>(),
                "repel: 'left_weight' of a module must be 'double left_weight() const noexcept'");
  static_assert(Saturates<M> || !has_saturated<M>(),
                "repel: 'saturated' of a module must be 'bool saturated() const noexcept'");
  static_assert(AddsWalls<M> || !has_add_walls<M>(),
                "repel: 'add_walls' of a module must be 'void add_walls(const Jacobian& jacobian, "
                "Vec<any_size>& torques) const noexcept'");
  static_assert(AddsWallDamping<M> || !has_add_wall_damping<M>(),
                "repel: 'add_wall_damping' of a module must be 'void add_wall_damping(const "
                "Jacobian& of_tool, Mat<any_size>& damping) const noexcept'");
  static_assert(Predicts<M> || !has_predict<M>(),
                "repel: 'predict' of a module must be 'void predict(const Signals& signals, const "
                "Vec<any_size>& walls, const Mat<any_size>& damping) noexcept'");
  static_assert(ReportsPassivity<M> || !has_passivity<M>(),
                "repel: 'passivity' of a module must be 'PassivityReport passivity() const "
                "noexcept'");
  static_assert(TellsItsTraits<M> || HasTraits<M> || !has_traits<M>(),
                "repel: 'traits' of a module must be 'static constexpr Traits traits' or 'Traits "
                "traits() const noexcept'");
}

}  // namespace repel::network::detail
