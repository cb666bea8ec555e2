// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Two sides of a link in one program, each with its transport and thread.
#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <memory>
#include <thread>
#include <utility>

#include <repel/common/deadline.hpp>
#include <repel/link/link_thread.hpp>

namespace repel::test {

[[nodiscard]] inline std::chrono::nanoseconds steady() {
  return std::chrono::steady_clock::now().time_since_epoch();
}

/// One side, ticking at 400 Hz by the clock.
struct JoinedSide {
  network::RemoteLink link;
  link::LinkThread thread;
  DurationHistogram round_trips;

  JoinedSide(std::uint64_t session, std::unique_ptr<link::Transport> transport)
      : link({.session = session, .agreement = 5}), thread(link, std::move(transport)) {
    link.prepare(1, 0.0025);
  }
  void tick(double wave) {
    link.receive(steady());
    for (const std::chrono::nanoseconds each : link.round_trips()) round_trips.record(each);
    (void)link.play(false);
    link.send(network::Vec<network::any_size>::Constant(1, wave), 0.0025);
  }
};

/// Ticks both sides until both are linked and `ticks` more, and until both have received three of
/// four packets of so many; at most for a minute. A transport may lose what waits while the machine
/// stands still.
inline void tick_both(JoinedSide& one, JoinedSide& other, int ticks, double wave = 1.0) {
  const auto until = steady() + std::chrono::minutes(1);
  const auto has_heard = [&](const JoinedSide& side) {
    return 4 * side.link.counts().received >= 3 * ticks;
  };
  int left = ticks;
  while (left > 0 || !has_heard(one) || !has_heard(other)) {
    ASSERT_LT(steady(), until) << "they do not find each other";
    one.tick(wave);
    other.tick(wave);
    std::this_thread::sleep_for(std::chrono::microseconds(2500));
    if (one.link.is_linked() && other.link.is_linked()) --left;
  }
}

/// What a link shows after 400 ticks.
inline void expect_joined(const JoinedSide& side, const JoinedSide& other) {
  const network::RemoteCounts& counts = side.link.counts();
  EXPECT_GE(counts.received, 300);
  EXPECT_EQ(counts.refused, 0);
  EXPECT_EQ(counts.strangers, 0);
  EXPECT_EQ(counts.sessions, 1);
  EXPECT_GT(side.round_trips.count(), 100);
  EXPECT_GT(side.link.player().output(), 0.0);
  EXPECT_LE(side.link.player().output(), other.link.energy_sent());
}

}  // namespace repel::test
