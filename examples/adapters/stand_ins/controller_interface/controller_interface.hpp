// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Stand-in for the header of this name of ros2_control, with the published signatures of what the
/// adapter uses, in the newer form: reading and writing an interface may fail.
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <rclcpp/logging.hpp>

namespace rclcpp {

class Time {
 public:
  explicit Time(int64_t nanoseconds = 0) : nanoseconds_(nanoseconds) {}
  int64_t nanoseconds() const { return nanoseconds_; }

 private:
  int64_t nanoseconds_;
};

class Duration {
 public:
  explicit Duration(std::chrono::nanoseconds duration) : duration_(duration) {}
  double seconds() const { return std::chrono::duration<double>(duration_).count(); }

 private:
  std::chrono::nanoseconds duration_;
};

}  // namespace rclcpp

namespace rclcpp_lifecycle {

struct State {};

struct LifecycleNode {
  rclcpp::Logger get_logger() const { return {}; }
};

}  // namespace rclcpp_lifecycle

namespace hardware_interface {

/// A number of the hardware. While another thread has it locked, it can be neither read nor set.
struct Handle {
  std::string name;
  double* value;
  const bool* is_locked;
};

class LoanedStateInterface {
 public:
  explicit LoanedStateInterface(Handle handle) : handle_(std::move(handle)) {}
  const std::string& get_name() const { return handle_.name; }
  template <typename T = double>
  [[nodiscard]] std::optional<T> get_optional(unsigned int /*max_tries*/ = 10) const {
    return *handle_.is_locked ? std::nullopt : std::optional<T>(*handle_.value);
  }

 private:
  Handle handle_;
};

class LoanedCommandInterface {
 public:
  explicit LoanedCommandInterface(Handle handle) : handle_(std::move(handle)) {}
  const std::string& get_name() const { return handle_.name; }
  template <typename T>
  [[nodiscard]] bool set_value(const T& value, unsigned int /*max_tries*/ = 10) {
    if (!*handle_.is_locked) *handle_.value = value;
    return !*handle_.is_locked;
  }

 private:
  Handle handle_;
};

}  // namespace hardware_interface

namespace controller_interface {

enum class CallbackReturn : uint8_t { SUCCESS = 97, FAILURE = 98, ERROR = 99 };
enum class return_type : std::uint8_t { OK = 0, ERROR = 1 };
enum class interface_configuration_type : std::uint8_t { ALL = 0, INDIVIDUAL = 1, NONE = 2 };

struct InterfaceConfiguration {
  interface_configuration_type type;
  std::vector<std::string> names = {};
};

class ControllerInterface {
 public:
  virtual ~ControllerInterface() = default;

  virtual InterfaceConfiguration command_interface_configuration() const = 0;
  virtual InterfaceConfiguration state_interface_configuration() const = 0;
  virtual CallbackReturn on_init() = 0;
  virtual CallbackReturn on_configure(const rclcpp_lifecycle::State&) = 0;
  virtual CallbackReturn on_activate(const rclcpp_lifecycle::State&) = 0;
  virtual CallbackReturn on_deactivate(const rclcpp_lifecycle::State&) = 0;
  virtual CallbackReturn on_cleanup(const rclcpp_lifecycle::State&) = 0;
  virtual return_type update(const rclcpp::Time& time, const rclcpp::Duration& period) = 0;

  void assign_interfaces(std::vector<hardware_interface::LoanedCommandInterface>&& commands,
                         std::vector<hardware_interface::LoanedStateInterface>&& states) {
    command_interfaces_ = std::move(commands);
    state_interfaces_ = std::move(states);
  }
  void release_interfaces() {
    command_interfaces_.clear();
    state_interfaces_.clear();
  }
  unsigned int get_update_rate() const { return update_rate_; }
  void set_update_rate(unsigned int rate) { update_rate_ = rate; }  // of the stand-in alone
  std::shared_ptr<rclcpp_lifecycle::LifecycleNode> get_node() const { return node_; }

 protected:
  std::vector<hardware_interface::LoanedCommandInterface> command_interfaces_;
  std::vector<hardware_interface::LoanedStateInterface> state_interfaces_;

 private:
  std::shared_ptr<rclcpp_lifecycle::LifecycleNode> node_ =
      std::make_shared<rclcpp_lifecycle::LifecycleNode>();
  unsigned int update_rate_ = 0;
};

}  // namespace controller_interface
