// SPDX-License-Identifier: BSD-3-Clause
#include <repel/link/udp.hpp>
#include <repel/sealed/sealed.hpp>

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <random>
#include <string>

#include <repel/base/setup_error.hpp>

#include "link/sealed_carriers.hpp"

namespace repel::test {

INSTANTIATE_TEST_SUITE_P(Carrier, SealedOver,
                         ::testing::Values(SealedCarrier{
                             "Udp",
                             [] {
                               // The first port that is free.
                               link::UdpOptions options;
                               for (int i = 0; i < 100; ++i) {
                                 options.port = static_cast<std::uint16_t>(
                                     20000 + (getpid() * 17 + i) % 20000);
                                 try {
                                   (void)link::open_udp_datagrams(options);
                                   break;
                                 } catch (const SetupError&) {
                                 }
                               }
                               return std::function([options](link::Side side) mutable {
                                 options.side = side;
                                 return link::open_udp_datagrams(options);
                               });
                             }}),
                         carrier_name);

}  // namespace repel::test

namespace repel::sealed {
namespace sealed_test {

using link::sealed_size;
using link::Side;
using test::Bytes;
using Packets = std::vector<std::int64_t>;  ///< their sequence numbers

/// Two sides in one thread, with what is on the way between them.
struct Sides {
  std::deque<Bytes> to_site, to_station;
  std::unique_ptr<link::Transport> site, station;
  network::RemotePacket packet;

  explicit Sides(std::uint8_t key_of_site = 1) {
    begin_site(key_of_site);
    begin_station();
  }
  void begin_site(std::uint8_t key = 1) {
    site = seal(std::make_unique<test::DatagramsWithin>(to_station, to_site), Side::site,
                test::key_of(key));
  }
  void begin_station() {
    station = seal(std::make_unique<test::DatagramsWithin>(to_site, to_station), Side::station,
                   test::key_of(1));
  }
  static Packets taken_by(link::Transport& side) {
    Packets all;
    network::RemotePacket come;
    while (side.receive(come)) all.push_back(come.sequence);
    return all;
  }
  /// Station to site, and back if it came. Returns how many came at each.
  std::pair<std::size_t, std::size_t> exchange() {
    ++packet.sequence;
    packet.session = packet.heard = 2;
    (void)station->send(packet);
    const std::size_t at_site = taken_by(*site).size();
    (void)site->send(packet);
    return {at_site, taken_by(*station).size()};
  }
  /// Hello and answer; then the first packet.
  void join() {
    (void)taken_by(*station);
    (void)taken_by(*site);
    (void)taken_by(*station);
    ASSERT_EQ(exchange(), (std::pair<std::size_t, std::size_t>(1, 1)));
  }
  /// The next datagram of the station, taken from the way.
  Bytes sealed_by_station() {
    ++packet.sequence;
    (void)station->send(packet);
    Bytes bytes = to_site.back();
    to_site.pop_back();
    return bytes;
  }
};

/// What others might see or do on the way.
template <class Visit>
void for_each_bit(const Bytes& bytes, const Visit& visit) {
  for (std::size_t bit = 0; bit < 8 * bytes.size(); ++bit) {
    Bytes damaged = bytes;
    damaged[bit / 8] ^= static_cast<std::byte>(1U << (bit % 8));
    visit(damaged);
  }
}

TEST(Sealed, TheWayShowsNothingOfAPacket) {
  Sides sides;
  sides.join();
  sides.packet.values.fill(4.5);
  const Bytes one = sides.sealed_by_station();
  const Bytes other = sides.sealed_by_station();
  std::size_t same = 0;
  for (std::size_t i = 48; i < one.size(); ++i) same += one[i] == other[i] ? 1 : 0;
  EXPECT_LT(same, 20U);  // of 736, 3 by chance
}

TEST(Sealed, EveryBitOfAPacketMatters) {
  Sides sides;
  sides.join();
  const Bytes sound = sides.sealed_by_station();
  for_each_bit(sound, [&](const Bytes& damaged) {
    sides.to_site.push_back(damaged);
    EXPECT_TRUE(Sides::taken_by(*sides.site).empty());
  });
  EXPECT_EQ(sides.site->refused(), static_cast<std::int64_t>(8 * sealed_size));
  sides.to_site.push_back(sound);
  EXPECT_EQ(Sides::taken_by(*sides.site), Packets{sides.packet.sequence});
}

TEST(Sealed, EveryBitOfAHelloMatters) {
  Sides sides;
  (void)Sides::taken_by(*sides.station);
  ASSERT_EQ(sides.to_site.size(), 1U);
  const Bytes hello = sides.to_site.front();
  sides.to_site.clear();
  for_each_bit(hello, [&](const Bytes& damaged) {
    sides.to_site.push_back(damaged);
    (void)Sides::taken_by(*sides.site);
  });
  EXPECT_TRUE(sides.to_station.empty()) << "a damaged hello is answered";
  sides.to_site.push_back(hello);
  (void)Sides::taken_by(*sides.site);
  EXPECT_EQ(sides.to_station.size(), 1U);
}

TEST(Sealed, EveryBitOfAnAnswerMatters) {
  Sides sides;
  (void)Sides::taken_by(*sides.station);
  (void)Sides::taken_by(*sides.site);
  ASSERT_EQ(sides.to_station.size(), 1U);
  const Bytes answer = sides.to_station.front();
  sides.to_station.clear();
  for_each_bit(answer, [&](const Bytes& damaged) {
    sides.to_station.push_back(damaged);
    (void)Sides::taken_by(*sides.station);
    EXPECT_FALSE(sides.station->send(sides.packet)) << "a damaged answer is believed";
  });
  sides.to_station.push_back(answer);
  (void)Sides::taken_by(*sides.station);
  EXPECT_TRUE(sides.station->send(sides.packet));
}

TEST(Sealed, OtherSizesAreRefused) {
  Sides sides;
  sides.join();
  const Bytes sound = sides.sealed_by_station();
  std::int64_t count = 0;
  for (const std::size_t size : {std::size_t{0}, std::size_t{1}, std::size_t{7}, std::size_t{48},
                                 sealed_size - 1, sealed_size + 1, std::size_t{65000}}) {
    Bytes other = sound;
    other.resize(size);
    sides.to_site.push_back(other);
    EXPECT_TRUE(Sides::taken_by(*sides.site).empty()) << size;
    EXPECT_EQ(sides.site->refused(), ++count) << size;
  }
}

TEST(Sealed, WhatWasThereIsRefused) {
  Sides sides;
  sides.join();
  std::vector<Bytes> all;
  for (int i = 0; i < 100; ++i) {
    all.push_back(sides.sealed_by_station());
    sides.to_site.push_back(all.back());
  }
  EXPECT_EQ(Sides::taken_by(*sides.site).size(), 100U);
  sides.to_site.insert(sides.to_site.end(), all.rbegin(), all.rend());
  EXPECT_TRUE(Sides::taken_by(*sides.site).empty());
  while (!sides.to_site.empty()) EXPECT_TRUE(Sides::taken_by(*sides.site).empty());
  EXPECT_EQ(sides.site->refused(), 100);
}

TEST(Sealed, PacketsMayOvertakeEachOtherWithinBounds) {
  constexpr unsigned seed = 1024;
  std::mt19937_64 random(seed);
  Sides sides;
  sides.join();
  std::vector<Bytes> all;
  for (int i = 0; i < 1000; ++i) all.push_back(sides.sealed_by_station());
  std::shuffle(all.begin(), all.end(), random);
  sides.to_site.assign(all.begin(), all.end());
  EXPECT_EQ(Sides::taken_by(*sides.site).size(), 1000U) << "seed " << seed;
  EXPECT_EQ(sides.site->refused(), 0);
  // One that was held back for longer than the bounds.
  const Bytes held = sides.sealed_by_station();
  for (int i = 0; i < 1024; ++i) sides.to_site.push_back(sides.sealed_by_station());
  EXPECT_EQ(Sides::taken_by(*sides.site).size(), 1024U);
  sides.to_site.push_back(held);
  EXPECT_TRUE(Sides::taken_by(*sides.site).empty());
  EXPECT_EQ(sides.site->refused(), 1);
}

TEST(Sealed, OnesOwnPacketsAreRefused) {
  Sides sides;
  sides.join();
  const Bytes by_station = sides.sealed_by_station();
  (void)sides.site->send(sides.packet);
  const Bytes by_site = sides.to_station.back();
  sides.to_station.clear();
  sides.to_station.push_back(by_station);
  sides.to_site.push_back(by_site);
  EXPECT_TRUE(Sides::taken_by(*sides.station).empty());
  EXPECT_TRUE(Sides::taken_by(*sides.site).empty());
  EXPECT_EQ(sides.station->refused(), 1);
  EXPECT_EQ(sides.site->refused(), 1);
}

TEST(Sealed, APacketOfAnotherSessionIsRefused) {
  Sides sides, others;
  sides.join();
  others.join();
  sides.to_site.push_back(others.sealed_by_station());
  EXPECT_TRUE(Sides::taken_by(*sides.site).empty());
  EXPECT_EQ(sides.site->refused(), 1);
}

TEST(Sealed, AnotherKeyIsRefused) {
  Sides sides(2);
  (void)Sides::taken_by(*sides.station);
  (void)Sides::taken_by(*sides.site);
  EXPECT_TRUE(sides.to_station.empty());
  EXPECT_EQ(sides.site->refused(), 1);
}

// Who recorded how a session began can play it again, in any order, to either side: the session
// goes on, and none begins.
TEST(Sealed, HellosPlayedAgainDisturbNobody) {
  Sides sides;
  (void)Sides::taken_by(*sides.station);
  const Bytes hello = sides.to_site.front();
  (void)Sides::taken_by(*sides.site);
  const Bytes answer = sides.to_station.front();
  sides.join();
  for (int i = 0; i < 100; ++i) {
    sides.to_site.push_back(hello);
    sides.to_station.push_back(answer);
    EXPECT_EQ(sides.exchange(), (std::pair<std::size_t, std::size_t>(1, 1)));
  }
  // The first packet of a session cannot begin it twice, nor at a site that begins anew.
  const Bytes later = sides.sealed_by_station();
  sides.begin_site();
  sides.to_site.assign({hello, later});
  EXPECT_TRUE(Sides::taken_by(*sides.site).empty());
  EXPECT_EQ(sides.site->refused(), 1);
}

// By the clock: a side is taken for gone after 0.1 s.
TEST(Sealed, ASideThatBeginsAnewIsMetByItself) {
  Sides sides;
  sides.join();
  const auto until = test::steady() + std::chrono::minutes(1);
  for (const bool of_site : {true, false}) {
    if (of_site) {
      sides.begin_site();
    } else {
      sides.begin_station();
    }
    while (sides.exchange() != std::pair<std::size_t, std::size_t>(1, 1)) {
      ASSERT_LT(test::steady(), until) << "they do not find each other";
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
  }
}

/// A folder for keys.
struct Folder {
  std::filesystem::path path =
      std::filesystem::temp_directory_path() / ("repel_keys_" + std::to_string(getpid()));
  Folder() { std::filesystem::create_directory(path); }
  ~Folder() { std::filesystem::remove_all(path); }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  [[nodiscard]] std::string file(const std::string& name) const { return path / name; }
  [[nodiscard]] std::string with(const std::string& name, const std::string& text,
                                 mode_t mode = 0600) const {
    std::ofstream(file(name)) << text;
    EXPECT_EQ(::chmod(file(name).c_str(), mode), 0);
    return file(name);
  }
};

std::string complaint_about(const std::string& file) {
  try {
    (void)load_key(file);
    return {};
  } catch (const SetupError& error) {
    return error.what();
  }
}

TEST(Key, IsMadeForItsOwnerAndNeverOverwritten) {
  const Folder folder;
  const std::string one = folder.file("one");
  const mode_t before = ::umask(0);
  make_key(one);
  (void)::umask(before);
  struct stat status {};
  ASSERT_EQ(::stat(one.c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 07777U, 0600U);
  EXPECT_EQ(status.st_size, 65);
  const Key key = load_key(one);
  EXPECT_THROW(make_key(one), SetupError);
  EXPECT_EQ(load_key(one), key);
  make_key(folder.file("other"));
  EXPECT_NE(load_key(folder.file("other")), key);
  EXPECT_THROW(make_key(folder.file("no/such/folder")), SetupError);
  std::filesystem::create_symlink(folder.file("elsewhere"), folder.file("link"));
  EXPECT_THROW(make_key(folder.file("link")), SetupError) << "it would be written elsewhere";
}

TEST(Key, IsRefusedWithASentence) {
  const Folder folder;
  const std::string digits(64, 'a');
  EXPECT_EQ(complaint_about(folder.with("sound", digits + "\n")), "");
  EXPECT_EQ(complaint_about(folder.with("no_line_feed", digits)), "");
  std::filesystem::create_directory_symlink(folder.path, folder.file("link_to_folder"));
  std::filesystem::create_symlink(folder.file("none"), folder.file("link_to_none"));
  ASSERT_EQ(::mkfifo(folder.file("pipe").c_str(), 0600), 0);
  const struct {
    std::string file;
    const char* words;
  } cases[] = {{folder.file("none"), "No such file"},
               {folder.file("link_to_none"), "No such file"},
               {folder.file("link_to_folder"), "is no file"},
               {folder.file("pipe"), "is no file"},
               {folder.with("for_group", digits, 0640), "chmod 600"},
               {folder.with("for_others", digits, 0604), "chmod 600"},
               {folder.with("empty", ""), "64 hexadecimal digits"},
               {folder.with("short", digits.substr(1)), "64 hexadecimal digits"},
               {folder.with("long", digits + "aa"), "64 hexadecimal digits"},
               {folder.with("longer", digits + "\n\n"), "64 hexadecimal digits"},
               {folder.with("letters", std::string(64, 'g')), "64 hexadecimal digits"},
               {folder.with("zero", std::string(64, '\0')), "64 hexadecimal digits"}};
  for (const auto& each : cases) {
    const std::string complaint = complaint_about(each.file);
    EXPECT_NE(complaint.find(each.file), std::string::npos) << each.file << ": " << complaint;
    EXPECT_NE(complaint.find(each.words), std::string::npos) << each.file << ": " << complaint;
    EXPECT_NE(complaint.find(each.words == std::string("No such file") ? "cannot" : "allowed: "),
              std::string::npos)
        << complaint;
    EXPECT_EQ(complaint.find("aaaa"), std::string::npos) << "it shows the key";
  }
}

}  // namespace sealed_test
}  // namespace repel::sealed
