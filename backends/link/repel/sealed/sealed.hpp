// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// A link on which only those who have its key are heard.
#pragma once

#include <memory>

#include <repel/link/datagrams.hpp>
#include <repel/link/transport.hpp>
#include <repel/sealed/key.hpp>

namespace repel::sealed {

/// Seals packets by authenticated encryption, under keys of their session and direction. A packet
/// of another key, another session or the other direction, a changed one, and one that was there
/// already are refused and counted. Packets may overtake each other by up to 1024 places. Both
/// sides begin by exchanging random numbers, and again once nothing was heard for 0.1 s:
/// docs/two_machines.md has the bytes. Before a sender has proven that it has the key now, nothing
/// is kept of it, and what it sends costs one computation of a few microseconds. A site has up to
/// eight sessions, and answers that one whose packets RemoteLink has heard.
/// @throws SetupError if libsodium cannot be initialised
[[nodiscard]] std::unique_ptr<link::Transport> seal(std::unique_ptr<link::Datagrams> datagrams,
                                                    link::Side side, const Key& key);

}  // namespace repel::sealed
