// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// A transport within the program, for tests.
#pragma once

#include <chrono>
#include <deque>
#include <mutex>
#include <string>
#include <thread>

#include <repel/link/transport.hpp>

namespace repel::test {

/// A path within the program.
struct Path {
  std::mutex mutex;
  std::deque<network::RemotePacket> packets;
};

class Within final : public link::Transport {
 public:
  Within(Path& out, Path& in) : out_(out), in_(in) {}
  bool send(const network::RemotePacket& packet) noexcept override {
    const std::scoped_lock lock(out_.mutex);
    out_.packets.push_back(packet);
    return true;
  }
  bool receive(network::RemotePacket& packet) noexcept override {
    const std::scoped_lock lock(in_.mutex);
    if (in_.packets.empty()) return false;
    packet = in_.packets.front();
    in_.packets.pop_front();
    return true;
  }
  void wait(std::chrono::microseconds longest) noexcept override {
    std::this_thread::sleep_for(longest);
  }
  [[nodiscard]] std::string name() const override { return "within"; }

 private:
  Path& out_;
  Path& in_;
};

}  // namespace repel::test
