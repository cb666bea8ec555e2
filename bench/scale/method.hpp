// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The methods measured: each computes from a motion the pairs within range and data about them.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <repel/schedule/coprocessor_options.hpp>
#include <repel/schedule/pair_forces.hpp>

#include "scene.hpp"

namespace repel::scale {

/// The results, tick by tick.
struct Record {
  std::vector<Wrench> on_body;  ///< [tick * bodies + body]; empty if the method computes no forces
                                ///< of this very tick
  std::vector<std::int32_t> within;  ///< the pairs within range, tick after tick, sorted
  std::vector<std::size_t> end;      ///< end of each tick in `within`; empty if not known
};

/// One method, with a scene loaded.
class Method {
 public:
  virtual ~Method() = default;
  /// Only this function is timed.
  virtual void tick(std::int64_t tick, std::span<const Placement> placements) noexcept = 0;
  /// After a tick: waits until threads have done their part of it.
  virtual void settle() noexcept {}
  /// Appends the results of the last tick.
  virtual void note(Record& record) const = 0;
  /// Number of pairs evaluated in the last tick.
  [[nodiscard]] virtual int evaluated() const = 0;
  /// What became of its threads.
  [[nodiscard]] virtual WorkerReport workers() const { return {}; }
  [[nodiscard]] virtual WorkerUsage usage() const { return {}; }
};

/// A method by name.
struct Way {
  std::string name;
  std::string settings;
  int threads = 0;
  CoprocessorMode mode = CoprocessorMode::together;
  bool ours = false;
  bool every_pair = false;  ///< evaluates all pairs at every tick
  std::function<std::unique_ptr<Method>(const Scene&)> load;

  /// The library, if it is not ours.
  [[nodiscard]] std::string library() const { return name.substr(0, name.find(',')); }
  /// The forces are those of pairs one tick ago, at distances that are not larger than the true
  /// ones.
  [[nodiscard]] bool is_beside() const { return threads > 0 && mode == CoprocessorMode::beside; }
};

/// repel with that many threads.
[[nodiscard]] Way ours(int threads, CoprocessorMode mode = CoprocessorMode::together);
/// repel, evaluating every pair at every tick.
[[nodiscard]] Way every_pair();
/// The queries, patches and forces of the pairs within range, which are told: what is left where
/// finding them costs nothing.
[[nodiscard]] Way known_pairs();
/// The broad phases of the other libraries in this build.
[[nodiscard]] std::vector<Way>& rivals();

}  // namespace repel::scale
