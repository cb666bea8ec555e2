#include <repel/link/link_thread.hpp>

#include <gtest/gtest.h>

#include <atomic>
#include <deque>
#include <mutex>

#include "link/joined.hpp"

namespace repel::link {
namespace link_thread_test {

/// A path within the program.
struct Path {
  std::mutex mutex;
  std::deque<network::RemotePacket> packets;
};

class Within final : public Transport {
 public:
  Within(Path& out, Path& in) : out_(out), in_(in) {}
  bool send(const network::RemotePacket& packet) noexcept override {
    const std::scoped_lock lock(out_.mutex);
    out_.packets.push_back(packet);
    return true;
  }
  bool receive(network::RemotePacket& packet) noexcept override {
    const std::scoped_lock lock(in_.mutex);
    if (in_.packets.empty()) return false;
    packet = in_.packets.front();
    in_.packets.pop_front();
    return true;
  }
  void wait(std::chrono::microseconds longest) noexcept override {
    std::this_thread::sleep_for(longest);
  }
  [[nodiscard]] std::string name() const override { return "within"; }

 private:
  Path& out_;
  Path& in_;
};

std::atomic<int> begun{0};

TEST(LinkThread, CarriesWhatTheTicksSend) {
  Path forth, back;
  test::JoinedSide site(1, std::make_unique<Within>(forth, back));
  test::JoinedSide station(2, std::make_unique<Within>(back, forth));
  test::tick_both(site, station, 400);
  site.thread.stop();
  station.thread.stop();
  test::expect_joined(site, station);
  test::expect_joined(station, site);
  EXPECT_EQ(site.thread.name(), "within");
  EXPECT_EQ(site.thread.unsent(), 0);
  EXPECT_EQ(site.link.counts().lost, 0);
}

TEST(LinkThread, BeginsAsItIsTold) {
  Path forth, back;
  network::RemoteLink link({.session = 1});
  LinkThread thread(link, std::make_unique<Within>(forth, back),
                    {.begin = []() noexcept { ++begun; }});
  for (int i = 0; i < 1000 && begun == 0; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  thread.stop();
  EXPECT_EQ(begun, 1);
}

}  // namespace link_thread_test
}  // namespace repel::link
