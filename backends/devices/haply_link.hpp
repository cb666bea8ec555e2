// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// A WebSocket client that one thread runs for bounded times.
#pragma once

#include <chrono>
#include <cstddef>
#include <memory>
#include <string>

#include <repel/devices/haply_messages.hpp>

namespace repel::devices {

/// A connection to the service. Every function returns within the time it is given, but for the
/// constructor, which looks up the name of the host.
class HaplyLink {
 public:
  enum class State { closed, opening, open };

  /// @throws SetupError if the host is unknown, or the part is not built in
  explicit HaplyLink(const HaplyAddress& address);
  ~HaplyLink();
  HaplyLink(const HaplyLink&) = delete;
  HaplyLink& operator=(const HaplyLink&) = delete;
  HaplyLink(HaplyLink&&) = delete;
  HaplyLink& operator=(HaplyLink&&) = delete;

  /// Begins to connect, after `close`. May throw std::bad_alloc, as may all that follow.
  void open();
  /// Runs the connection until a message has come, it has closed, or the time is over.
  /// @return whether there is a message, which is kept until `drop`
  bool run_until(std::chrono::steady_clock::time_point end);
  [[nodiscard]] const std::string& message() const noexcept;
  void drop();
  /// Sends a text; false if the last is still being sent, or the connection is not open.
  bool send(std::string text);
  /// Runs the connection until nothing is left to be sent, it has closed, or the time is over.
  void flush_until(std::chrono::steady_clock::time_point end);
  /// Closes it without a word.
  void close() noexcept;

  [[nodiscard]] State state() const noexcept;
  /// Why it was closed, for the user.
  [[nodiscard]] const std::string& error() const noexcept;

 private:
  class Connection;
  struct Endpoints;

  void note_end();

  std::unique_ptr<Endpoints> endpoints_;
  std::unique_ptr<Connection> connection_;
  std::string error_;
};

}  // namespace repel::devices
