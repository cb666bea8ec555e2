/// @file
/// A page of the live view without a browser: takes every picture and looks at its tick.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

/// Connects to the live view; waits for it for some seconds.
class Client {
 public:
  /// @throws std::exception if nobody answers
  explicit Client(std::uint16_t port);
  ~Client();

  /// Waits for the next picture and returns its tick.
  [[nodiscard]] std::int64_t next();
  /// The bytes that have come so far.
  [[nodiscard]] std::int64_t bytes() const { return bytes_; }

 private:
  class Socket;
  std::unique_ptr<Socket> socket_;
  std::int64_t bytes_ = 0;
};
