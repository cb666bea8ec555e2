// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Errors of MuJoCo as exceptions.
#pragma once

namespace repel::mujoco::detail {

/// Sets the error and warning handlers of MuJoCo, which belong to the whole process, and keeps
/// those that are there. Set-up only.
void set_handlers();

/// While one exists, what MuJoCo reports as an error in this thread is thrown as a
/// std::runtime_error, and its warnings are dropped.
class ErrorsThrown {
 public:
  ErrorsThrown() noexcept;
  ~ErrorsThrown();
  ErrorsThrown(const ErrorsThrown&) = delete;
  ErrorsThrown& operator=(const ErrorsThrown&) = delete;
};

}  // namespace repel::mujoco::detail
