// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Stand-in for <franka/exception.h> of libfranka: the exceptions that the adapter meets.
#pragma once

#include <stdexcept>

namespace franka {

struct Exception : std::runtime_error {
  using std::runtime_error::runtime_error;
};

struct ControlException : Exception {
  using Exception::Exception;
};

}  // namespace franka
