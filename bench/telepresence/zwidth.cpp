// SPDX-License-Identifier: BSD-3-Clause
// Z-width: a hand drives a device into a sampled wall, whose stiffness is increased until the
// device no longer comes to rest.

#include <algorithm>
#include <cmath>
#include <limits>

#include <repel/network/elements/passivity.hpp>
#include <repel/network/machinery/clean_stiffness.hpp>

#include "part.hpp"
#include "rig.hpp"

namespace repel::telepresence {

namespace {

constexpr SliderOptions device{
    .mass = 1.0, .friction = 20.0, .hand_stiffness = 300.0, .hand_damping = 5.0};
constexpr double approach = 0.03;  // [m] start of the hand before the wall
constexpr double push = 15.0;      // [N] final force on the wall
constexpr double rest = 10e-6;     // [m] peak-to-peak motion that counts as rest
constexpr double stiffest = 1e7;   // [N/m] upper limit of the search

struct Setting {
  double rate_hz = 1000.0;
  double damping = 0.0;  // [N s/m] of the wall
  bool controlled = false;
};

/// A device in front of a wall, with its sampling.
class Hit {
 public:
  explicit Hit(const Setting& setting, double stiffness)
      : period_(1.0 / setting.rate_hz),
        controlled_(setting.controlled),
        wall_(stiff_wall(stiffness, setting.damping)),
        slider_(device, period_) {}

  /// One tick with the hand moving at `hand_speed` [m/s]. Returns the position at its start [m].
  double tick(double hand_speed) {
    const double x = slider_.position();
    const double v = slider_.speed();
    double force = wall_(approach - x, -v);
    if (controlled_) {
      force += v * controller_.step(One(force), One(v), One((x - last_) / period_), period_);
    }
    last_ = x;
    slider_.move(-force, hand_speed);
    return x;
  }

 private:
  using One = network::Vec<1>;
  double period_;  // [s]
  bool controlled_;
  ForceLaw wall_;
  Slider slider_;
  double last_ = 0.0;  // [m]
  network::PassivityController<1> controller_{{}, One::Ones()};
};

/// Peak-to-peak motion [m] in the last of 30 s after a hit at `speed` [m/s], or in the first second
/// with almost no motion.
double swing_after(const Setting& s, double stiffness, double speed) {
  Hit hit(s, stiffness);
  const auto driven = std::llround((approach + push / device.hand_stiffness) / speed * s.rate_hz);
  for (std::int64_t i = 0; i < driven; ++i) hit.tick(speed);
  double swing = std::numeric_limits<double>::infinity();
  for (int second = 0; second < 30 && swing > 0.1 * rest; ++second) {
    double low = std::numeric_limits<double>::infinity();
    double high = -low;
    for (std::int64_t i = 0; i < std::llround(s.rate_hz); ++i) {
      const double x = hit.tick(0.0);
      low = std::min(low, x);
      high = std::max(high, x);
    }
    swing = high - low;
  }
  return swing;
}

double worst_swing(const Setting& s, double stiffness) {
  double worst = 0.0;
  for (const double speed : {0.05, 0.2, 0.5}) {
    worst = std::max(worst, swing_after(s, stiffness, speed));
  }
  return worst;
}

bool holds(const Setting& s, double stiffness) {
  return worst_swing(s, stiffness) < rest;
}

/// [N/m] Stiffness up to which every wall tried is stable: steps of a tenth, then bisection to 0.1
/// %.
double greatest(const Setting& s) {
  double held = 1000.0;
  if (!holds(s, held)) return 0.0;
  double lost = 1.1 * held;
  while (lost < stiffest && holds(s, lost)) {
    held = lost;
    lost *= 1.1;
  }
  if (lost >= stiffest) return stiffest;
  while (lost / held > 1.001) {
    const double middle = std::sqrt(held * lost);
    (holds(s, middle) ? held : lost) = middle;
  }
  return held;
}

}  // namespace

Result zwidth(const Options& options) {
  Result result{.title = "Z-width: the stiffest wall without a limit cycle",
                .columns = {"rate [Hz]", "wall damping [N s/m]", "measured [kN/m]",
                            "with controller [kN/m]", "clean limit [kN/m]",
                            "swing at 1.2 x measured [um]", "the same with controller [um]"},
                .notes = {"A device of 1 kg and 20 N s/m in a hand of 300 N/m and 5 N s/m; "
                          "the stiffest wall tried has 10 000 kN/m."}};
  const std::vector<double> dampings = options.quick
                                           ? std::vector<double>{0, 10, 40}
                                           : std::vector<double>{0, 5, 10, 20, 40, 80, 160};
  std::size_t done = 0;
  for (const double rate_hz : {400.0, 1000.0, 4000.0}) {
    for (const double damping : dampings) {
      const Setting bare{rate_hz, damping, false};
      const Setting controlled{rate_hz, damping, true};
      const double limit = greatest(bare);
      const network::CleanStiffness clean{
          .period = 1.0 / rate_hz, .device_damping = device.friction, .wall_damping = damping};
      const std::string name = to_text(rate_hz) + " Hz, " + to_text(damping) + " N s/m";
      if (limit < clean.limit()) result.fail(name, "a wall below the clean limit is not held");
      result.rows.push_back({rate_hz, damping, 1e-3 * limit, 1e-3 * greatest(controlled),
                             1e-3 * clean.limit(), 1e6 * worst_swing(bare, 1.2 * limit),
                             1e6 * worst_swing(controlled, 1.2 * limit)});
      progress("zwidth", ++done, 3 * dampings.size());
    }
  }
  return result;
}

}  // namespace repel::telepresence
