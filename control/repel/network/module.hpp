// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Type-erased holder of a network module of any type.
#pragma once

#include <concepts>
#include <memory>
#include <type_traits>
#include <utility>

#include <repel/network/machinery/any_module.hpp>

namespace repel::network {

/// A module of a network: an object of any copyable type that has the functions of one of these
/// kinds.
///
/// A two-port:
///
///     bool reflected(const Equivalent<any_size>& behind, Equivalent<any_size>& shown) noexcept;
///     void incident(const PortState<any_size>& at_root, const Equivalent<any_size>& behind,
///                   PortState<any_size>& at_leaf) noexcept;
///
/// A one-port, by its equivalent or, if it is matched, by its waves:
///
///     void equivalent(Equivalent<any_size>& shown) const noexcept;
///     void incident(const PortState<any_size>& state) noexcept;         // optional
///
///     const Mat<N>& resistance() const noexcept;
///     Vec<N> reflected() const noexcept;
///     void incident(const Vec<N>& wave) noexcept;
///
/// A line, of which each end is a one-port: `equivalent` and `incident` with a `Side` before the
/// other arguments. Optional functions of all kinds:
///
///     static constexpr Traits traits;                // or a function of that name
///     void suit(const RobotEnd& robot);              // the arm, for gains that suit it
///     void fit(Space space, int size);               // of the connected port; may throw
///     int size() const noexcept;                     // of its port, if it is fixed
///     void face(Side root) noexcept;                 // the side of the root
///     void prepare(double period);                   // [s]; may throw
///     void read(const Signals& signals) noexcept;    // first call of every tick
///     double supplied() const noexcept;              // [W] by its own source
///     double left_weight() const noexcept;           // of the left port's power in the ledger
///     bool saturated() const noexcept;               // something was clamped to its limit
///     PassivityReport passivity() const noexcept;
///     void add_walls(const Jacobian& jacobian, Vec<any_size>& torques) const noexcept;
///     void add_wall_damping(const Jacobian& of_tool, Mat<any_size>& damping) const noexcept;
///     void predict(const Signals& signals, const Vec<any_size>& walls,
///                  const Mat<any_size>& damping) noexcept;
///
/// `add_walls` adds the joint torques of a wall or a limit [N m]: they stay active when the
/// fail-safe removes the operator's force. `add_wall_damping` adds how much they fall with the
/// joint rates [N m s/rad], besides the walls of the world model. `predict` is called for the
/// element `prediction` after every module has read its signals, with the sums of both. Only
/// `suit`, `fit` and `prepare` may throw or allocate; they are called once, in this order. A
/// missing function, and one with another signature under one of these names, is a compile-time
/// error. Cost: a virtual call for each.
class Module {
 public:
  /// Holds a copy of any module; a missing or wrong function is a compile-time error.
  template <class M>
  requires(!std::same_as<std::remove_cvref_t<M>, Module>)
      // NOLINTNEXTLINE(google-explicit-constructor): any module can stand for itself
      Module(M module)
      : ports_(detail::ports_of<M>()),
        type_(&detail::type_mark<M>),
        held_(std::make_unique<detail::ModuleOf<M>>(std::move(module))) {
    detail::require_module<M>();
  }
  /// Copies the module with its state. Allocates.
  Module(const Module& other)
      : ports_(other.ports_), type_(other.type_), held_(other.held_->copy()) {}
  /// The other then holds none.
  Module(Module&&) noexcept = default;
  /// Copies the module with its state. Allocates.
  Module& operator=(const Module& other);
  /// The other then holds none.
  Module& operator=(Module&&) noexcept = default;
  ~Module() = default;

  /// The module as an `M`; null if it is of another type.
  template <class M>
  [[nodiscard]] const M* as() const noexcept {
    if (type_ != &detail::type_mark<M>) return nullptr;
    return &static_cast<const detail::ModuleOf<M>&>(*held_).module();
  }

  [[nodiscard]] Ports ports() const noexcept { return ports_; }  ///< which of the kinds it is

  /// What it holds, by its functions.
  [[nodiscard]] detail::AnyModule& operator*() noexcept { return *held_; }
  /// What it holds, by its functions.
  [[nodiscard]] const detail::AnyModule& operator*() const noexcept { return *held_; }
  /// What it holds, by its functions.
  [[nodiscard]] detail::AnyModule* operator->() noexcept { return held_.get(); }
  /// What it holds, by its functions.
  [[nodiscard]] const detail::AnyModule* operator->() const noexcept { return held_.get(); }

 private:
  Ports ports_;
  const void* type_;
  std::unique_ptr<detail::AnyModule> held_;
};

}  // namespace repel::network
