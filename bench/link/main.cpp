/// @file
/// The round trip of a packet between two programs on one machine, over each transport of a link.

#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstring>
#include <functional>
#include <memory>
#include <thread>

#include <repel/link/udp.hpp>
#include <repel/schedule/deadline.hpp>
#ifdef REPEL_BENCH_DDS
#include <repel/dds/dds.hpp>
#endif

#include "../parts.hpp"

namespace {

using namespace repel;
using Clock = std::chrono::steady_clock;

constexpr std::uint16_t port = 17411;
constexpr std::uint32_t domain = 211;

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

bench::Result measure(const bench::Options& options) {
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
    packet.session = options.seed;
    // Both sides must find each other first.
    for (int i = 0; i < 20 && !comes_back(*station, packet); ++i) {
      ++packet.sequence;
      (void)station->send(packet);
    }
    DurationHistogram trips, sends;
    int lost = 0;
    auto due = Clock::now();
    for (int i = 0; i < packets; ++i) {
      due += std::chrono::microseconds(2500);
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
    const auto us = [](const DurationHistogram& times, double share) {
      return std::round(10.0 * times.percentile_us(share)) / 10.0;
    };
    result.rows.push_back({carrier.name, packets, us(trips, 0.5), us(trips, 0.99), us(trips, 0.999),
                           std::round(10.0 * trips.max_us()) / 10.0, us(sends, 0.5),
                           us(sends, 0.99), lost});
    bench::progress("round_trip", result.rows.size(), carriers().size());
  }
  result.notes = {
      "Checked of each packet: it comes back as it was sent.",
      "`send` is the time in the thread of the link, not in the tick, which writes to a queue in "
      "memory."};
  return result;
}

constexpr std::array<bench::Part, 1> all{
    bench::Part{"round_trip", "a packet to the other side and back", measure}};
constexpr bench::Program program{"link_bench",
                                 "The round trip of a packet between two programs on one machine.",
                                 all,
                                 "the session of the packets",
                                 "Both sides are threads of this program, with a transport each.",
                                 "none"};

void describe_program(CLI::App& app, bench::PartArguments& arguments) {
  bench::describe(app, arguments, program);
}
int run_program(const bench::PartArguments& arguments) {
  return bench::run(arguments, program);
}

}  // namespace

int main(int argc, char** argv) {
  return repel::host::start<bench::PartArguments>(argc, argv, program.name, program.about, 1,
                                                  describe_program, run_program);
}
