// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// A headless client of the live view: receives every frame and reads its tick.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

/// Connects to the live view; retries for some seconds.
class Client {
 public:
  /// @throws std::exception if there is no answer
  explicit Client(std::uint16_t port);
  ~Client();

  /// Waits for the next frame and returns its tick.
  [[nodiscard]] std::int64_t next();
  /// Number of bytes received so far.
  [[nodiscard]] std::int64_t bytes() const { return bytes_; }

 private:
  class Socket;
  std::unique_ptr<Socket> socket_;
  std::int64_t bytes_ = 0;
};
