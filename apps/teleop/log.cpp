#include "log.hpp"

#include <ostream>

#include "times.hpp"

namespace repel::teleop {
namespace {

/// The columns that every arm has, each behind `prefix`.
void write_names(const ArmResult& arm, const std::string& prefix, std::ostream& file) {
  for (const char* name :
       {"phase", "status", "x_m", "y_m", "z_m", "vx_m_s", "vy_m_s", "vz_m_s", "virtual_fx_n",
        "virtual_fy_n", "virtual_fz_n", "virtual_tx_nm", "virtual_ty_nm", "virtual_tz_nm",
        "coupling_fx_n", "coupling_fy_n", "coupling_fz_n", "lever_torque_nm", "gain"}) {
    file << ',' << prefix << name;
  }
  for (std::size_t i = 0; i < arm.joints.size(); ++i) {
    file << ',' << prefix << 'q' << i + 1 << (arm.joints[i] == JointType::revolute ? "_rad" : "_m");
  }
  for (const ModuleResult& module : arm.modules) {
    file << ',' << prefix << "energy_" << module.name << "_j";
  }
}

void write_values(const TickRecord& k, const ArmResult& arm, std::ostream& file) {
  file << ',' << k.phase << ',' << k.status;
  for (const Vec3& v :
       {k.p_WT, k.v_WT, k.virtual_force.force, k.virtual_force.torque, k.coupling.force}) {
    for (int axis = 0; axis < 3; ++axis) file << ',' << to_text(v[axis]);
  }
  file << ',' << to_text(k.lever_torque) << ',' << to_text(k.gain);
  for (std::size_t i = 0; i < arm.joints.size(); ++i) file << ',' << to_text(k.q[i]);
  for (std::size_t i = 0; i < arm.modules.size(); ++i) file << ',' << to_text(double{k.energy[i]});
}

/// The pair in quotes, since its name may have a comma; nothing for none.
std::string name_of(PairId pair, const RunResult& r) {
  return pair.valid() ? '"' + r.pair_names[static_cast<std::size_t>(pair.index)] + '"' : "";
}

}  // namespace

void write_csv(const RunResult& r, std::ostream& file) {
  file << "tick,time_s,nearest_m,hardest_pair,hardest_n,pairs_near,pairs_evaluated,pairs_stale,"
          "oldest_age_ticks";
  for (const ArmResult& arm : r.arms) {
    write_names(arm, arm.name.empty() ? "" : arm.name + "/", file);
  }
  file << '\n';
  const std::vector<TickRecord>& first = r.arms.front().records;
  for (std::size_t row = 0; row < first.size(); ++row) {
    const TickRecord& k = first[row];
    file << k.tick << ',' << to_text(k.time) << ',' << to_text(k.pairs.nearest) << ','
         << name_of(k.pairs.hardest_pair, r) << ',' << to_text(k.pairs.peak_force) << ','
         << k.pairs.near << ',' << k.pairs.evaluated << ',' << k.pairs.stale << ','
         << k.pairs.oldest_age;
    for (const ArmResult& arm : r.arms) write_values(arm.records[row], arm, file);
    file << '\n';
  }
}

}  // namespace repel::teleop
