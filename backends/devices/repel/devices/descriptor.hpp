// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// An owning file descriptor.
#pragma once

#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <utility>

namespace repel::devices::detail {

/// Owns a file descriptor and closes it; -1 is none.
class Descriptor {
 public:
  explicit Descriptor(int fd = -1) noexcept : fd_(fd) {}
  Descriptor(Descriptor&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    std::swap(fd_, other.fd_);
    return *this;
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor() { close(); }

  void close() noexcept {
    if (fd_ >= 0) ::close(fd_);
    fd_ = -1;
  }
  /// Waits for input, for at most `wait`, limited to 1 s; of no descriptor for exactly that time.
  void wait(std::chrono::milliseconds wait) const noexcept {
    pollfd watched{fd_, POLLIN, 0};
    const auto milliseconds = std::clamp<std::chrono::milliseconds::rep>(wait.count(), 0, 1000);
    (void)::poll(&watched, 1, static_cast<int>(milliseconds));
  }
  [[nodiscard]] int get() const noexcept { return fd_; }
  [[nodiscard]] bool open() const noexcept { return fd_ >= 0; }

 private:
  int fd_;
};

}  // namespace repel::devices::detail
