// SPDX-License-Identifier: BSD-3-Clause
#include "contacts.hpp"

#include <cmath>
#include <span>

namespace repel::mujoco::detail {
namespace {

using RowMajor = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

}  // namespace

Contacts::Contacts(const ArmModel& model, const SimulationOptions& options, ContactTally& tally)
    : options_(options),
      X_LT_(model.X_LT),
      last_(static_cast<int>(model.links.size())),
      tally_(tally) {}

void Contacts::set_law(mjData& data, double h) noexcept {
  const double outward = 1.0 / (h * (options_.contact_damping + h * options_.contact_stiffness));
  const double along = 1.0 / (h * options_.contact_damping);
  for (mjContact& point : std::span(data.contact, static_cast<std::size_t>(data.ncon))) {
    if (point.efc_address < 0) continue;  // faces that meet without a depth have no force
    tally_.touch(-point.dist);
    point.mu = point.friction[0] * std::sqrt(along / outward);
    for (int i = 0; i < point.dim; ++i) {
      const int row = point.efc_address + i;
      data.efc_R[row] = i == 0 ? outward : along;
      data.efc_D[row] = 1.0 / data.efc_R[row];
      data.efc_aref[row] = -data.efc_vel[row] / h;
    }
    data.efc_aref[point.efc_address] -= outward * options_.contact_stiffness * point.dist;
  }
}

// MuJoCo's force is on the body of the second geom, in the frame of the contact, whose axes are the
// rows of its matrix.
void Contacts::note_forces(const mjModel& model, const mjData& data) noexcept {
  const Eigen::Map<const RowMajor> R_WL(data.xmat + 9 * last_);
  const Vec3 p_WT = R_WL * X_LT_.translation() + Eigen::Map<const Vec3>(data.xpos + 3 * last_);
  Wrench F_W;
  for (int i = 0; i < data.ncon; ++i) {
    const mjContact& point = data.contact[i];
    if (point.efc_address < 0) continue;
    const bool first = model.geom_bodyid[point.geom1] == last_;
    if (!first && model.geom_bodyid[point.geom2] != last_) continue;
    const Eigen::Map<const RowMajor> R_CW(point.frame);
    const Eigen::Map<const Vec3> force_C(data.efc_force + point.efc_address);
    const Vec3 force_W = (first ? -1.0 : 1.0) * (R_CW.transpose() * force_C);
    F_W += wrench_of_force(force_W, Eigen::Map<const Vec3>(point.pos) - p_WT);
  }
  tally_.push(rotated(Mat3((R_WL * X_LT_.linear()).transpose()), F_W));
}

}  // namespace repel::mujoco::detail
