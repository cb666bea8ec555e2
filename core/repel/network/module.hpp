/// @file
/// A module of any type, as a network holds it.
#pragma once

#include <concepts>
#include <memory>
#include <type_traits>
#include <utility>

#include <repel/network/any_module.hpp>

namespace repel::network {

/// A module of a network: an object of any copyable type that offers what one of these needs.
///
/// A two-port:
///
///     bool reflected(const Equivalent<any_size>& behind, Equivalent<any_size>& shown) noexcept;
///     void incident(const PortState<any_size>& at_root, const Equivalent<any_size>& behind,
///                   PortState<any_size>& at_leaf) noexcept;
///
/// A one-port, by what it shows or, matched, by its waves:
///
///     void equivalent(Equivalent<any_size>& shown) const noexcept;
///     void incident(const PortState<any_size>& state) noexcept;         // or not at all
///
///     const Mat<N>& resistance() const noexcept;
///     Vec<N> reflected() const noexcept;
///     void incident(const Vec<N>& wave) noexcept;
///
/// A line, of which each end is a one-port: `equivalent` and `incident` with a `Side` before the
/// other arguments. And of these what it has a use for:
///
///     static constexpr Traits traits;                // or a function of that name
///     void fit(Space space, int size);               // the port it stands at; may throw
///     int size() const noexcept;                     // of its port, if it has one of its own
///     void face(Side root) noexcept;                 // where the root is
///     void prepare(double period);                   // [s]; may throw
///     void read(const Signals& signals) noexcept;    // first of all in every tick
///     double supplied() const noexcept;              // [W] by a source of its own
///     double left_weight() const noexcept;           // of the power of its left port
///     bool saturated() const noexcept;               // something was cut to its limit
///     PassivityReport passivity() const noexcept;
///     void add_walls(const Jacobian& jacobian, Vec<any_size>& torques) const noexcept;
///
/// `add_walls` adds what a wall or a limit does to the joints [N m]: it stays when the operator is
/// let go. Nothing but `fit` and `prepare` may throw or allocate. What is missing is said when it
/// is compiled. Cost: a virtual call for each.
class Module {
 public:
  template <class M>
  requires(!std::same_as<std::remove_cvref_t<M>, Module>)
      // NOLINTNEXTLINE(google-explicit-constructor): any module can stand for itself
      Module(M module)
      : ports_(detail::ports_of<M>()),
        held_(std::make_unique<detail::ModuleOf<M>>(std::move(module))) {
    detail::require_module<M>();
  }
  Module(const Module& other) : ports_(other.ports_), held_(other.held_->copy()) {}
  Module(Module&&) noexcept = default;
  Module& operator=(const Module& other) {
    if (this != &other) *this = Module(other);
    return *this;
  }
  Module& operator=(Module&&) noexcept = default;
  ~Module() = default;

  /// The object itself, if it is an `M`; else null.
  template <class M>
  [[nodiscard]] const M* as() const noexcept {
    return static_cast<const M*>(held_->get(&detail::type_mark<M>));
  }

  [[nodiscard]] Ports ports() const noexcept { return ports_; }

  [[nodiscard]] detail::AnyModule& operator*() noexcept { return *held_; }
  [[nodiscard]] const detail::AnyModule& operator*() const noexcept { return *held_; }
  [[nodiscard]] detail::AnyModule* operator->() noexcept { return held_.get(); }
  [[nodiscard]] const detail::AnyModule* operator->() const noexcept { return held_.get(); }

 private:
  Ports ports_;
  std::unique_ptr<detail::AnyModule> held_;
};

}  // namespace repel::network
