// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Counts of the link between two programs.
#pragma once

#include <cstdio>
#include <string>

#include <nlohmann/json.hpp>

#include <repel/common/deadline.hpp>
#include <repel/network/remote/link.hpp>

namespace repel::link {
class LinkThread;
}

namespace repel::runs {

struct LinkResult {
  std::string name;        ///< of the transport, for people
  std::string exposure;    ///< warning and advice if other machines can reach it; empty: none can
  bool is_sealed = false;  ///< with a key
  std::int64_t refused =
      0;  ///< with a key: datagrams not by the other side, or not for the first time
  network::RemoteCounts counts;
  std::int64_t foreign = 0;  ///< messages other than packets of this version, or of strangers
  std::int64_t unsent = 0;   ///< packets refused by the transport
  double buffer = 0.0;       ///< [s] at the end
  double silent = 0.0;       ///< [s] at the end
  DurationHistogram round_trips;
  double energy_sent = 0.0, energy_played = 0.0;    ///< [J] of this side
  double partner_sent = 0.0, partner_played = 0.0;  ///< [J] by the other side
};

/// In each tick, once it has been made.
void note_round_trips(const network::RemoteLink& link, LinkResult& result) noexcept;
/// The rest, once the thread of the link has stopped.
void note_link(const network::RemoteLink& link, const link::LinkThread& thread, LinkResult& result);

/// Warns at the start if other machines can reach this side of the link.
void say_exposure(const link::LinkThread& thread);

void print_link(const LinkResult& result, std::FILE* out);
[[nodiscard]] nlohmann::ordered_json link_to_json(const LinkResult& result);

}  // namespace repel::runs
