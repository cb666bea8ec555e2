// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// A cell as Python holds it.
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <nanobind/nanobind.h>

#include <repel/cell/admittance.hpp>
#include <repel/cell/cell.hpp>

#include "description.hpp"
#include "interpreter.hpp"
#include "own_kinematics.hpp"
#include "tick.hpp"

namespace repel::python {

/// What an arm reports; the numbers live here.
struct OwnReadings {
  std::vector<double> q;               ///< [rad] or [m]
  std::vector<double> v;               ///< [rad/s] or [m/s]
  std::optional<Wrench> wrench;        ///< [N, N m] see ArmReadings
  ArmState state = ArmState::enabled;  ///< of its drive
  bool homed = false;                  ///< see ArmReadings

  /// @throws the error of Python for numbers of another shape
  OwnReadings(nb::handle positions, nb::handle rates, std::size_t joints);
  /// @param sensor six numbers, or none @param drive enabled, disabled or stopped
  /// @throws the error of Python for another shape, SetupError for another word
  void add(nb::handle sensor, const std::string& drive);
  /// Refers to this one.
  [[nodiscard]] ArmReadings readings() const;
};

/// Who is told of the shapes that loose parts get, as a display.
class ShapeListener {
 public:
  /// The part has this shape from now on.
  virtual void shaped(PartId part, const Shape& shape) = 0;

 protected:
  ~ShapeListener() = default;
};

/// A cell, with the kinematics that are written in Python and the names of its records.
class OwnCell {
 public:
  /// @throws the error of the kinematics, or SetupError
  OwnCell(OwnDescription description, Trouble trouble);

  /// One tick of a cell with one arm. @param now [ns] above 0; none: one period after the last
  [[nodiscard]] Tick step(nb::handle q, nb::handle v, const network::Command& hands,
                          std::optional<std::int64_t> now, bool homed, nb::handle wrench,
                          const std::string& state);
  /// The two halves of a tick. @param readings (q, v), (q, v, wrench) or (q, v, wrench, state) for
  /// each arm
  void sense(const nb::sequence& readings, std::optional<std::int64_t> now, bool homed);
  [[nodiscard]] std::vector<Tick> act(const std::vector<network::Command>& hands);

  [[nodiscard]] Cell& cell() noexcept { return *cell_; }
  /// @throws SetupError if there is no such arm
  [[nodiscard]] std::size_t checked_arm(int arm) const;
  [[nodiscard]] const std::vector<OwnKinematics*>& kinematics() const { return kinematics_; }
  /// What a display shows of the last tick. @throws SetupError if there was none
  [[nodiscard]] nb::dict picture();
  /// Of all arms, of the last tick; empty: there was none.
  [[nodiscard]] const std::vector<const TickRecord*>& records() const noexcept { return records_; }
  /// The loose part of that name. @throws SetupError if there is none
  [[nodiscard]] PartId loose(const std::string& name) const;
  /// For as long as a call uses the cell. @throws std::runtime_error if another one does
  [[nodiscard]] InUse use() { return InUse(is_in_use_); }

  std::vector<ShapeListener*> listeners;  ///< each takes itself out before it ends
  /// Tells all of them.
  void tell(PartId part, const Shape& shape) const {
    for (ShapeListener* listener : listeners) listener->shaped(part, shape);
  }

 private:
  /// The record of an arm, and its motion if it takes that in place of torques.
  [[nodiscard]] Tick tick_of(std::size_t arm, const TickRecord& record, const OwnReadings& own);
  [[nodiscard]] std::chrono::nanoseconds time_of(std::optional<std::int64_t> now);

  Trouble trouble_;
  std::vector<OwnKinematics*> kinematics_;
  std::unique_ptr<Cell> cell_;
  std::vector<std::shared_ptr<const TickNames>> names_;
  std::vector<std::optional<JointAdmittance>> ends_;  // of arms that take motion
  std::vector<OwnReadings> sensed_;                   // by the last `sense`
  std::vector<const TickRecord*> records_;            // of the last tick
  std::chrono::nanoseconds last_{0};
  bool has_sensed_ = false;
  bool is_in_use_ = false;
};

/// For the collector of Python: what was made with `nb::keep_alive` of a cell refers to it.
template <class Companion>
int traverse_companion(PyObject* self, visitproc visit, void* arg) {
  Py_VISIT(Py_TYPE(self));
  if (!nb::inst_ready(self)) return 0;
  const nb::object cell = nb::find(nb::inst_ptr<Companion>(self)->cell());
  Py_VISIT(cell.ptr());
  return 0;
}
template <class Companion>
inline PyType_Slot companion_slots[] = {
    {Py_tp_traverse, reinterpret_cast<void*>(traverse_companion<Companion>)}, {0, nullptr}};

}  // namespace repel::python
