// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// A transport made worse, to try a far link nearby.
#pragma once

#include <memory>

#include <repel/link/transport.hpp>
#include <repel/network/elements/channel.hpp>

namespace repel::link {

/// Passes on the packets of `transport`, but delays or loses each one sent, by the numbers of the
/// channel: `delay` plus a uniformly distributed part of `jitter`, so packets overtake each other.
/// Losses and delays are the same for the same seed and number of packets. It has no thread of its
/// own: a packet leaves up to one wait of its caller late. More than 4096 packets on the way are
/// lost.
/// @throws SetupError for a number out of range
[[nodiscard]] std::unique_ptr<Transport> impaired(std::unique_ptr<Transport> transport,
                                                  const network::ChannelOptions& channel);

}  // namespace repel::link
