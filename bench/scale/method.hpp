/// @file
/// What is measured: ways to turn a motion into the pairs within range and what is known of them.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "scene.hpp"

namespace repel::scale {

/// What was found, tick by tick.
struct Record {
  std::vector<Wrench> on_body;       ///< [tick * bodies + body]; empty where none are computed
  std::vector<std::int32_t> within;  ///< the pairs within range, tick after tick, in order
  std::vector<std::size_t> end;      ///< of each tick in `within`; empty where not known
};

/// One way, with a scene loaded.
class Method {
 public:
  virtual ~Method() = default;
  /// Nothing but this is timed.
  virtual void tick(std::int64_t tick, std::span<const Placement> placements) noexcept = 0;
  /// Adds what the last tick has found.
  virtual void note(Record& record) const = 0;
  /// Of the last tick.
  [[nodiscard]] virtual int evaluated() const = 0;
};

/// A way by name.
struct Way {
  std::string name;
  std::string settings;
  int threads = 0;
  bool ours = false;
  bool every_pair = false;  ///< evaluates all at every tick
  std::function<std::unique_ptr<Method>(const Scene&)> load;
};

/// Ours with so many threads.
[[nodiscard]] Way ours(int threads);
/// Ours, every pair at every tick.
[[nodiscard]] Way every_pair();
/// The broad phases of the other libraries of this build.
[[nodiscard]] std::vector<Way>& rivals();

}  // namespace repel::scale
