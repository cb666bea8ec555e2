/// @file
/// What a library must offer to be measured, and the list of those that were built.
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

/// Whether a query may use what the last one on the same pair has left.
enum class Start : bool { cold, warm };

/// An answer as the checks want it, converted outside the time that counts.
struct Answer {
  double distance = 0.0;  ///< [m] > 0 the gap, < 0 minus the depth of the overlap
  /// [m] What is claimed about the true value; infinite where nothing is.
  double lower = -std::numeric_limits<double>::infinity();
  double upper = std::numeric_limits<double>::infinity();
  /// Unit, moving A along it takes A away from B; not finite where the library gives none.
  Vec3 extraction_W = Vec3::Constant(std::numeric_limits<double>::quiet_NaN());
};

/// One library with one task loaded: shapes and poses are in its own types.
class Rival {
 public:
  virtual ~Rival() = default;
  /// Asks one after the other; nothing but this is timed.
  virtual void run(std::span<const Ask> asks, Start start) = 0;
  /// The same question with its answer.
  virtual Answer answer(const Ask& ask, Start start) = 0;
};

/// What to know about a library before loading a task.
struct Library {
  std::string name;
  std::string version;
  std::string settings;    ///< the setting measured, and why
  double tolerance = 0.0;  ///< of that setting, in the library's own terms
  bool sweeps = true;      ///< has a tolerance that run time against error can be swept over
  bool warms = true;       ///< keeps something from tick to tick; else warm is the same as cold
  bool gaps = true;        ///< answers pairs that are apart
  bool depths = true;      ///< answers pairs that overlap
  /// True when the depth is exact by claim; else ours is checked against its own bracket, and
  /// those of others are not checked.
  bool exact_depths = true;
  bool ours = false;
  std::function<std::unique_ptr<Rival>(const Task&, double tolerance)> load;

  /// Something is claimed about depths that the exact ones can disprove.
  [[nodiscard]] bool is_checked_in_overlap() const { return depths && (exact_depths || ours); }
};

/// All libraries of this build, ours first, then by name.
[[nodiscard]] std::vector<Library>& libraries();

/// Puts a library on the list when the program starts.
struct Enlisted {
  explicit Enlisted(Library library) { libraries().push_back(std::move(library)); }
};

/// Turns an engine into a Rival: `cold(ask)` and `warm(ask)` return the library's own result, and
/// `read(result)` converts it. The calls are resolved here, so the timed loop holds nothing else.
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
