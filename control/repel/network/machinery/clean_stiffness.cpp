// SPDX-License-Identifier: BSD-3-Clause
#include <repel/network/machinery/clean_stiffness.hpp>

#include <string>

#include <repel/base/setup_error.hpp>

namespace repel::network {

double CleanStiffness::limit() const noexcept {
  const double left = device_damping - (wall_damping < 0.0 ? -wall_damping : wall_damping);
  return left > 0.0 ? left / (0.5 * period + delay) : 0.0;
}

double CleanStiffness::needed_damping(double stiffness) const noexcept {
  return stiffness * (0.5 * period + delay) + (wall_damping < 0.0 ? -wall_damping : wall_damping);
}

std::string complaint(const CleanStiffness& at, double stiffness) {
  const auto text = [](double value) { return repel::to_text(value, 4); };
  if (stiffness <= at.limit()) return {};
  return "wall stiffness is " + text(stiffness) + " N/m; the clean-stiffness limit is " +
         text(at.limit()) + " N/m for a period of " + text(1e3 * at.period) + " ms, a delay of " +
         text(1e3 * at.delay) + " ms, " + text(at.device_damping) +
         " N s/m of damping in the device and " + text(at.wall_damping) +
         " N s/m in the wall; this wall needs " + to_text_above(at.needed_damping(stiffness), 4) +
         " N s/m in the device";
}

std::string checked_gain(GainCheck check, const CleanStiffness& at, double stiffness) {
  std::string text = complaint(at, stiffness);
  if (check == GainCheck::error && !text.empty()) throw SetupError(text);
  return text;
}

}  // namespace repel::network
