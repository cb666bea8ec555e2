// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The link between the two programs of a scene: how it is chosen on the command line, and opened.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include <repel/link/transport.hpp>
#include <repel/network/remote/link.hpp>
#include <repel/scene/scene.hpp>

namespace repel::runs {

struct LinkChoice {
  std::optional<link::Side> side;  ///< of this program; none: it has both
  std::string where;         ///< "dds:INTERFACE,PEER", "udp:ADDRESS:PORT"; empty: default_link()
  std::uint32_t domain = 0;  ///< of DDS
  bool is_impaired = false;  ///< what is sent is treated as by the line of the scene
  std::string key_file;      ///< of the key of both sides; empty: that of REPEL_KEY, if it is set
  bool no_key = false;       ///< without a key, also where other machines reach the link
};

/// DDS on the loopback interface where it is built in, else UDP.
[[nodiscard]] std::string default_link();

/// Writes a new key for a link, to a file that does not exist. @throws SetupError otherwise, and
/// where libsodium is not built in
void make_link_key(const std::string& file);

/// What is wrong with a place to link to; empty: nothing.
[[nodiscard]] std::string link_complaint(const std::string& where);

/// @throws SetupError if it is not available, for a file without a key, and for a link without a
/// key that other machines can reach, saying what to do
[[nodiscard]] std::unique_ptr<link::Transport> open_link(const LinkChoice& choice,
                                                         const scene::Scene& scene);

/// Whether the scene can be divided: its network has a line.
[[nodiscard]] bool has_line(const scene::Scene& scene);

/// Of this run of the scene: a session drawn at random; the other side must have the same text of
/// the scene file. @throws SetupError for a scene that cannot be divided
[[nodiscard]] network::RemoteOptions remote_options(const scene::Scene& scene);

}  // namespace repel::runs
