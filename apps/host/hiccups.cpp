#include "hiccups.hpp"

#include <algorithm>

#include "machine.hpp"

namespace repel::host {
namespace {

std::chrono::nanoseconds now() noexcept {
  return std::chrono::steady_clock::now().time_since_epoch();
}

}  // namespace

void Hiccups::record(nanoseconds gap) noexcept {
  std::size_t bin = edges_us.size() - 1;
  while (bin > 0 && gap < std::chrono::microseconds(edges_us[bin])) --bin;
  ++bins[bin];
  ++count;
  total += gap;
  longest = std::max(longest, gap);
}

nlohmann::ordered_json to_json(const Hiccups& hiccups) {
  nlohmann::ordered_json histogram = nlohmann::ordered_json::array();
  for (std::size_t bin = 0; bin < hiccups.bins.size(); ++bin) {
    histogram.push_back({{"from_us", Hiccups::edges_us[bin]}, {"count", hiccups.bins[bin]}});
  }
  return {{"longer_than_us", 1e-3 * static_cast<double>(Hiccups::threshold.count())},
          {"count", hiccups.count},
          {"total_us", 1e-3 * static_cast<double>(hiccups.total.count())},
          {"max_us", 1e-3 * static_cast<double>(hiccups.longest.count())},
          {"histogram", histogram}};
}

HiccupWatch::HiccupWatch(const std::vector<int>& processors)
    : thread_([this, processors](const std::stop_token& stop) {
        (void)run_on(processors);
        watch(stop);
      }) {
  while (last_reading_.load() == nanoseconds(0)) std::this_thread::yield();
}

bool HiccupWatch::met(nanoseconds since, nanoseconds now) const noexcept {
  // In this order: once a reading is seen, so is the end of every hiccup before it.
  if (now - last_reading_.load(std::memory_order_acquire) > Hiccups::threshold) return true;
  return last_end_.load(std::memory_order_relaxed) >= since;
}

const Hiccups& HiccupWatch::stop() {
  thread_ = {};
  return hiccups_;
}

void HiccupWatch::watch(const std::stop_token& stop) noexcept {
  nanoseconds last = now();
  while (!stop.stop_requested()) {
    const nanoseconds reading = now();
    if (reading - last > Hiccups::threshold) {
      hiccups_.record(reading - last);
      last_end_.store(reading, std::memory_order_relaxed);
    }
    last_reading_.store(reading, std::memory_order_release);
    last = reading;
  }
}

}  // namespace repel::host
