// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// How a run is watched and driven: its live view and its input device.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <repel/cell/cell.hpp>
#include <repel/network/operator.hpp>
#include <repel/runs/options/hand_track.hpp>
#include <repel/runs/options/link_choice.hpp>

namespace repel::runs {

/// How a run is watched and driven.
struct SessionOptions {
  bool view = false;
  std::string listen = "127.0.0.1:8448";  ///< ADDRESS:PORT of the live view
  std::optional<bool> open{};             ///< in a browser of this machine; none: if at a terminal
  std::string page;                       ///< folder of the files of the page; empty: found
  std::string device;                     ///< input device; empty: none
  std::string secret_file;                ///< its first line is the secret of pages; empty: none
  std::string secret_env;                 ///< environment variable with the secret, instead
  std::string secret;                     ///< the secret, once settle_secret has read it
  std::string tls;                        ///< "self" or CERTIFICATE,KEY; empty: pages are plain
  bool plain = false;                     ///< pages may be plain beyond this machine
  bool view_only = false;                 ///< pages may only watch
  bool page_drives = false;               ///< pages may override the device
  LinkChoice link;                        ///< to the other side of the scene
  /// By arm, what its operator does in place of the script; empty, or the last ones left out: that.
  std::vector<HandTrack> tracks{};
  /// Called after each tick, outside of its measured time, with the records of all arms; null: not.
  std::function<void(const Cell&, std::span<const TickRecord* const>)> on_tick{};
  /// For each arm the command of its operator in the next tick, in place of the script; without a
  /// value: the script goes on. `on_tick` may change them. Empty: every arm has its script.
  std::span<const std::optional<network::Command>> hands{};
};

}  // namespace repel::runs
