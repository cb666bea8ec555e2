// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Stand-in for <rclcpp/logging.hpp> of ROS 2.
#pragma once

#include <cstdio>

namespace rclcpp {

struct Logger {};

}  // namespace rclcpp

#define RCLCPP_ERROR(logger, ...)      \
  do {                                 \
    static_cast<void>(logger);         \
    std::fprintf(stderr, __VA_ARGS__); \
    std::fputc('\n', stderr);          \
  } while (false)
