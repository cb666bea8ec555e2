// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The messages of the Haply Inverse Service. Does no I/O.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>

#include <repel/base/types.hpp>

namespace repel::devices {

/// One state update of the service, in the axes of the device: x to the right, y away from the
/// operator, z up (docs.haply.co, Basis Permutation).
struct HaplyState {
  std::string device_id{};  ///< of the handle; empty: the service has none
  Vec3 position{0, 0, 0};   ///< [m] of the handle
  Vec3 velocity{0, 0, 0};   ///< [m/s]
  bool calibrated = true;   ///< false: the service says that the position cannot be trusted
  bool has_grip = false;    ///< a VerseGrip is there; what follows is its own
  Eigen::Quaterniond R_DG = Eigen::Quaterniond::Identity();  ///< unit, of the grip
  std::array<bool, 3> buttons{};                             ///< a, b, c; down
};

/// Bounds of what a working service says.
struct HaplyBounds {
  static constexpr std::size_t text = 1 << 18;      ///< [bytes] of a message
  static constexpr std::size_t devices = 16;        ///< of one kind
  static constexpr std::size_t id = 64;             ///< characters: letters, digits, - and _
  static constexpr double position = 1.0;           ///< [m] from the origin, in each axis
  static constexpr double velocity = 20.0;          ///< [m/s] in each axis
  static constexpr double quaternion_error = 0.05;  ///< of its length
};

/// Reads a state update, or the inventory with which the service greets:
///
///     {"inverse3": [{"device_id": "049D", "status": {"calibrated": true},
///                    "state": {"cursor_position": {"x": 0.0, "y": -0.1, "z": 0.1},
///                              "cursor_velocity": {"x": 0.0, "y": 0.0, "z": 0.0}}}],
///      "wireless_verse_grip": [{"device_id": "61576",
///          "state": {"orientation": {"w": 1.0, "x": 0.0, "y": 0.0, "z": 0.0},
///                    "buttons": {"a": false, "b": false, "c": false}}}]}
///
/// The first device of a kind counts, of grips a wireless one before a wired one (`verse_grip`,
/// whose only button is `button`, here a). Other keys are ignored. Allocates.
/// @return nullptr, or static text: what is wrong. `state` is then undefined. Wrong are: text too
///   long or not JSON, the same key twice in an object, the same handle twice, a value missing, of
///   another type or out of bounds.
[[nodiscard]] const char* read_haply(std::string_view text, HaplyState& state) noexcept;

/// The first message of a client: its name, and a request for the axes of `HaplyState`, as an
/// earlier client may have changed them. Later ones leave `session` away.
enum class HaplyTurn { first, later };

/// A command of a force on the handle [N], in the axes of the device; a number beyond 1e6 is
/// sent as zero. The service answers each with a state update. Without a `device_id`: a question
/// for all devices.
[[nodiscard]] std::string haply_command(std::string_view device_id, const Vec3& force,
                                        HaplyTurn turn);

/// Where the service listens.
struct HaplyAddress {
  std::string host = "localhost";  ///< name or address
  std::string port = "10001";      ///< its number
};

/// Of "ws://HOST[:PORT]"; empty if it is none. IPv6 addresses in brackets.
[[nodiscard]] std::optional<HaplyAddress> haply_address(std::string_view url);

}  // namespace repel::devices
