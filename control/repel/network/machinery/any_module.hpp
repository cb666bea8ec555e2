// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The type-erased interface of a network module, and its adaptor for any type.
#pragma once

#include <concepts>
#include <memory>
#include <optional>
#include <type_traits>
#include <utility>

#include <repel/network/elements/equivalent.hpp>
#include <repel/network/elements/junction.hpp>
#include <repel/network/elements/passivity.hpp>
#include <repel/network/elements/robot_end.hpp>
#include <repel/network/elements/signals.hpp>
#include <repel/network/elements/two_port.hpp>
#include <repel/network/machinery/optional_functions.hpp>

namespace repel::network {

/// Kind of a module by its ports.
enum class Ports {
  one,       ///< terminates a branch
  two,       ///< between the subtree behind it and the root
  line,      ///< two ends, each a one-port: what enters one end leaves the other after a delay
  junction,  ///< where branches meet
};

namespace detail {

template <class M>
concept ShowsItsEnds = requires(const M& m, Equivalent<any_size>& shown) {
  m.equivalent(Side::left, shown);
};
template <class M>
concept ShowsItself = requires(const M& m, Equivalent<any_size>& shown) {
  m.equivalent(shown);
};
template <class M>
concept ShowsItsWaves = requires(const M& m) {
  m.resistance();
  m.reflected();
};

template <class M>
[[nodiscard]] constexpr Ports ports_of() noexcept {
  if constexpr (std::is_same_v<M, Junction>) {
    return Ports::junction;
  } else if constexpr (ShowsItsEnds<M>) {
    return Ports::line;
  } else if constexpr (ShowsItself<M> || ShowsItsWaves<M>) {
    return Ports::one;
  } else {
    return Ports::two;
  }
}

template <class M>
concept ShowsWhatIsBehind = requires(M& m, const Equivalent<any_size>& behind,
                                     Equivalent<any_size>& shown) {
  { m.reflected(behind, shown) }
  noexcept->std::same_as<bool>;
};
template <class M>
concept PassesTheStateOn = requires(M& m, const PortState<any_size>& at_root,
                                    const Equivalent<any_size>& behind,
                                    PortState<any_size>& at_leaf) {
  { m.incident(at_root, behind, at_leaf) }
  noexcept;
};
template <class M>
concept TakesTheStatesOfItsEnds = requires(M& m, const PortState<any_size>& state) {
  { m.incident(Side::left, state) }
  noexcept;
};
template <class M>
concept TakesItsWave = requires(M& m, const M& same) {
  { m.incident(same.reflected()) }
  noexcept;
};

/// Fails to compile with a message for the first requirement of a module that `M` does not meet.
template <class M>
constexpr void require_module() noexcept {
  constexpr Ports ports = ports_of<M>();
  static_assert(std::copy_constructible<M>,
                "repel: a module must be copyable: a plan is built as often as one likes");
  if constexpr (ports == Ports::two && !ShowsWhatIsBehind<M>) {
    static_assert(
        ShowsWhatIsBehind<M>,
        "repel: a module needs 'bool reflected(const Equivalent<any_size>& behind, "
        "Equivalent<any_size>& shown) noexcept' (two-port), 'void equivalent(Equivalent<any_size>& "
        "shown) const noexcept' (one-port), or 'resistance()' and 'reflected()' (matched "
        "one-port)");
  } else if constexpr (ports == Ports::two) {
    static_assert(
        PassesTheStateOn<M>,
        "repel: a two-port needs 'void incident(const PortState<any_size>& at_root, const "
        "Equivalent<any_size>& behind, PortState<any_size>& at_leaf) noexcept'");
  } else if constexpr (ports == Ports::line) {
    static_assert(
        TakesTheStatesOfItsEnds<M>,
        "repel: a line needs 'void incident(Side end, const PortState<any_size>& state) noexcept'");
  } else if constexpr (ShowsItsWaves<M> && !ShowsItself<M>) {
    static_assert(TakesItsWave<M>,
                  "repel: a matched one-port needs 'void incident(const Vec<N>& wave) noexcept'");
  } else if constexpr (ports == Ports::one) {
    static_assert((ShowsItsWaves<M> ? TakesItsWave<M> : TakesItsState<M>) || !has_incident<M>(),
                  "repel: 'incident' of a one-port must be 'void incident(const "
                  "PortState<any_size>& state) noexcept' or, if it shows its waves, 'void "
                  "incident(const Vec<N>& wave) noexcept'");
  }
  require_callable<M>();
}

template <class M>
[[nodiscard]] constexpr Traits traits_of(const M& module) noexcept {
  if constexpr (TellsItsTraits<M>) {
    return module.traits();
  } else if constexpr (HasTraits<M>) {
    return M::traits;
  } else {
    return {};
  }
}

/// Writes the equivalent of a one-port: its own, or that of its port resistance and reflected wave.
template <class M>
void show_one_port(const M& module, Equivalent<any_size>& shown) noexcept {
  if constexpr (ShowsItself<M>) {
    module.equivalent(shown);
  } else {
    shown.form = Form::impedance;
    shown.matrix = module.resistance();
    shown.offset = module.reflected();
  }
}

template <class M>
void settle_one_port(M& module, const PortState<any_size>& state) noexcept {
  if constexpr (ShowsItsWaves<M>) {
    const auto& R = module.resistance();
    if constexpr (TakesItsWave<M>) module.incident(state.incident(R));
  } else if constexpr (TakesItsState<M>) {
    module.incident(state);
  }
}

/// Type-erased interface of a module. Set-up functions may throw, the others may not.
class AnyModule {
 public:
  AnyModule() = default;
  AnyModule& operator=(const AnyModule&) = delete;
  AnyModule& operator=(AnyModule&&) = delete;
  virtual ~AnyModule() = default;

  [[nodiscard]] virtual std::unique_ptr<AnyModule> copy() const = 0;
  [[nodiscard]] virtual Traits traits() const noexcept = 0;
  virtual void fit(Space space, int size) = 0;
  [[nodiscard]] virtual int size() const noexcept = 0;
  virtual void face(Side root) noexcept = 0;
  virtual void suit(const RobotEnd& robot) = 0;
  virtual void prepare(double period) = 0;

  virtual void read(const Signals& signals) noexcept = 0;
  [[nodiscard]] virtual bool reflected(const Equivalent<any_size>& behind,
                                       Equivalent<any_size>& shown) noexcept = 0;
  virtual void incident(const PortState<any_size>& at_root, const Equivalent<any_size>& behind,
                        PortState<any_size>& at_leaf) noexcept = 0;
  virtual void show_end(Side end, Equivalent<any_size>& shown) const noexcept = 0;
  virtual void settle_end(Side end, const PortState<any_size>& state) noexcept = 0;

  [[nodiscard]] virtual double supplied() const noexcept = 0;
  [[nodiscard]] virtual double left_weight() const noexcept = 0;
  [[nodiscard]] virtual bool saturated() const noexcept = 0;
  virtual void add_walls(const Jacobian& jacobian, Vec<any_size>& torques) const noexcept = 0;
  virtual void add_wall_damping(const Jacobian& jacobian,
                                Mat<any_size>& damping) const noexcept = 0;
  virtual void predict(const Signals& signals, const Vec<any_size>& walls,
                       const Mat<any_size>& damping) noexcept = 0;
  [[nodiscard]] virtual std::optional<PassivityReport> passivity() const noexcept = 0;

 protected:
  AnyModule(const AnyModule&) = default;
  AnyModule(AnyModule&&) = default;
};

/// Its address identifies the type `M`.
template <class M>
inline constexpr char type_mark = 0;

/// Adapts `M` to AnyModule. An optional function that `M` does not have does nothing, or returns a
/// neutral value.
template <class M>
class ModuleOf final : public AnyModule {
 public:
  explicit ModuleOf(M module) : module_(std::move(module)) {}

  [[nodiscard]] const M& module() const noexcept { return module_; }

  [[nodiscard]] std::unique_ptr<AnyModule> copy() const override {
    return std::make_unique<ModuleOf>(module_);
  }
  [[nodiscard]] Traits traits() const noexcept override { return traits_of(module_); }
  void fit(Space space, int size) override {
    if constexpr (Fits<M>) module_.fit(space, size);
  }
  [[nodiscard]] int size() const noexcept override {
    if constexpr (KnowsItsSize<M>) return module_.size();
    return 0;
  }
  void face(Side root) noexcept override {
    if constexpr (Faces<M>) module_.face(root);
  }
  void suit(const RobotEnd& robot) override {
    if constexpr (Suits<M>) module_.suit(robot);
  }
  void prepare(double period) override {
    if constexpr (Prepares<M>) module_.prepare(period);
  }

  void read(const Signals& signals) noexcept override {
    if constexpr (Reads<M>) module_.read(signals);
  }
  [[nodiscard]] bool reflected(const Equivalent<any_size>& behind,
                               Equivalent<any_size>& shown) noexcept override {
    if constexpr (ShowsWhatIsBehind<M>) {
      return module_.reflected(behind, shown);
    } else {
      return false;
    }
  }
  void incident(const PortState<any_size>& at_root, const Equivalent<any_size>& behind,
                PortState<any_size>& at_leaf) noexcept override {
    if constexpr (PassesTheStateOn<M>) {
      module_.incident(at_root, behind, at_leaf);
    }
  }
  void show_end(Side end, Equivalent<any_size>& shown) const noexcept override {
    if constexpr (ports_of<M>() == Ports::line) {
      module_.equivalent(end, shown);
    } else if constexpr (ports_of<M>() == Ports::one) {
      show_one_port(module_, shown);
    }
  }
  void settle_end(Side end, const PortState<any_size>& state) noexcept override {
    if constexpr (TakesTheStatesOfItsEnds<M>) {
      module_.incident(end, state);
    } else if constexpr (ports_of<M>() == Ports::one) {
      settle_one_port(module_, state);
    }
  }

  [[nodiscard]] double supplied() const noexcept override {
    if constexpr (Supplies<M>) return module_.supplied();
    return 0.0;
  }
  [[nodiscard]] double left_weight() const noexcept override {
    if constexpr (WeighsItsLeft<M>) return module_.left_weight();
    return 1.0;
  }
  [[nodiscard]] bool saturated() const noexcept override {
    if constexpr (Saturates<M>) return module_.saturated();
    return false;
  }
  void add_walls(const Jacobian& jacobian, Vec<any_size>& torques) const noexcept override {
    if constexpr (AddsWalls<M>) module_.add_walls(jacobian, torques);
  }
  void add_wall_damping(const Jacobian& jacobian, Mat<any_size>& damping) const noexcept override {
    if constexpr (AddsWallDamping<M>) module_.add_wall_damping(jacobian, damping);
  }
  void predict(const Signals& signals, const Vec<any_size>& walls,
               const Mat<any_size>& damping) noexcept override {
    if constexpr (Predicts<M>) module_.predict(signals, walls, damping);
  }
  [[nodiscard]] std::optional<PassivityReport> passivity() const noexcept override {
    if constexpr (ReportsPassivity<M>) return module_.passivity();
    return std::nullopt;
  }

 private:
  M module_;
};

}  // namespace detail

}  // namespace repel::network
