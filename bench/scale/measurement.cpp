// SPDX-License-Identifier: BSD-3-Clause
#include "measurement.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <numeric>

#include <malloc.h>
#include <sys/resource.h>

#include "brute_force.hpp"

namespace repel::scale {

namespace {

using Clock = std::chrono::steady_clock;

double heap() {
  const struct mallinfo2 info = mallinfo2();
  return static_cast<double>(info.uordblks + info.hblkhd);
}

double nanoseconds(Clock::duration duration) {
  return std::chrono::duration<double, std::nano>(duration).count();
}

double percentile_of(std::vector<double> values, double share) {
  const auto rank = static_cast<std::size_t>(std::ceil(share * static_cast<double>(values.size())));
  const auto place =
      values.begin() + static_cast<std::ptrdiff_t>(std::max<std::size_t>(rank, 1)) - 1;
  std::nth_element(values.begin(), place, values.end());
  return *place;
}

/// Resource usage of this thread so far.
struct rusage usage() {
  struct rusage now {};
  getrusage(RUSAGE_THREAD, &now);
  return now;
}

std::array<double, 6> numbers(const Wrench& F) {
  return {F.force.x(), F.force.y(), F.force.z(), F.torque.x(), F.torque.y(), F.torque.z()};
}

double difference(const Wrench& a, const Wrench& b) {
  return std::max((a.force - b.force).cwiseAbs().maxCoeff(),
                  (a.torque - b.torque).cwiseAbs().maxCoeff());
}

double size(const Wrench& F) {
  return std::max(F.force.cwiseAbs().maxCoeff(), F.torque.cwiseAbs().maxCoeff());
}

bool bitwise(const Wrench& a, const Wrench& b) {
  return numbers(a) == numbers(b);
}

/// The tolerance of the comparison. Rounding decides about corners within a nanometre of each
/// other, and so about as much of the arm of a force.
bool same(const Wrench& a, const Wrench& b) {
  return difference(a, b) <= 1e-8 * std::max({1.0, size(a), size(b)});
}

void compare_forces(std::span<const Wrench> a, std::span<const Wrench> b, Check& check) {
  bool equal = true;
  bool to_the_bit = true;
  for (std::size_t i = 0; i < a.size(); ++i) {
    equal = equal && same(a[i], b[i]);
    to_the_bit = to_the_bit && bitwise(a[i], b[i]);
    check.worst = std::max(check.worst, difference(a[i], b[i]));
  }
  ++check.ticks;
  check.wrong += equal ? 0 : 1;
  check.bitwise += to_the_bit ? 1 : 0;
}

std::span<const std::int32_t> within(const Record& record, std::size_t tick) {
  const std::size_t first = tick == 0 ? 0 : record.end[tick - 1];
  return std::span(record.within).subspan(first, record.end[tick] - first);
}

}  // namespace

void Run::add_times(const Run& again) {
  ns.insert(ns.end(), again.ns.begin(), again.ns.end());
  lost.insert(lost.end(), again.lost.begin(), again.lost.end());
  faults.insert(faults.end(), again.faults.begin(), again.faults.end());
}

double Run::mean() const {
  return std::accumulate(ns.begin(), ns.end(), 0.0) / static_cast<double>(ns.size());
}

double Run::percentile(double share) const {
  return percentile_of(ns, share);
}

double Run::undisturbed(double share) const {
  std::vector<double> quiet;
  for (std::size_t i = 0; i < ns.size(); ++i) {
    if (lost[i] == 0 && faults[i] == 0) quiet.push_back(ns[i]);
  }
  return quiet.empty() ? 0.0 : percentile_of(std::move(quiet), share);
}

int Run::preempted() const {
  return static_cast<int>(
      std::count_if(lost.begin(), lost.end(), [](int times) { return times > 0; }));
}

int Run::page_faults() const {
  return std::accumulate(faults.begin(), faults.end(), 0);
}

Run measure(const Way& way, const Scene& scene, int ticks) {
  Run run{.way = way};
  run.ns.resize(ticks);
  run.lost.resize(ticks);
  run.faults.resize(ticks);
  run.record.on_body.reserve(static_cast<std::size_t>(ticks) * (scene.setting().bodies + 1));
  const double before = heap();
  const Clock::time_point begin = Clock::now();
  const std::unique_ptr<Method> method = way.load(scene);
  run.setup = 1e-9 * nanoseconds(Clock::now() - begin);
  run.bytes = heap() - before;
  std::int64_t evaluated = 0;
  for (int tick = 0; tick < ticks; ++tick) {
    const std::span<const Placement> placements = scene.placements(tick);
    const struct rusage before_tick = usage();
    const Clock::time_point start = Clock::now();
    method->tick(tick, placements);
    run.ns[tick] = nanoseconds(Clock::now() - start);
    const struct rusage after_tick = usage();
    run.lost[tick] = static_cast<int>(after_tick.ru_nivcsw - before_tick.ru_nivcsw);
    run.faults[tick] = static_cast<int>(after_tick.ru_minflt - before_tick.ru_minflt);
    method->settle();
    method->note(run.record);
    evaluated += method->evaluated();
  }
  run.evaluated = static_cast<double>(evaluated) / ticks;
  run.workers = method->workers();
  run.usage = method->usage();
  return run;
}

Truth truth_of(const Scene& scene, int ticks) {
  BruteForce brute(scene);
  Truth truth;
  for (int tick = 0; tick < ticks; ++tick) {
    brute.tick(scene.placements(tick));
    Record& record = truth.record;
    record.on_body.insert(record.on_body.end(), brute.on_body().begin(), brute.on_body().end());
    record.within.insert(record.within.end(), brute.within().begin(), brute.within().end());
    record.end.push_back(record.within.size());
    if (tick % 1000 == 999) std::fprintf(stderr, "\r%d of %d ticks checked ", tick + 1, ticks);
  }
  if (ticks >= 1000) std::fprintf(stderr, "\n");
  truth.ticks = ticks;
  truth.asked = brute.asked();
  truth.overlapping = brute.overlapping();
  return truth;
}

Check compare(const Record& record, const Record& truth, std::size_t bodies, bool more) {
  Check check;
  if (record.end.empty() || truth.end.empty()) {
    const std::size_t both = std::min(record.on_body.size(), truth.on_body.size());
    for (std::size_t i = 0; i + bodies <= both; i += bodies) {
      compare_forces(std::span(record.on_body).subspan(i, bodies),
                     std::span(truth.on_body).subspan(i, bodies), check);
    }
    return check;
  }
  for (std::size_t tick = 0; tick < std::min(record.end.size(), truth.end.size()); ++tick) {
    const std::span<const std::int32_t> a = within(record, tick);
    const std::span<const std::int32_t> b = within(truth, tick);
    const bool equal = more ? std::includes(a.begin(), a.end(), b.begin(), b.end())
                            : std::equal(a.begin(), a.end(), b.begin(), b.end());
    ++check.ticks;
    check.wrong += equal ? 0 : 1;
    check.bitwise += equal ? 1 : 0;
  }
  return check;
}

}  // namespace repel::scale
