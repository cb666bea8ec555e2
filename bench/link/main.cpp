// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// What a link between two programs costs, on one machine, over each transport: the round trip of a
/// packet, the time in the tick, and that of sealing.

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <functional>
#include <memory>
#include <thread>

#include <repel/common/deadline.hpp>
#include <repel/link/link_thread.hpp>
#include <repel/link/udp.hpp>
#include <repel/network/remote/link.hpp>
#ifdef REPEL_BENCH_DDS
#include <repel/dds/dds.hpp>
#endif
#ifdef REPEL_BENCH_SEALED
#include <repel/sealed/sealed.hpp>
#endif

#include "../parts.hpp"

namespace {

using namespace repel;
using Clock = std::chrono::steady_clock;

constexpr std::uint16_t port = 17411;
constexpr std::uint32_t domain = 211;
constexpr std::chrono::microseconds period(2500);
#ifdef REPEL_BENCH_SEALED
constexpr sealed::Key key{1};
#endif

struct Carrier {
  const char* name;
  std::function<std::unique_ptr<link::Transport>(link::Side)> open;
};

std::vector<Carrier> carriers() {
  std::vector<Carrier> all{
      {"UDP", [](link::Side side) { return link::open_udp({.side = side, .port = port}); }}};
#ifdef REPEL_BENCH_DDS
  all.push_back({"Cyclone DDS", [](link::Side side) {
                   return dds::open_dds({.side = side, .peer = {}, .domain = domain});
                 }});
#endif
#ifdef REPEL_BENCH_SEALED
  all.push_back({"UDP, sealed", [](link::Side side) {
                   return sealed::seal(link::open_udp_datagrams({.side = side, .port = port}), side,
                                       key);
                 }});
#ifdef REPEL_BENCH_DDS
  all.push_back({"Cyclone DDS, sealed", [](link::Side side) {
                   return sealed::seal(
                       dds::open_dds_datagrams({.side = side, .peer = {}, .domain = domain}), side,
                       key);
                 }});
#endif
#endif
  return all;
}

/// Sends back what arrives, from a thread of its own.
class Echo {
 public:
  explicit Echo(link::Transport& transport)
      : thread_([&transport](const std::stop_token& stop) {
          network::RemotePacket packet;
          while (!stop.stop_requested()) {
            while (transport.receive(packet)) (void)transport.send(packet);
            transport.wait(std::chrono::microseconds(200));
          }
        }) {}

 private:
  std::jthread thread_;
};

/// Waits for the packet with this number, at most for a second.
bool comes_back(link::Transport& transport, const network::RemotePacket& sent) {
  const auto until = Clock::now() + std::chrono::seconds(1);
  network::RemotePacket back;
  while (Clock::now() < until) {
    while (transport.receive(back)) {
      if (back.sequence == sent.sequence) return std::memcmp(&back, &sent, sizeof sent) == 0;
    }
    transport.wait(std::chrono::microseconds(200));
  }
  return false;
}

/// Sends from the station until a packet comes back, at most for 20 s.
void find_each_other(link::Transport& station, network::RemotePacket& packet) {
  for (int i = 0; i < 20 && !comes_back(station, packet); ++i) {
    ++packet.sequence;
    (void)station.send(packet);
  }
}

[[nodiscard]] double tenths(double us) {
  return std::round(10.0 * us) / 10.0;
}

bench::Result round_trip(const bench::Options& options) {
  bench::Result result;
  result.title = "Round trip of a packet of 720 bytes at 400 Hz, both sides on this machine";
  result.columns = {"link",     "packets",       "round trip p50 [us]", "p99 [us]", "p99.9 [us]",
                    "max [us]", "send p50 [us]", "send p99 [us]",       "lost"};
  const int packets = options.quick ? 100 : 10000;
  for (const Carrier& carrier : carriers()) {
    const auto site = carrier.open(link::Side::site);
    const auto station = carrier.open(link::Side::station);
    const Echo echo(*site);
    network::RemotePacket packet;
    packet.session = packet.heard = options.seed;  // a site answers whom it has heard
    find_each_other(*station, packet);
    DurationHistogram trips, sends;
    int lost = 0;
    auto due = Clock::now();
    for (int i = 0; i < packets; ++i) {
      due += period;
      std::this_thread::sleep_until(due);
      ++packet.sequence;
      packet.values[0] = std::sqrt(static_cast<double>(i));
      const auto begin = Clock::now();
      (void)station->send(packet);
      sends.record(Clock::now() - begin);
      if (comes_back(*station, packet)) {
        trips.record(Clock::now() - begin);
      } else {
        ++lost;
      }
    }
    if (lost > packets / 100) result.fail(carrier.name, "more than one in a hundred was lost");
    result.rows.push_back({carrier.name, packets, tenths(trips.percentile_us(0.5)),
                           tenths(trips.percentile_us(0.99)), tenths(trips.percentile_us(0.999)),
                           tenths(trips.max_us()), tenths(sends.percentile_us(0.5)),
                           tenths(sends.percentile_us(0.99)), lost});
    bench::progress("round_trip", result.rows.size(), carriers().size());
  }
  result.notes = {
      "Checked of each packet: it comes back as it was sent.",
      "`send` is the time in the thread of the link, not in the tick, which writes to a queue in "
      "memory."};
  return result;
}

/// One side of a link in its ticks: what comes in goes out again, and a push of 1 sqrt(W) with it.
class Side {
 public:
  explicit Side(std::uint64_t session) : link({.session = session}) { link.prepare(size, seconds); }
  void tick() noexcept {
    link.receive(Clock::now().time_since_epoch());
    wave_ = 0.5 * link.play(false);
    wave_[0] += 1.0;
    link.send(wave_, seconds);
  }
  /// Nothing came out that the other side has not put in.
  [[nodiscard]] bool is_passive(const Side& other) const noexcept {
    return link.player().output() <= other.link.energy_sent() * (1.0 + 1e-9);
  }

  network::RemoteLink link;

 private:
  static constexpr int size = 6;
  static constexpr double seconds = 1e-6 * period.count();
  network::Vec<network::any_size> wave_ = network::Vec<network::any_size>::Zero(size);
};

/// Runs `tick` by the clock and returns how long it took, each time.
template <class Tick>
DurationHistogram times_of(int ticks, const Tick& tick) {
  DurationHistogram times;
  auto due = Clock::now();
  for (int i = 0; i < ticks; ++i) {
    due += period;
    std::this_thread::sleep_until(due);
    times.record(tick());
  }
  return times;
}

template <class Work>
std::chrono::nanoseconds time_of(const Work& work) {
  const auto begin = Clock::now();
  work();
  return Clock::now() - begin;
}

bench::Result in_the_tick(const bench::Options& options) {
  bench::Result result;
  result.title = "A link in a tick at 400 Hz";
  result.columns = {"link",
                    "ticks",
                    "thread p50 [us]",
                    "thread p99 [us]",
                    "thread max [us]",
                    "received [%]",
                    "system calls p50 [us]",
                    "system calls p99 [us]"};
  const int ticks = options.quick ? 200 : 10000;
  for (const Carrier& carrier : carriers()) {
    Side site(2 * options.seed + 1);
    Side station(2 * options.seed + 2);
    DurationHistogram threaded;
    {
      link::LinkThread there(site.link, carrier.open(link::Side::site));
      link::LinkThread here(station.link, carrier.open(link::Side::station));
      threaded = times_of(ticks, [&] {
        const auto time = time_of([&] { station.tick(); });
        site.tick();
        return time;
      });
    }
    const double share = 100.0 * static_cast<double>(station.link.counts().received) / ticks;
    // The other side may be found late, not lost.
    if (share < 50.0) result.fail(carrier.name, "less than half of the packets came");
    if (!station.is_passive(site) || !site.is_passive(station)) {
      result.fail(carrier.name, "a side output more energy than the other one sent");
    }
    const auto site_end = carrier.open(link::Side::site);
    const auto station_end = carrier.open(link::Side::station);
    network::RemotePacket packet;
    packet.session = packet.heard = options.seed + 1;
    {
      const Echo echo(*site_end);
      find_each_other(*station_end, packet);
    }
    const DurationHistogram called = times_of(ticks, [&] {
      network::RemotePacket back;
      const auto time = time_of([&] {
        (void)station_end->send(packet);
        (void)station_end->receive(back);
      });
      while (site_end->receive(back)) (void)site_end->send(back);
      return time;
    });
    result.rows.push_back({carrier.name, ticks, tenths(threaded.percentile_us(0.5)),
                           tenths(threaded.percentile_us(0.99)), tenths(threaded.max_us()),
                           std::round(10.0 * share) / 10.0, tenths(called.percentile_us(0.5)),
                           tenths(called.percentile_us(0.99))});
    bench::progress("in_the_tick", result.rows.size(), carriers().size());
  }
  result.notes = {
      "Checked: no side outputs more energy than the other one has sent.",
      "`thread`, as the library does it: the packet of the tick is written, those that came "
      "are read and played, and a thread of its own speaks with the system. `system calls`: the "
      "same transport is asked to send and receive in the tick itself, and nothing is played."};
  return result;
}

#ifdef REPEL_BENCH_SEALED
/// A way within the program, which costs a copy.
class Way final : public link::Datagrams {
 public:
  using Bytes = std::array<std::byte, link::sealed_size>;
  Way(std::vector<Bytes>& out, std::vector<Bytes>& in) : out_(out), in_(in) {}
  bool send(std::span<const std::byte, link::sealed_size> bytes,
            const link::Origin& /*to*/) noexcept override {
    std::copy(bytes.begin(), bytes.end(), out_.emplace_back().begin());
    return true;
  }
  std::ptrdiff_t receive(std::span<std::byte> bytes, link::Origin& /*from*/) noexcept override {
    if (in_.empty()) return -1;
    std::copy(in_.back().begin(), in_.back().end(), bytes.begin());
    in_.pop_back();
    return link::sealed_size;
  }
  void wait(std::chrono::microseconds /*longest*/) noexcept override {}
  [[nodiscard]] std::string name() const override { return "a way within the program"; }

 private:
  std::vector<Bytes>& out_;
  std::vector<Bytes>& in_;
};

bench::Result sealing(const bench::Options& options) {
  bench::Result result;
  result.title = "Sealing in the thread of the link, per datagram of 784 bytes";
  result.columns = {"what", "times", "p50 [us]", "p99 [us]"};
  const int count = options.quick ? 1000 : 100000;
  std::vector<Way::Bytes> to_site, to_station;
  const auto site = sealed::seal(std::make_unique<Way>(to_station, to_site), link::Side::site, key);
  const auto station =
      sealed::seal(std::make_unique<Way>(to_site, to_station), link::Side::station, key);
  network::RemotePacket packet, come;
  packet.session = options.seed;
  (void)station->receive(come);  // says hello
  const Way::Bytes hello = to_site.front();
  (void)site->receive(come);
  (void)station->receive(come);
  DurationHistogram sealed, opened, refused, other, answered;
  for (int i = 0; i < count; ++i) {
    ++packet.sequence;
    sealed.record(time_of([&] { (void)station->send(packet); }));
    Way::Bytes damaged = to_site.back();
    bool is_opened = false;
    opened.record(time_of([&] { is_opened = site->receive(come); }));
    if (!is_opened || std::memcmp(&come, &packet, sizeof packet) != 0) {
      result.fail("a packet", "did not come as it was sent");
    }
    const auto time_of_one = [&](const Way::Bytes& bytes) {
      to_site.push_back(bytes);
      return time_of([&] { (void)site->receive(come); });
    };
    damaged[static_cast<std::size_t>(48 + i % 700)] ^= std::byte{1};
    refused.record(time_of_one(damaged));
    damaged[8] ^= std::byte{1};
    other.record(time_of_one(damaged));
    answered.record(time_of_one(hello));
    to_station.clear();
  }
  if (site->refused() != 2 * count) result.fail("false packets", "were not refused, all of them");
  const auto row = [&](const char* what, const DurationHistogram& times) {
    const auto hundredths = [](double us) { return std::round(100.0 * us) / 100.0; };
    result.rows.push_back(
        {what, count, hundredths(times.percentile_us(0.5)), hundredths(times.percentile_us(0.99))});
  };
  row("a packet is sealed", sealed);
  row("a packet is opened", opened);
  row("a false packet of the session is refused", refused);
  row("a packet of no session is refused", other);
  row("a hello is answered", answered);
  result.notes = {"Checked: each packet comes as it was sent, and each false one is refused.",
                  "Without the system calls that carry a datagram. None of this is in the tick."};
  return result;
}
#endif

constexpr bench::Part all[] = {
    {"round_trip", "a packet to the other side and back", round_trip},
    {"in_the_tick", "the time that a link takes of a tick", in_the_tick},
#ifdef REPEL_BENCH_SEALED
    {"sealing", "what a key costs", sealing},
#endif
};
constexpr bench::Program program{"link_bench",
                                 "What a link between two programs costs, on one machine.",
                                 all,
                                 "the session of the packets",
                                 "Both sides are threads of this program, with a transport each.",
                                 "none"};

}  // namespace

int main(int argc, char** argv) {
  return repel::bench::start<program>(argc, argv);
}
