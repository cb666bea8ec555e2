// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Transport of the packets of a link between two programs.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>

#include <repel/network/remote/packet.hpp>

namespace repel::link {

/// The side of a link.
enum class Side {
  site,     ///< with the robot
  station,  ///< with the operator
};

/// Warning about a transport open to `whom`: they can drive the robot, and what to do about it.
[[nodiscard]] inline std::string exposed_to(const std::string& whom) {
  return "anyone on " + whom +
         " can drive the robot: without a key there is no encryption and no authentication; teleop "
         "key FILE makes one, for --key FILE on both sides";
}

/// Carries packets to the other side and back; any may be lost, doubled or overtaken. For one
/// thread, not that of the tick: these functions make system calls and may allocate.
class Transport {
 public:
  Transport() = default;
  Transport(const Transport&) = delete;
  Transport& operator=(const Transport&) = delete;
  virtual ~Transport() = default;

  /// Sends without waiting. False when it could not be sent: the packet is lost.
  virtual bool send(const network::RemotePacket& packet) noexcept = 0;
  /// Takes a packet that has arrived; false: none. Anything but a packet of this version is dropped
  /// and counted.
  [[nodiscard]] virtual bool receive(network::RemotePacket& packet) noexcept = 0;
  /// Waits until something may have arrived, at most for `longest`.
  virtual void wait(std::chrono::microseconds longest) noexcept = 0;
  /// Its name, for people: "UDP 127.0.0.1:7411".
  [[nodiscard]] virtual std::string name() const = 0;
  /// Warning and advice if other machines can reach this side: a sentence. Empty: none can.
  [[nodiscard]] virtual std::string exposure() const { return {}; }
  /// Count of messages other than packets of this version.
  [[nodiscard]] virtual std::int64_t foreign() const noexcept { return foreign_; }
  /// Whether only those with a key of both sides are heard, and can read what is sent.
  [[nodiscard]] virtual bool is_sealed() const noexcept { return false; }
  /// If it is: count of datagrams that were not by the other side, or not for the first time.
  [[nodiscard]] virtual std::int64_t refused() const noexcept { return 0; }

 protected:
  /// Counts an invalid message.
  void count_foreign() noexcept { ++foreign_; }

 private:
  std::int64_t foreign_ = 0;
};

}  // namespace repel::link
