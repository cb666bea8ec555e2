// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <random>
#include <utility>
#include <vector>

#include <repel/base/setup_error.hpp>
#include <repel/link/impaired.hpp>

namespace repel::link {
namespace {

using std::chrono::steady_clock;

class Impaired final : public Transport {
 public:
  Impaired(std::unique_ptr<Transport> transport, const network::ChannelOptions& channel)
      : transport_(std::move(transport)), channel_(channel), random_(channel.seed) {
    on_the_way_.reserve(room);
  }

  bool send(const network::RemotePacket& packet) noexcept override {
    const double late = drawn();
    if (drawn() < channel_.loss || on_the_way_.size() == room) return true;
    const std::chrono::duration<double> delay(channel_.delay + late * channel_.jitter);
    on_the_way_.push_back(
        {steady_clock::now() + std::chrono::duration_cast<steady_clock::duration>(delay), packet});
    std::push_heap(on_the_way_.begin(), on_the_way_.end(), leaves_later);
    return true;
  }
  [[nodiscard]] bool receive(network::RemotePacket& packet) noexcept override {
    send_what_is_due();
    return transport_->receive(packet);
  }
  void wait(std::chrono::microseconds longest) noexcept override {
    if (!on_the_way_.empty()) {
      const auto left = on_the_way_.front().leaves - steady_clock::now();
      longest = std::clamp(std::chrono::ceil<std::chrono::microseconds>(left),
                           std::chrono::microseconds(0), longest);
    }
    transport_->wait(longest);
  }
  [[nodiscard]] std::string name() const override {
    const auto ms = [](double seconds) { return std::to_string(std::lround(1e3 * seconds)); };
    return transport_->name() + ", delayed by " + ms(channel_.delay) + " to " +
           ms(channel_.delay + channel_.jitter) + " ms, " +
           std::to_string(std::lround(100.0 * channel_.loss)) + " % lost";
  }
  [[nodiscard]] std::string exposure() const override { return transport_->exposure(); }
  [[nodiscard]] std::int64_t foreign() const noexcept override { return transport_->foreign(); }
  [[nodiscard]] bool is_sealed() const noexcept override { return transport_->is_sealed(); }
  [[nodiscard]] std::int64_t refused() const noexcept override { return transport_->refused(); }

 private:
  static constexpr std::size_t room = 4096;

  struct Delayed {
    steady_clock::time_point leaves;
    network::RemotePacket packet;
  };
  static bool leaves_later(const Delayed& a, const Delayed& b) noexcept {
    return a.leaves > b.leaves;
  }

  void send_what_is_due() noexcept {
    const auto now = steady_clock::now();
    while (!on_the_way_.empty() && on_the_way_.front().leaves <= now) {
      std::pop_heap(on_the_way_.begin(), on_the_way_.end(), leaves_later);
      (void)transport_->send(on_the_way_.back().packet);
      on_the_way_.pop_back();
    }
  }
  double drawn() noexcept { return std::uniform_real_distribution<>()(random_); }

  std::unique_ptr<Transport> transport_;
  network::ChannelOptions channel_;
  std::mt19937_64 random_;
  std::vector<Delayed> on_the_way_;  // a heap, the next to leave in front
};

}  // namespace

std::unique_ptr<Transport> impaired(std::unique_ptr<Transport> transport,
                                    const network::ChannelOptions& channel) {
  checked("delay", channel.delay, 0.0, 10.0, "s");
  checked("jitter", channel.jitter, 0.0, 10.0, "s");
  checked("loss", channel.loss, 0.0, 1.0, "");
  return std::make_unique<Impaired>(std::move(transport), channel);
}

}  // namespace repel::link
