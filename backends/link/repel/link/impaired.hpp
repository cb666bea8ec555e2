// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// A transport made worse, to try a far link nearby.
#pragma once

#include <memory>

#include <repel/link/transport.hpp>
#include <repel/network/elements/channel.hpp>

namespace repel::link {

/// Passes on what `transport` carries, but each packet that is sent is delayed, scattered or lost
/// first, as the channel says: `delay` plus a uniformly distributed part of `jitter`, so that
/// packets overtake each other. What is lost or when is the same for the same seed and number of
/// packets. The clock is that of the thread that uses it: a packet leaves up to one wait late.
/// More than 4096 packets on the way are lost.
/// @throws SetupError for a number out of range
[[nodiscard]] std::unique_ptr<Transport> impaired(std::unique_ptr<Transport> transport,
                                                  const network::ChannelOptions& channel);

}  // namespace repel::link
