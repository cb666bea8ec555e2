// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// What passed over the link between two programs.
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
  std::string name;      ///< of the transport, for people
  std::string exposure;  ///< who else can reach it, and what to do; empty: nobody
  network::RemoteCounts counts;
  std::int64_t foreign = 0;  ///< messages that were no packets of this version, or of others
  std::int64_t unsent = 0;   ///< packets that the transport did not take
  double buffer = 0.0;       ///< [s] at the end
  double silent = 0.0;       ///< [s] at the end
  DurationHistogram round_trips;
  double energy_sent = 0.0, energy_played = 0.0;    ///< [J] of this side
  double partner_sent = 0.0, partner_played = 0.0;  ///< [J] what the other side says
};

/// In each tick, once it has been made.
void note_round_trips(const network::RemoteLink& link, LinkResult& result) noexcept;
/// The rest, once the thread of the link has stopped.
void note_link(const network::RemoteLink& link, const link::LinkThread& thread, LinkResult& result);

/// Says at the start who else can reach this side of the link; nothing where nobody can.
void say_exposure(const link::LinkThread& thread);

void print_link(const LinkResult& result, std::FILE* out);
[[nodiscard]] nlohmann::ordered_json link_to_json(const LinkResult& result);

}  // namespace repel::runs
