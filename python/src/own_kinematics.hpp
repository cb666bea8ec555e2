// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Kinematics that are written in Python.
#pragma once

#include <memory>
#include <optional>
#include <span>

#include <nanobind/nanobind.h>

#include <repel/world/arm_kinematics.hpp>

namespace repel::python {

namespace nb = nanobind;

/// The first error that Python raised in the functions of a tick, which must not throw. They answer
/// NaN then, and whoever called the tick raises it.
using Trouble = std::shared_ptr<std::optional<nb::python_error>>;

/// Raises it, once.
void raise(const Trouble& trouble);

/// Asks an object of Python with the functions of `repel.Kinematics`. Needs no GIL of the caller.
class OwnKinematics final : public ArmKinematics {
 public:
  OwnKinematics(nb::object object, std::size_t joints, Trouble trouble);
  ~OwnKinematics() override;
  OwnKinematics(const OwnKinematics&) = delete;
  OwnKinematics& operator=(const OwnKinematics&) = delete;

  void update(std::span<const double> q) noexcept override;
  [[nodiscard]] Pose X_WT() const noexcept override;
  void tool_jacobian(JacobianRef J) const noexcept override;
  void gravity_torques(std::span<double> out) noexcept override;
  [[nodiscard]] Pose X_WL(int link) const noexcept override;
  void jacobian(int link, const Vec3& p_WQ, JacobianRef J) const noexcept override;
  [[nodiscard]] bool mass_matrix(Eigen::MatrixXd& M) const noexcept override;

  /// For the collector of Python.
  [[nodiscard]] nb::handle object() const noexcept { return object_; }
  /// Lets go of the object; all answers are NaN from then on.
  void clear() noexcept { object_.reset(); }

 private:
  template <class Work>
  bool attempt(const Work& work) const noexcept;

  nb::object object_;
  std::size_t joints_;
  Trouble trouble_;
  bool places_links_ = false, has_jacobian_ = false, has_mass_ = false;
};

}  // namespace repel::python
