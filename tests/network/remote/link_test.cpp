// SPDX-License-Identifier: BSD-3-Clause
#include <repel/network/remote/link.hpp>

#include <gtest/gtest.h>

#include <limits>

#include <repel/base/setup_error.hpp>

#include "network/drawn.hpp"
#include "network/remote/relay.hpp"

namespace repel::network {
namespace link_test {

using test::at;
using test::period;
using test::Relay;
using test::RelayPath;

constexpr unsigned seed = 40;

/// Two sides and the paths between them.
struct Pair {
  RemoteLink here{{.session = 11, .agreement = 5}};
  RemoteLink there{{.session = 22, .agreement = 5}};
  Relay forth{seed}, back{seed + 1};
  int tick = 0;

  Pair() {
    here.prepare(1, period);
    there.prepare(1, period);
  }
  [[nodiscard]] double now() const { return period * tick; }
  void step(RemoteLink& one, RemoteLink& other, const RelayPath& path, double wave = 1.0) {
    ++tick;
    // The clocks of two machines have nothing in common.
    one.receive(at(now()));
    other.receive(at(1e5 + now()));
    for (RemoteLink* side : {&one, &other}) {
      (void)side->play(false);
      side->send(Vector::Constant(1, wave), period);
    }
    forth.carry(one, other, path, now());
    back.carry(other, one, path, now());
  }
};

TEST(RemoteLink, CountsWhatArrivesAndWhatDoesNot) {
  Pair pair;
  const RelayPath path{.delay = 0.02, .jitter = 0.01, .loss = 0.1, .copies = 0.05};
  for (int i = 0; i < 8000; ++i) pair.step(pair.here, pair.there, path);
  for (const RemoteLink* side : {&pair.here, &pair.there}) {
    const RemoteCounts& counts = side->counts();
    EXPECT_EQ(counts.sent, 8000);
    EXPECT_NEAR(static_cast<double>(counts.lost), 800.0, 120.0) << "seed " << seed;
    EXPECT_NEAR(static_cast<double>(counts.received + counts.lost), 8000.0, 20.0);
    EXPECT_GT(counts.overtaken, 1000);
    EXPECT_NEAR(static_cast<double>(counts.doubled), 0.05 * 0.9 * 8000.0, 100.0);
    EXPECT_EQ(counts.refused, 0);
    EXPECT_EQ(counts.strangers, 0);
    EXPECT_EQ(counts.sessions, 1);
    EXPECT_TRUE(side->is_linked());
    EXPECT_LT(side->silent_for(), 0.05);
  }
}

TEST(RemoteLink, TheAccountsOfBothSidesAgree) {
  Pair pair;
  const RelayPath path{.delay = 0.03, .jitter = 0.02, .loss = 0.05};
  for (int i = 0; i < 4000; ++i) {
    pair.step(pair.here, pair.there, path, std::sin(0.05 * i));
    EXPECT_LE(pair.there.player().output(), pair.here.energy_sent() * (1.0 + 1e-12));
    EXPECT_LE(pair.here.player().output(), pair.there.energy_sent() * (1.0 + 1e-12));
    EXPECT_LE(pair.here.partner_played(), pair.here.energy_sent() * (1.0 + 1e-12));
    EXPECT_LE(pair.here.partner_sent(), pair.there.energy_sent());
  }
  EXPECT_GT(pair.here.partner_played(), 0.9 * pair.here.energy_sent());
}

TEST(RemoteLink, MeasuresTheRoundTripByItsOwnClock) {
  Pair pair;
  std::vector<double> trips;  // [s]
  for (int i = 0; i < 4000; ++i) {
    pair.step(pair.here, pair.there, {.delay = 0.03});
    for (const std::chrono::nanoseconds each : pair.here.round_trips()) {
      trips.push_back(std::chrono::duration<double>(each).count());
    }
  }
  ASSERT_GT(trips.size(), 3000U);
  ASSERT_LE(trips.size(), 4000U) << "each is told once";
  std::sort(trips.begin(), trips.end());
  EXPECT_NEAR(trips[trips.size() / 2], 0.06, 2.0 * period + 0.001);
  pair.here.receive(at(pair.now()));
  pair.here.receive(at(pair.now()));
  EXPECT_TRUE(pair.here.round_trips().empty()) << "a tick without packets";
}

TEST(RemoteLink, CarriesTheValuesOfTheProgram) {
  Pair pair;
  pair.here.values()[63] = 4.5;
  for (int i = 0; i < 20; ++i) pair.step(pair.here, pair.there, {.delay = 0.01});
  EXPECT_EQ(pair.there.heard()[63], 4.5);
  EXPECT_EQ(pair.here.heard()[63], 0.0);
}

TEST(RemoteLink, MeetsASideThatBeginsAnew) {
  Pair pair;
  const RelayPath path{.delay = 0.02};
  for (int i = 0; i < 400; ++i) pair.step(pair.here, pair.there, path, 10.0);
  RemoteLink again({.session = 33, .agreement = 5});
  again.prepare(1, period);
  // At once it is a stranger, since the side before was heard just now.
  pair.step(pair.here, again, path, 0.5);
  double largest = 0.0;
  for (int i = 0; i < 400; ++i) {
    pair.step(pair.here, again, path, 0.5);
    if (i > 20) largest = std::max(largest, std::abs(pair.here.play(false)(0)));
  }
  EXPECT_EQ(pair.here.counts().sessions, 2);
  EXPECT_GT(pair.here.counts().strangers, 10);
  EXPECT_LE(largest, 0.6);
  EXPECT_LE(pair.here.player().output(), again.energy_sent());
  EXPECT_EQ(again.counts().sessions, 1);
  EXPECT_NEAR(again.partner_sent(), pair.here.energy_sent(), 3.0);
  // Its ghosts are not listened to, even when the new one is silent.
  pair.tick += 400;
  pair.step(pair.here, pair.there, path);
  for (int i = 0; i < 40; ++i) pair.step(pair.here, pair.there, path);
  EXPECT_EQ(pair.here.counts().sessions, 2);
}

TEST(RemoteLink, DoesNotListenToOthers) {
  Pair pair;
  for (int i = 0; i < 100; ++i) pair.step(pair.here, pair.there, {.delay = 0.01});
  RemotePacket packet;
  packet.session = 22;
  packet.agreement = 6;
  packet.sequence = 1000;
  packet.sent = 1;
  const auto give = [&] {
    pair.here.incoming().draft() = packet;
    ASSERT_TRUE(pair.here.incoming().post());
    pair.here.receive(at(pair.now()));
  };
  const RemoteCounts before = pair.here.counts();
  give();
  EXPECT_EQ(pair.here.counts().strangers, before.strangers + 1);
  packet.agreement = 5;
  packet.session = 44;
  give();
  EXPECT_EQ(pair.here.counts().strangers, before.strangers + 2);
  packet.session = 11;  // its own, reflected
  give();
  EXPECT_EQ(pair.here.counts().refused, before.refused + 1);
  packet.session = 22;
  packet.sum[0] = std::numeric_limits<double>::quiet_NaN();
  give();
  EXPECT_EQ(pair.here.counts().refused, before.refused + 2);
  packet.sum[0] = 0.0;
  give();  // newer, and sent earlier
  EXPECT_EQ(pair.here.counts().refused, before.refused + 3);
}

/// A side and what is posted to it.
struct Target {
  RemoteLink link{{.session = 11, .agreement = 5}};
  int tick = 0;

  Target() {
    link.prepare(1, period);
    link.set_most_power(100.0);
  }
  void step(std::initializer_list<const RemotePacket*> packets) {
    for (const RemotePacket* packet : packets) {
      link.incoming().draft() = *packet;
      ASSERT_TRUE(link.incoming().post());
    }
    link.receive(at(period * ++tick));
    wave = link.play(false)(0);
    EXPECT_TRUE(std::isfinite(wave));
    link.send(Vector::Zero(1), period);
    while (link.outgoing().front() != nullptr) link.outgoing().pop();
  }
  double wave = 0.0;
};
RemotePacket packet_of(std::uint64_t session) {
  RemotePacket packet;
  packet.session = session;
  packet.agreement = 5;
  return packet;
}
void advance(RemotePacket& packet, double wave) {
  ++packet.sequence;
  packet.sent += 2500000;
  packet.sum[0] += period * wave;
  packet.energy_sent += period * wave * wave;
}

TEST(RemoteLink, ClosesAPartnerThatGoesOnBeyondTheBoundsAndHearsASoundOneAtOnce) {
  for (const double wave : {15.0, 50.0, 1e3, 1e155}) {
    SCOPED_TRACE(wave);
    Target target;
    RemotePacket wrong = packet_of(66), sound = packet_of(77);
    int closed_at = 0, heard_at = 0;
    for (int i = 1; i <= 600 && heard_at == 0; ++i) {
      advance(wrong, wave);
      advance(sound, 2.0);
      // The false one is first in every tick.
      target.step({&wrong, &sound});
      if (closed_at == 0 && target.link.counts().closed > 0) closed_at = i;
      if (std::abs(target.wave - 2.0) < 1e-9) heard_at = i;
    }
    // An absurd one is never met, or not heard; the others are given 0.1 s.
    if (wave < 1e100) {
      EXPECT_GT(closed_at, 20);
    }
    EXPECT_LT(closed_at, 80);
    EXPECT_GT(heard_at, 0);
    EXPECT_LT(heard_at, closed_at + 20);
    EXPECT_EQ(target.link.counts().closed, wave < 1e100 ? 1 : 0);
    EXPECT_TRUE(target.link.is_linked());
    // It does not come back.
    const std::int64_t sessions = target.link.counts().sessions;
    for (int i = 0; i < 200; ++i) {
      advance(wrong, 1.0);
      target.step({&wrong});
    }
    EXPECT_EQ(target.link.counts().sessions, sessions);
  }
}

TEST(RemoteLink, NothingThatAPacketSaysStaysInItsSums) {
  constexpr double huge = 1e300;
  for (const bool is_met : {false, true}) {
    Target target;
    RemotePacket wrong = packet_of(66);
    for (int i = 0; i < 40; ++i) {
      advance(wrong, 1.0);
      if (is_met) target.step({&wrong});
    }
    RemotePacket poison = wrong;
    poison.energy_sent = huge;
    poison.energy_played = huge;
    poison.heard = 11;
    poison.heard_sent = poison.heard_for = std::numeric_limits<std::int64_t>::max();
    for (double& x : poison.sum) x = 1e308;
    for (int i = 0; i < 20; ++i) {
      advance(wrong, 1.0);
      ++poison.sequence;
      poison.sent += 2500000;
      target.step({&poison});
      EXPECT_LE(target.link.partner_sent(), 1.0);
    }
    EXPECT_EQ(target.link.counts().refused, 20);
    RemotePacket sound = packet_of(77);
    for (int i = 0; i < 60; ++i) {
      advance(sound, 2.0);
      target.step({&sound});
    }
    EXPECT_NEAR(target.wave, 2.0, 1e-9);
    EXPECT_EQ(target.link.counts().sessions, is_met ? 2 : 1);
    EXPECT_LE(target.link.player().output(), sound.energy_sent);
  }
}

TEST(RemoteLink, TimesAndNumbersBeyondAnyRunAreNoPackets) {
  Target target;
  RemotePacket packet = packet_of(66);
  constexpr std::int64_t most = std::numeric_limits<std::int64_t>::max();
  advance(packet, 1.0);
  packet.heard = 11;
  packet.heard_sent = packet.heard_for = most;  // their sum is no number
  target.step({&packet});
  EXPECT_TRUE(target.link.round_trips().empty());
  packet.sequence = most;
  target.step({&packet});
  EXPECT_EQ(target.link.counts().refused, 1);
}

TEST(RemoteLink, BeforeItReceivesNothingIsSent) {
  RemoteLink link({.session = 1});
  link.prepare(1, period);
  link.send(Vector::Constant(1, 1.0), period);
  EXPECT_EQ(link.outgoing().front(), nullptr);
  EXPECT_THROW(RemoteLink({.session = 0}), SetupError);
}

TEST(RemoteLink, WithNobodyToTakeItsPacketsItGoesOn) {
  RemoteLink link({.session = 1});
  link.prepare(1, period);
  for (int i = 1; i < 1000; ++i) {
    link.receive(at(i * period));
    EXPECT_EQ(link.play(false)(0), 0.0);
    link.send(Vector::Constant(1, 1.0), period);
  }
  EXPECT_NEAR(link.silent_for(), 998 * period, 1e-6);
  EXPECT_FALSE(link.is_linked());
  EXPECT_GT(link.outgoing().dropped(), 900);
}

}  // namespace link_test
}  // namespace repel::network
