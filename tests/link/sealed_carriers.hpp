// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// What is true of a sealed link over every carrier; a suite gives the carriers.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <functional>
#include <memory>
#include <mutex>
#include <random>
#include <thread>
#include <utility>
#include <vector>

#include <repel/sealed/sealed.hpp>

#include "link/datagrams_within.hpp"
#include "link/joined.hpp"

namespace repel::test {

inline sealed::Key key_of(std::uint8_t seed) {
  sealed::Key key;
  key.fill(seed);
  return key;
}

/// What passed by a side.
struct Recording {
  std::mutex mutex;
  std::vector<Bytes> sent;

  [[nodiscard]] std::vector<Bytes> copy() {
    const std::scoped_lock lock(mutex);
    return sent;
  }
};

/// Passes datagrams on, and records those that are sent.
class Tapped final : public link::Datagrams {
 public:
  Tapped(std::unique_ptr<link::Datagrams> datagrams, Recording& recording)
      : datagrams_(std::move(datagrams)), recording_(recording) {}
  bool send(std::span<const std::byte, link::sealed_size> bytes,
            const link::Origin& to) noexcept override {
    const std::scoped_lock lock(recording_.mutex);
    recording_.sent.emplace_back(bytes.begin(), bytes.end());
    return datagrams_->send(bytes, to);
  }
  std::ptrdiff_t receive(std::span<std::byte> bytes, link::Origin& from) noexcept override {
    return datagrams_->receive(bytes, from);
  }
  void wait(std::chrono::microseconds longest) noexcept override { datagrams_->wait(longest); }
  [[nodiscard]] std::string name() const override { return datagrams_->name(); }

 private:
  std::unique_ptr<link::Datagrams> datagrams_;
  Recording& recording_;
};

/// Opens both sides of a carrier: the site first.
struct SealedCarrier {
  const char* name;
  std::function<std::unique_ptr<link::Datagrams>(link::Side)> (*make)();
};

class SealedOver : public ::testing::TestWithParam<SealedCarrier> {
 protected:
  [[nodiscard]] std::unique_ptr<link::Transport> site(std::uint8_t key = 1) {
    return sealed::seal(open(link::Side::site), link::Side::site, key_of(key));
  }
  [[nodiscard]] std::unique_ptr<link::Transport> station(std::uint8_t key = 1) {
    return sealed::seal(open(link::Side::station), link::Side::station, key_of(key));
  }
  /// A station whose datagrams are recorded.
  [[nodiscard]] std::unique_ptr<link::Transport> station(Recording& recording) {
    return sealed::seal(std::make_unique<Tapped>(open(link::Side::station), recording),
                        link::Side::station, key_of(1));
  }
  /// Sends as a station does, without the key.
  static void throw_at_site(link::Datagrams& attacker, const Bytes& bytes) {
    (void)attacker.send(std::span(bytes).first<link::sealed_size>(), {});
  }

  std::function<std::unique_ptr<link::Datagrams>(link::Side)> open = GetParam().make();
};

TEST_P(SealedOver, JoinsTwoSides) {
  JoinedSide here(1, site());
  JoinedSide there(2, station());
  here.link.values()[0] = 4.5;
  tick_both(here, there, 400);
  expect_joined(here, there);
  expect_joined(there, here);
  EXPECT_EQ(there.link.heard()[0], 4.5);
  for (JoinedSide* side : {&here, &there}) {
    EXPECT_TRUE(side->thread.is_sealed());
    EXPECT_NE(side->thread.name().find("sealed"), std::string::npos);
    EXPECT_EQ(side->thread.exposure(), "");
    side->thread.stop();
    EXPECT_EQ(side->thread.refused(), 0);
  }
}

TEST_P(SealedOver, MeetsASideThatBeginsAnew) {
  auto here = std::make_unique<JoinedSide>(1, site());
  auto there = std::make_unique<JoinedSide>(2, station());
  tick_both(*here, *there, 50);
  there = std::make_unique<JoinedSide>(3, station());
  tick_both(*here, *there, 50);
  EXPECT_EQ(here->link.counts().sessions, 2);
  here.reset();
  here = std::make_unique<JoinedSide>(4, site());
  tick_both(*here, *there, 50);
  EXPECT_EQ(there->link.counts().sessions, 2);
}

TEST_P(SealedOver, AnotherKeyIsNotHeard) {
  JoinedSide here(1, site(1));
  JoinedSide there(2, station(2));
  for (int i = 0; i < 100; ++i) {
    here.tick(1.0);
    there.tick(1.0);
    std::this_thread::sleep_for(std::chrono::microseconds(2500));
  }
  EXPECT_FALSE(here.link.is_linked());
  EXPECT_FALSE(there.link.is_linked());
  here.thread.stop();
  EXPECT_GT(here.thread.refused(), 0);
}

// With the key, and of another scene: as over a link without one, the strangers are counted, and
// the partner is met although they came first.
TEST_P(SealedOver, AnotherSceneIsStillTold) {
  JoinedSide here(1, site());
  const auto stranger = station();
  network::RemotePacket packet;
  packet.session = 9;
  packet.agreement = 6;
  const auto knock = [&] {
    network::RemotePacket none;
    (void)stranger->receive(none);
    ++packet.sequence;
    packet.sent += 2500000;
    (void)stranger->send(packet);
  };
  const auto until = steady() + std::chrono::minutes(1);
  while (here.link.counts().strangers < 20 && steady() < until) {
    knock();
    here.tick(1.0);
    std::this_thread::sleep_for(std::chrono::microseconds(2500));
  }
  EXPECT_FALSE(here.link.is_linked());
  JoinedSide there(2, station());
  int both = 0;
  while (both < 50 && steady() < until) {
    knock();
    here.tick(1.0);
    there.tick(1.0);
    std::this_thread::sleep_for(std::chrono::microseconds(2500));
    both += here.link.is_linked() && there.link.is_linked() ? 1 : 0;
  }
  EXPECT_EQ(both, 50);
  EXPECT_EQ(here.link.counts().sessions, 1);
  EXPECT_GE(here.link.counts().strangers, 20);
}

TEST_P(SealedOver, ARecordedSessionPlayedAgainIsNotHeard) {
  Recording recording;
  {
    JoinedSide here(1, site());
    JoinedSide there(2, station(recording));
    tick_both(here, there, 150);  // three of four come at least
  }
  const std::vector<Bytes> all = recording.copy();
  ASSERT_GT(all.size(), 100U);
  const auto attacker = open(link::Side::station);
  const auto fresh = site();
  network::RemotePacket packet;
  for (const Bytes& bytes : all) {
    throw_at_site(*attacker, bytes);
    fresh->wait(std::chrono::milliseconds(1));
    EXPECT_FALSE(fresh->receive(packet));
  }
  EXPECT_GT(fresh->refused(), 0);
}

// Between two packets of a live partner come forty of one who has no key: noise, false hellos,
// false packets of the live session, and true datagrams played again.
TEST_P(SealedOver, AFloodWithoutTheKeyTakesNothingFromALivePartner) {
  constexpr unsigned seed = 40;
  std::mt19937_64 random(seed);
  Recording recording;
  const auto here = site();
  const auto there = station(recording);
  const auto attacker = open(link::Side::station);
  network::RemotePacket packet, come;
  packet.session = 2;
  const auto until = steady() + std::chrono::minutes(1);
  // Sends one and looks for it.
  const auto is_heard = [&](int tries) {
    ++packet.sequence;
    (void)there->receive(come);
    (void)there->send(packet);
    for (int i = 0; i < tries; ++i) {
      while (here->receive(come)) {
        EXPECT_EQ(come.session, 2U);
        if (come.sequence == packet.sequence) return true;
      }
      here->wait(std::chrono::milliseconds(1));
    }
    return false;
  };
  while (!is_heard(2)) ASSERT_LT(steady(), until) << "they do not find each other";
  const auto forged = [&] {
    const std::vector<Bytes> all = recording.copy();
    Bytes bytes = random() % 2 == 0 ? all[random() % all.size()] : Bytes(link::sealed_size);
    switch (random() % 4) {
      case 0:  // noise
        for (std::byte& each : bytes) each = static_cast<std::byte>(random());
        break;
      case 1:  // a false hello
        std::copy_n(all.front().begin(), 8, bytes.begin());
        break;
      case 2:  // a true one, damaged
        bytes = all[random() % all.size()];
        bytes[random() % bytes.size()] ^= std::byte{1};
        break;
      default:  // a true one, once more, or zeros
        break;
    }
    return bytes;
  };
  constexpr int rounds = 500;
  int heard = 0;
  for (int i = 0; i < rounds; ++i) {
    for (int k = 0; k < 40; ++k) throw_at_site(*attacker, forged());
    heard += is_heard(200) ? 1 : 0;
    // The site answers: else the station would take it for gone.
    packet.heard = 2;
    (void)here->send(packet);
  }
  EXPECT_GT(heard, rounds * 99 / 100) << "seed " << seed;
  EXPECT_GT(here->refused(), rounds * 20) << "seed " << seed;
}

inline std::string carrier_name(const ::testing::TestParamInfo<SealedCarrier>& info) {
  return info.param.name;
}

}  // namespace repel::test
