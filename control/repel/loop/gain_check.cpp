// SPDX-License-Identifier: BSD-3-Clause
#include <repel/loop/gain_check.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include <repel/loop/arms/arm_bodies.hpp>

namespace repel::detail {

double greatest_eigenvalue(const double (&A)[3][3]) noexcept {
  const double mean = (A[0][0] + A[1][1] + A[2][2]) / 3.0;
  const double off = A[0][1] * A[0][1] + A[0][2] * A[0][2] + A[1][2] * A[1][2];
  const double x = A[0][0] - mean, y = A[1][1] - mean, z = A[2][2] - mean;
  const double spread = std::sqrt((x * x + y * y + z * z + 2.0 * off) / 6.0);
  if (!(spread > 0.0)) return mean;
  const double determinant = x * (y * z - A[1][2] * A[1][2]) -
                             A[0][1] * (A[0][1] * z - A[1][2] * A[0][2]) +
                             A[0][2] * (A[0][1] * A[1][2] - y * A[0][2]);
  const double cosine = std::clamp(0.5 * determinant / (spread * spread * spread), -1.0, 1.0);
  return mean + 2.0 * spread * std::cos(std::acos(cosine) / 3.0);
}

}  // namespace repel::detail

namespace repel {

double device_damping(const ArmModel& model, const Jacobian& J) noexcept {
  double mobility[3][3] = {};  // [m/(N s)]
  for (std::size_t joint = 0; joint < model.links.size(); ++joint) {
    const Vec3 column = column_of(J, static_cast<Eigen::Index>(joint)).linear;
    const double damping = model.links[joint].viscous_friction;
    if (!(largest_entry(column) > 1e-12)) continue;
    if (!(damping > 0.0)) return 0.0;
    for (int i = 0; i < 3; ++i) {
      for (int k = 0; k < 3; ++k) mobility[i][k] += column.coeff(i) * column.coeff(k) / damping;
    }
  }
  const double greatest = detail::greatest_eigenvalue(mobility);
  return greatest > 0.0 ? 1.0 / greatest : 0.0;
}

ForceLaw settled(ForceLaw law, double period, double drive_delay) noexcept {
  if (law.is_damping_open()) {
    const double needed = wall_ticks(drive_delay) * period * law.stiffness();
    law.damping = std::max(law.damping, gain_rounding * needed);
  }
  return law;
}

double longest_period(const ForceLaw& law, double period, double drive_delay,
                      double response) noexcept {
  const double left = law.steepest_damping() / law.stiffness() - 2.0 * response;
  return left / wall_ticks(drive_delay - response / period);
}

std::string complaint(const ForceLaw& law, double period, double drive_delay, double response) {
  const double most = stable_stiffness(law.steepest_damping(), period, drive_delay);
  if (law.stiffness() <= gain_rounding * most) return {};
  const auto text = [](double value) { return repel::to_text(value, 4); };
  const double ticks = wall_ticks(drive_delay);
  std::string said = "wall stiffness is " + text(law.stiffness()) + " N/m; with its damping of " +
                     text(law.steepest_damping()) + " N s/m the limit is " +
                     to_text_below(most, 4) + " N/m at a period of " + text(1e3 * period) +
                     " ms and a drive delay of " + text(drive_delay) + " ticks; this wall needs " +
                     to_text_above(law.stiffness() * ticks * period, 4) + " N s/m of damping";
  const double longest = longest_period(law, period, drive_delay, response);
  if (longest * greatest_rate >= 1.0) {
    return said + ", or a rate of at least " + to_text_above(1.0 / longest, 4) + " Hz";
  }
  said += ", or a lower surface force or a longer range";
  const double within =
      0.5 * (law.steepest_damping() / law.stiffness() - ticks * period) + response;
  if (within > 0.0) {
    said += ", or an arm that answers within " + to_text_below(1e3 * within, 4) + " ms";
  }
  return said + "; no rate would do, up to " + to_text(greatest_rate) + " Hz";
}

std::vector<std::string> check_gains(const World& world, double period, double drive_delay,
                                     double device_damping, network::GainCheck check,
                                     double response) {
  std::vector<std::string> complaints;
  std::vector<std::string> told;
  for (const Pair& pair : world.pairs()) {
    std::string text = complaint(pair.law, period, drive_delay, response);
    const network::CleanStiffness clean{.period = period,
                                        .device_damping = device_damping,
                                        .wall_damping = pair.law.steepest_damping(),
                                        .delay = drive_delay * period};
    if (pair.law.stiffness() <= gain_rounding * clean.limit()) continue;
    if (!text.empty()) {
      text += ", or " + to_text_above(clean.needed_damping(pair.law.stiffness()), 4) +
              " N s/m of damping in the device, which has " + repel::to_text(device_damping, 4);
    }
    if (text.empty() || std::find(told.begin(), told.end(), text) != told.end()) continue;
    told.push_back(text);
    if (pair.law.given_at == GivenAt::tool) text += "; these are its numbers at the part";
    complaints.push_back("'" + world.part(pair.b).name + "': " + text);
    if (check == network::GainCheck::error) throw SetupError(complaints.back());
  }
  return complaints;
}

}  // namespace repel
