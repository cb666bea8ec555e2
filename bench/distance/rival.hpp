// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The interface of a measured library, and the list of the libraries in this build.
#pragma once

#include <functional>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <benchmark/benchmark.h>

#include "task.hpp"

namespace repel::bench {

/// Whether a query may use state from the last query on the same pair.
enum class Start : bool { cold, warm };

/// An answer in the form the checks need, converted outside the timed section.
struct Answer {
  double distance = 0.0;  ///< [m] > 0 the gap, < 0 minus the penetration depth
  /// [m] The claimed bounds of the true value; infinite if none are claimed.
  double lower = -std::numeric_limits<double>::infinity();
  double upper = std::numeric_limits<double>::infinity();
  /// Unit vector; translating A along it separates A from B. Not finite if the library gives none.
  Vec3 extraction_W = Vec3::Constant(std::numeric_limits<double>::quiet_NaN());
};

/// One library with one task loaded: shapes and poses are in its own types.
class Rival {
 public:
  virtual ~Rival() = default;
  /// Executes the queries one after the other; only this function is timed.
  virtual void run(std::span<const Ask> asks, Start start) = 0;
  /// The same query, with its answer.
  virtual Answer answer(const Ask& ask, Start start) = 0;
};

/// The description of a library, known before a task is loaded.
struct Library {
  std::string name;
  std::string version;
  std::string settings;    ///< the settings used, and why
  double tolerance = 0.0;  ///< of these settings, in the library's own terms
  bool sweeps = true;      ///< has a tolerance for a sweep of run time against error
  bool warms = true;       ///< keeps state from tick to tick; otherwise warm is the same as cold
  bool gaps = true;        ///< supports pairs that are apart
  bool depths = true;      ///< supports pairs that overlap
  /// True if the depth is claimed to be exact. Otherwise repel's is checked against its own
  /// bracket, and that of others is not checked.
  bool exact_depths = true;
  bool ours = false;
  std::function<std::unique_ptr<Rival>(const Task&, double tolerance)> load;

  /// Some claim about depths can be checked against the exact ones.
  [[nodiscard]] bool is_checked_in_overlap() const { return depths && (exact_depths || ours); }
};

/// All libraries of this build: repel first, then by name.
[[nodiscard]] std::vector<Library>& libraries();

/// Registers a library at program start.
struct Enlisted {
  explicit Enlisted(Library library) { libraries().push_back(std::move(library)); }
};

/// Adapts an engine to a Rival: `cold(ask)` and `warm(ask)` return the library's own result, and
/// `read(result)` converts it. The calls are resolved at compile time, so the timed loop contains
/// nothing else.
template <class Engine>
class Adapter final : public Rival {
 public:
  template <class... Settings>
  explicit Adapter(const Task& task, const Settings&... settings) : engine_(task, settings...) {}

  void run(std::span<const Ask> asks, Start start) override {
    if (start == Start::warm) {
      for (const Ask& ask : asks) benchmark::DoNotOptimize(engine_.warm(ask));
    } else {
      for (const Ask& ask : asks) benchmark::DoNotOptimize(engine_.cold(ask));
    }
  }
  Answer answer(const Ask& ask, Start start) override {
    return engine_.read(start == Start::warm ? engine_.warm(ask) : engine_.cold(ask));
  }

  static std::unique_ptr<Rival> load(const Task& task, double tolerance) {
    return std::make_unique<Adapter>(task, tolerance);
  }

 private:
  Engine engine_;
};

}  // namespace repel::bench
