// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// A thread that reads a device and sends it forces: the tick never waits for it.
#pragma once

#include <pthread.h>

#include <chrono>
#include <cmath>
#include <memory>
#include <stop_token>
#include <string_view>
#include <thread>
#include <utility>

#include <repel/base/mailbox.hpp>
#include <repel/base/setup_error.hpp>
#include <repel/devices/clock.hpp>
#include <repel/devices/master_device.hpp>

namespace repel::devices {

/// The tick's end of a device. Its functions must be called from one thread. They never block,
/// never fail and make no system call.
class DeviceLink {
 public:
  static constexpr double alive_for = 0.25;  ///< [s] a thread that posts nothing for longer hangs

  DeviceLink() : felt_(Felt{}) {}

  /// Advances by one period.
  /// @param period [s] since the last call
  /// @return the newest reading. If the thread has posted nothing for longer than `alive_for`, by
  ///   the sum of the periods: fault, silent and at rest. Valid until the next call.
  [[nodiscard]] const Measured& measured(double period) noexcept {
    if (measured_.take()) {
      now_ = measured_.newest();
      silent_for_ = 0.0;
      return now_;
    }
    if (period > 0.0) silent_for_ += period;
    if (silent_for_ > alive_for) {
      const std::uint64_t count = now_.count;
      now_ = Measured::of_lost("the thread of the device does not answer");
      now_.count = count;
    }
    return now_;
  }

  /// [s] since the thread last posted, by the sum of the periods.
  [[nodiscard]] double silent_for() const noexcept { return silent_for_; }

  /// Sets the force feedback: torque on the lever [N m] and wrench on the tool [N, N m], about its
  /// origin, in W. Zero if not finite, or if not renewed in time.
  void servo_cf(double lever_torque, const Wrench& tool_force) noexcept {
    const bool finite = std::isfinite(lever_torque) && is_finite(tool_force);
    felt_.draft() = finite ? Felt{lever_torque, tool_force} : Felt{};
    felt_.post();
  }

 protected:
  ~DeviceLink() = default;

  Mailbox<Measured> measured_{Measured{}};  ///< thread to tick
  Mailbox<Felt> felt_;                      ///< tick to thread

 private:
  Measured now_;
  double silent_for_ = 0.0;  // [s]
};

/// Times of the thread, and what it does first.
struct DeviceThreadOptions {
  std::chrono::milliseconds wait{10};        ///< longest time between two readings
  std::chrono::milliseconds felt_for{100};   ///< a force not renewed for this long is removed
  const char* thread_name = "repel device";  ///< as shown by `ps -L`, up to 15 characters
  void (*begin)() noexcept = nullptr;        ///< called first in the thread, to set its priority
};

/// Owns a device and the only thread that accesses it from now on. The thread posts a numbered
/// reading at least every `wait` and sends the newest force after each; at its end it sends zero
/// force.
template <MasterDevice Device>
class DeviceThread : public DeviceLink {
 public:
  /// @throws SetupError if a time is out of range
  explicit DeviceThread(std::unique_ptr<Device> device, const DeviceThreadOptions& options = {})
      : device_(std::move(device)), options_(options) {
    checked("wait", static_cast<double>(options.wait.count()), 1.0, 100.0, "ms");
    checked("felt for", static_cast<double>(options.felt_for.count()), 1.0, 10000.0, "ms");
    thread_ = std::jthread([this](const std::stop_token& stop) { run(stop); });
  }

  /// As the device calls itself.
  [[nodiscard]] std::string_view name() const noexcept { return device_->name(); }

  /// Ends the thread within `wait`. After that the device shows no force and is not read.
  void stop() {
    thread_.request_stop();
    if (thread_.joinable()) thread_.join();
  }

 private:
  void run(const std::stop_token& stop) noexcept {
    (void)pthread_setname_np(pthread_self(), options_.thread_name);
    if (options_.begin != nullptr) options_.begin();
    std::uint64_t count = 0;
    while (!stop.stop_requested()) {
      Measured& draft = measured_.draft();
      draft = device_->read(options_.wait);
      draft.count = ++count;
      measured_.post();
      show();
    }
    device_->servo_cf(0.0, {});
  }

  void show() noexcept {
    const std::chrono::nanoseconds now = steady_now();
    if (felt_.take()) {
      renewed_at_ = now;
      shows_ = true;
      device_->servo_cf(felt_.newest().lever_torque, felt_.newest().tool_force);
    } else if (shows_ && now - renewed_at_ > options_.felt_for) {
      shows_ = false;
      device_->servo_cf(0.0, {});
    }
  }

  std::unique_ptr<Device> device_;
  DeviceThreadOptions options_;
  std::chrono::nanoseconds renewed_at_{0};  // used by the thread only
  bool shows_ = false;                      // used by the thread only
  std::jthread thread_;  // last, so that it ends before the other members are destroyed
};

}  // namespace repel::devices
