// SPDX-License-Identifier: BSD-3-Clause
#include "own_kinematics.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "arrays.hpp"
#include "interpreter.hpp"

namespace repel::python {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

Pose unknown_pose() {
  Pose X = Pose::Identity();
  X.translation().setConstant(nan);
  return X;
}

/// Four by four numbers, whatever they are: the tick has its own reaction to poses that are none.
Pose pose_from(nb::handle value, const char* name) {
  constexpr const char* expected = "a 4x4 rigid pose";
  const Array X = array_of(value, name, expected);
  if (X.ndim() != 2 || X.shape(0) != 4 || X.shape(1) != 4) refuse_shape(X, name, expected);
  Pose pose = Pose::Identity();
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 4; ++column) {
      pose.matrix()(row, column) = X.data()[4 * row + column];
    }
  }
  return pose;
}

/// @param rows,columns the size that it must have
template <class Matrix>
void copy_matrix(nb::handle value, const char* name, std::size_t rows, std::size_t columns,
                 Matrix& out) {
  const std::string expected =
      "an array (" + std::to_string(rows) + ", " + std::to_string(columns) + ")";
  const Array found = array_of(value, name, expected.c_str());
  if (found.ndim() != 2 || found.shape(0) != rows || found.shape(1) != columns) {
    refuse_shape(found, name, expected.c_str());
  }
  for (std::size_t i = 0; i < rows; ++i) {
    for (std::size_t k = 0; k < columns; ++k) {
      out(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(k)) =
          found.data()[columns * i + k];
    }
  }
}

}  // namespace

void raise(const Trouble& trouble) {
  if (!trouble || !trouble->has_value()) return;
  std::optional<nb::python_error> raised = std::exchange(*trouble, std::nullopt);
  throw nb::python_error(std::move(*raised));
}

OwnKinematics::OwnKinematics(nb::object object, std::size_t joints, Trouble trouble)
    : object_(std::move(object)),
      joints_(joints),
      trouble_(std::move(trouble)),
      places_links_(nb::hasattr(object_, "X_WL")),
      has_jacobian_(nb::hasattr(object_, "jacobian")),
      has_mass_(nb::hasattr(object_, "mass_matrix")) {
  for (const char* needed : {"update", "X_WT", "tool_jacobian", "gravity_torques"}) {
    if (nb::hasattr(object_, needed)) continue;
    throw nb::type_error((std::string("kinematics: it has no ") + needed +
                          "; see repel.Kinematics for what is needed")
                             .c_str());
  }
}

OwnKinematics::~OwnKinematics() {
  const Held gil;
  object_.reset();
}

template <class Work>
bool OwnKinematics::attempt(const Work& work) const noexcept {
  const Held gil;
  if (!object_.is_valid()) return false;
  try {
    work();
    return true;
  } catch (nb::python_error& error) {
    if (!trouble_->has_value()) trouble_->emplace(std::move(error));
  } catch (const nb::builtin_exception& error) {
    if (!trouble_->has_value()) {
      PyErr_SetString(
          error.type() == nb::exception_type::type_error ? PyExc_TypeError : PyExc_ValueError,
          error.what());
      trouble_->emplace();
    }
  } catch (const std::exception& error) {
    if (!trouble_->has_value()) {
      PyErr_SetString(PyExc_RuntimeError, error.what());
      trouble_->emplace();
    }
  }
  return false;
}

void OwnKinematics::update(std::span<const double> q) noexcept {
  attempt([&] { (void)call_method(object_, "update", to_array(q.data(), {q.size()})); });
}

Pose OwnKinematics::X_WT() const noexcept {
  Pose X = unknown_pose();
  attempt([&] { X = pose_from(call_method(object_, "X_WT"), "X_WT"); });
  return X;
}

void OwnKinematics::tool_jacobian(JacobianRef J) const noexcept {
  J.setConstant(nan);
  attempt(
      [&] { copy_matrix(call_method(object_, "tool_jacobian"), "tool_jacobian", 6, joints_, J); });
}

void OwnKinematics::gravity_torques(std::span<double> out) noexcept {
  std::fill(out.begin(), out.end(), nan);
  attempt([&] {
    const std::vector<double> torques =
        numbers_of(call_method(object_, "gravity_torques"), "gravity_torques", joints_);
    std::copy_n(torques.begin(), std::min(torques.size(), out.size()), out.begin());
  });
}

Pose OwnKinematics::X_WL(int link) const noexcept {
  if (!places_links_) return ArmKinematics::X_WL(link);
  Pose X = unknown_pose();
  attempt([&] { X = pose_from(call_method(object_, "X_WL", nb::int_(link)), "X_WL"); });
  return X;
}

void OwnKinematics::jacobian(int link, const Vec3& p_WQ, JacobianRef J) const noexcept {
  J.setConstant(nan);
  if (!has_jacobian_) return;
  attempt([&] {
    copy_matrix(call_method(object_, "jacobian", nb::int_(link), to_array(p_WQ)), "jacobian", 6,
                joints_, J);
  });
}

bool OwnKinematics::mass_matrix(Eigen::MatrixXd& M) const noexcept {
  if (!has_mass_) return false;
  const auto size = static_cast<Eigen::Index>(joints_);
  M.setConstant(size, size, nan);
  return attempt([&] {
    copy_matrix(call_method(object_, "mass_matrix"), "mass_matrix", joints_, joints_, M);
  });
}

}  // namespace repel::python
