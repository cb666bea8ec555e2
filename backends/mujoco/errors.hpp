// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Errors of MuJoCo as exceptions.
#pragma once

namespace repel::mujoco::detail {

/// Sets the error and warning handlers of MuJoCo and keeps the earlier ones. They are of the whole
/// process. Set-up only.
void set_handlers();

/// While one exists, an error of MuJoCo in this thread is thrown as a std::runtime_error. Its
/// warnings are dropped.
class ErrorsThrown {
 public:
  ErrorsThrown() noexcept;
  ~ErrorsThrown();
  ErrorsThrown(const ErrorsThrown&) = delete;
  ErrorsThrown& operator=(const ErrorsThrown&) = delete;
};

}  // namespace repel::mujoco::detail
