// SPDX-License-Identifier: BSD-3-Clause
#include <repel/runs/report/network_report.hpp>

#include <numbers>

#include <repel/host/figure.hpp>

namespace repel::runs {
namespace {

using host::figure;
using nlohmann::ordered_json;

/// Remark on a module that is not passive: it does not claim to be, or its ledger shows otherwise.
const char* remark_on(const ModuleResult& m) {
  if (m.passive()) return "";
  return m.claims_passive ? "   NOT PASSIVE: returned more than it took"
                          : "   (claims nothing: takes and gives)";
}

constexpr const char* axes[] = {"x", "y", "z", "rx", "ry", "rz"};

/// How far a compliance gave, which joints a limit pushed back, how hard fixtures pulled, or what
/// was measured; nothing of other modules.
void print_most(const ArmResult& arm, const ModuleResult& m, std::FILE* out) {
  for (int i = 0; m.given && i < 6; ++i) {
    const double most = m.given->coeff(i);
    if (most == 0.0) continue;
    const double shown = i < 3 ? 1e3 * most : 180.0 / std::numbers::pi * most;
    std::fprintf(out, "    %20s %s %s in %s at most\n", "gave", figure(shown, 1).c_str(),
                 i < 3 ? "mm" : "deg", axes[i]);
  }
  for (std::size_t i = 0; i < m.limit_torques.size(); ++i) {
    if (m.limit_torques[i] == 0.0) continue;
    std::fprintf(out, "    %20s %s with %s %s at most\n", "pushed", arm.joint_names[i].c_str(),
                 figure(m.limit_torques[i], 1).c_str(),
                 arm.joints[i] == JointType::prismatic ? "N" : "N m");
  }
  for (const FixtureResult& fixture : m.fixtures) {
    std::fprintf(out, "    %20s %s N at most   %.4g N/m, %.4g N s/m\n", fixture.name.c_str(),
                 figure(fixture.most_force, 1).c_str(), fixture.stiffness, fixture.damping);
  }
  if (!m.sensor) return;
  std::fprintf(out,
               "    %20s %s N at most, %lld ticks at its range, %lld without a sound reading\n",
               "measured", figure(m.sensor->peak_force, 1).c_str(),
               static_cast<long long>(m.sensor->saturated_ticks),
               static_cast<long long>(m.sensor->lost_ticks));
}

void print_modules(const ArmResult& arm, std::FILE* out) {
  std::fprintf(out,
               "  energy of the network  %sinto each module [J], the lowest it has been, what "
               "passed\n",
               arm.name.empty() ? "" : (arm.name + ": ").c_str());
  for (const ModuleResult& m : arm.modules) {
    std::fprintf(out, "    %-20s %10s   lowest %10.3g   passed %10s", m.name.c_str(),
                 figure(m.ledger.energy, 4).c_str(), m.ledger.least,
                 figure(m.ledger.passed, 4).c_str());
    if (m.ledger.supplied != 0.0) {
      std::fprintf(out, "   supplied %s", figure(m.ledger.supplied, 4).c_str());
    }
    if (m.passivity.dissipated > 0.0) {
      std::fprintf(out, "   controller took %.4g", m.passivity.dissipated);
    }
    if (m.passivity.owed > 0.0) std::fprintf(out, "   owed %.3g", m.passivity.owed);
    if (m.sampling_energy != 0.0) std::fprintf(out, "   by sampling %+.4g", m.sampling_energy);
    std::fprintf(out, "%s\n", remark_on(m));
    print_most(arm, m, out);
    if (m.coupling) {
      std::fprintf(out, "    %20s %.4g N/m, %.4g N s/m; %.4g N m/rad, %.4g N m s/rad\n", "gains",
                   m.coupling->stiffness, m.coupling->damping, m.coupling->angular_stiffness,
                   m.coupling->angular_damping);
    }
  }
}

void print_stability(const ArmResult& arm, std::FILE* out) {
  std::fprintf(out,
               "  stability              %sat the start: K T^2/M, B T/M, needed / its damping\n",
               arm.name.empty() ? "" : (arm.name + ": ").c_str());
  for (const StabilityShare& share : arm.stability) {
    std::fprintf(out, "    %-20s %9.3g %9.3g", share.source.c_str(), share.spring, share.damper);
    if (share.needed_damping > 0.0) std::fprintf(out, " %9.3g", share.needed_damping);
    std::fputc('\n', out);
  }
}

}  // namespace

void print_network(const RunResult& r, std::FILE* out) {
  host::print_times("network alone", r.network_time, out);
  for (const ArmResult& arm : r.arms) {
    print_modules(arm, out);
    print_stability(arm, out);
  }
}

ordered_json modules_to_json(const std::vector<ModuleResult>& modules) {
  ordered_json list = ordered_json::array();
  for (const ModuleResult& m : modules) {
    list.push_back({{"name", m.name},
                    {"passive", m.passive()},
                    {"claims_passive", m.claims_passive},
                    {"energy_j", m.ledger.energy},
                    {"least_j", m.ledger.least},
                    {"passed_j", m.ledger.passed},
                    {"deficit", m.ledger.deficit()},
                    {"supplied_j", m.ledger.supplied},
                    {"dissipated_by_controller_j", m.passivity.dissipated},
                    {"owed_j", m.passivity.owed},
                    {"sampling_energy_j", m.sampling_energy}});
    if (m.given) {
      for (int i = 0; i < 6; ++i) list.back()["most_given"][axes[i]] = m.given->coeff(i);
    }
    if (!m.limit_torques.empty()) list.back()["most_torques"] = m.limit_torques;
    for (const FixtureResult& fixture : m.fixtures) {
      list.back()["fixtures"].push_back({{"name", fixture.name},
                                         {"most_force_n", fixture.most_force},
                                         {"stiffness_n_per_m", fixture.stiffness},
                                         {"damping_n_s_per_m", fixture.damping}});
    }
    if (!m.coupling) continue;
    list.back()["gains"] = {{"stiffness_n_per_m", m.coupling->stiffness},
                            {"damping_n_s_per_m", m.coupling->damping},
                            {"angular_stiffness_n_m_per_rad", m.coupling->angular_stiffness},
                            {"angular_damping_n_m_s_per_rad", m.coupling->angular_damping}};
  }
  return list;
}

ordered_json stability_to_json(const ArmResult& arm) {
  ordered_json list = ordered_json::array();
  for (const StabilityShare& share : arm.stability) {
    list.push_back({{"source", share.source},
                    {"spring", share.spring},
                    {"damper", share.damper},
                    {"needed_damping", share.needed_damping}});
  }
  return list;
}

void add_measured(const ArmResult& arm, ordered_json& report) {
  report["peak_measured_force_n"] = nullptr;
  report["sensor_saturated_ticks"] = nullptr;
  report["sensor_lost_ticks"] = nullptr;
  for (const ModuleResult& m : arm.modules) {
    if (!m.sensor) continue;
    report["peak_measured_force_n"] = m.sensor->peak_force;
    report["sensor_saturated_ticks"] = m.sensor->saturated_ticks;
    report["sensor_lost_ticks"] = m.sensor->lost_ticks;
  }
}

}  // namespace repel::runs
