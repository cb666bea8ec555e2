// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Two sides of a link in one program, each with its transport and thread.
#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <memory>
#include <thread>
#include <utility>

#include <repel/link/link_thread.hpp>

namespace repel::test {

[[nodiscard]] inline std::chrono::nanoseconds steady() {
  return std::chrono::steady_clock::now().time_since_epoch();
}

/// One side, ticking at 400 Hz by the clock.
struct JoinedSide {
  network::RemoteLink link;
  link::LinkThread thread;

  JoinedSide(std::uint64_t session, std::unique_ptr<link::Transport> transport)
      : link({.session = session, .agreement = 5}), thread(link, std::move(transport)) {
    link.prepare(1, 0.0025);
  }
  void tick(double wave) {
    link.receive(steady());
    (void)link.play(false);
    link.send(network::Vec<network::any_size>::Constant(1, wave), 0.0025);
  }
};

/// Ticks both sides until both are linked and `ticks` more, at most for ten seconds.
inline void tick_both(JoinedSide& one, JoinedSide& other, int ticks, double wave = 1.0) {
  for (int i = 0; i < 4000 && ticks > 0; ++i) {
    one.tick(wave);
    other.tick(wave);
    std::this_thread::sleep_for(std::chrono::microseconds(2500));
    if (one.link.is_linked() && other.link.is_linked()) --ticks;
  }
  EXPECT_EQ(ticks, 0) << "they do not find each other";
}

/// What a link that loses nothing shows after some ticks.
inline void expect_joined(const JoinedSide& side, const JoinedSide& other) {
  const network::RemoteCounts& counts = side.link.counts();
  EXPECT_GT(counts.received, 300);
  EXPECT_EQ(counts.refused, 0);
  EXPECT_EQ(counts.strangers, 0);
  EXPECT_EQ(counts.sessions, 1);
  EXPECT_GT(side.link.round_trips().count(), 100);
  EXPECT_GT(side.link.player().output(), 0.0);
  EXPECT_LE(side.link.player().output(), other.link.energy_sent());
}

}  // namespace repel::test
