#include "network_report.hpp"

namespace repel::teleop {
namespace {

using nlohmann::ordered_json;

/// Why a module's ledger may fall below zero; empty for one that claims it never does.
const char* outside_of_claim(const ModuleResult& m) {
  return m.passive ? "" : "   (the robot: takes and gives)";
}

}  // namespace

void print_network(const RunResult& r, std::FILE* out) {
  host::print_times("network alone", r.network_time, out);
  std::fprintf(
      out, "  energy of the network  into each module [J], the lowest it has been, what passed\n");
  for (const ModuleResult& m : r.modules) {
    std::fprintf(out, "    %-20s %10.4f   lowest %10.3g   passed %10.4f", m.name.c_str(),
                 m.ledger.energy, m.ledger.least, m.ledger.passed);
    if (m.ledger.supplied != 0.0) {
      std::fprintf(out, "   supplied by the operator %.4f", m.ledger.supplied);
    }
    if (m.passivity.dissipated > 0.0) {
      std::fprintf(out, "   controller took %.4g", m.passivity.dissipated);
    }
    if (m.passivity.owed > 0.0) std::fprintf(out, "   owed %.3g", m.passivity.owed);
    if (m.sampling_energy != 0.0) std::fprintf(out, "   by sampling %+.4g", m.sampling_energy);
    std::fprintf(out, "%s\n", outside_of_claim(m));
  }
  for (const std::string& warning : r.warnings) {
    std::fprintf(out, "  warning                %s\n", warning.c_str());
  }
}

ordered_json network_to_json(const RunResult& r) {
  ordered_json modules = ordered_json::array();
  for (const ModuleResult& m : r.modules) {
    modules.push_back({{"name", m.name},
                       {"passive", m.passive},
                       {"energy_j", m.ledger.energy},
                       {"least_j", m.ledger.least},
                       {"passed_j", m.ledger.passed},
                       {"deficit", m.ledger.deficit()},
                       {"supplied_j", m.ledger.supplied},
                       {"dissipated_by_controller_j", m.passivity.dissipated},
                       {"owed_j", m.passivity.owed},
                       {"sampling_energy_j", m.sampling_energy}});
  }
  return {{"network_us", host::percentiles(r.network_time)},
          {"device_damping_n_s_per_m", r.device_damping},
          {"warnings", r.warnings},
          {"modules", modules}};
}

}  // namespace repel::teleop
