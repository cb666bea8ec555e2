// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The interface to the system calls on an input device; tests replace it.
#pragma once

#include <chrono>
#include <cstddef>
#include <memory>
#include <span>
#include <string>

namespace repel::devices {

/// The system calls on one open /dev/input/eventN. Each returns what the call returns, or -errno.
class EvdevPort {
 public:
  EvdevPort() = default;
  EvdevPort(const EvdevPort&) = delete;
  EvdevPort& operator=(const EvdevPort&) = delete;
  EvdevPort(EvdevPort&&) = delete;
  EvdevPort& operator=(EvdevPort&&) = delete;
  virtual ~EvdevPort() = default;

  /// ioctl with a pointer: EVIOCGBIT, EVIOCGABS, EVIOCSFF, ...
  virtual int control(unsigned long request, void* argument) noexcept = 0;
  /// ioctl with a number: EVIOCRMFF.
  virtual int control_number(unsigned long request, long argument) noexcept = 0;
  /// Non-blocking; -EAGAIN if there is nothing to read.
  virtual long read(std::span<std::byte> bytes) noexcept = 0;
  /// As write(2): the bytes written; below 0 an error.
  virtual long write(std::span<const std::byte> bytes) noexcept = 0;
  /// Returns once there is something to read, after `wait`, or soon if the device has been removed.
  virtual void wait(std::chrono::milliseconds wait) noexcept = 0;
};

/// Opens the device for reading and writing, non-blocking.
/// @throws SetupError if it cannot be opened, saying what to do
[[nodiscard]] std::unique_ptr<EvdevPort> open_evdev(const std::string& path);

}  // namespace repel::devices
