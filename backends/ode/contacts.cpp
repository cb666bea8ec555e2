// SPDX-License-Identifier: BSD-3-Clause
#include "contacts.hpp"

#include <algorithm>
#include <string>

namespace repel::ode::detail {
namespace {

constexpr int most_points = 8;              // per pair
constexpr std::size_t most_measured = 256;  // on the last link

dxGeom* geometry_of(const ContactPart& part) {
  const Level& level = part.shape.level(0);
  const Vec3 size = core_extents(part.shape);
  const bool round = level.depth > 0.0;
  if (level.core.kind() == Convex::Kind::box && round) {
    return size.z() > 0.0 ? dCreateCapsule(nullptr, level.depth, 2.0 * size.z())
                          : dCreateSphere(nullptr, level.depth);
  }
  if (size.minCoeff() > 0.0) {
    if (level.core.kind() == Convex::Kind::box) {
      return dCreateBox(nullptr, 2.0 * size.x(), 2.0 * size.y(), 2.0 * size.z());
    }
    if (level.core.kind() == Convex::Kind::cylinder) {
      return dCreateCylinder(nullptr, size.x(), 2.0 * size.z());
    }
  }
  throw SetupError("part '" + part.name +
                   "' cannot be touched in ODE; allowed: boxes, spheres, capsules and cylinders "
                   "that have a thickness");
}

void place(dxGeom* geometry, const Pose& X_WP) {
  const Eigen::Quaterniond R(X_WP.linear());
  const dQuaternion rotation = {R.w(), R.x(), R.y(), R.z()};
  dGeomSetPosition(geometry, X_WP.translation().x(), X_WP.translation().y(),
                   X_WP.translation().z());
  dGeomSetQuaternion(geometry, rotation);
}

void place_on(dxBody* body, dxGeom* geometry, const Pose& X_CP) {
  const Eigen::Quaterniond R(X_CP.linear());
  const dQuaternion rotation = {R.w(), R.x(), R.y(), R.z()};
  dGeomSetBody(geometry, body);
  dGeomSetOffsetPosition(geometry, X_CP.translation().x(), X_CP.translation().y(),
                         X_CP.translation().z());
  dGeomSetOffsetQuaternion(geometry, rotation);
}

}  // namespace

Contacts::Contacts(dWorldID world, const ArmModel& model, const SimulationOptions& options,
                   std::span<const dBodyID> body, std::span<const ContactPart> parts,
                   ContactTally& tally)
    : world_(world),
      options_(options),
      links_(dSimpleSpaceCreate(nullptr)),
      obstacles_(dSimpleSpaceCreate(nullptr)),
      joints_(dJointGroupCreate(0)),
      tally_(tally),
      last_(body.back()),
      X_CT_(Eigen::Translation3d(-model.links.back().p_LC) * model.X_LT),
      R_WC_(Mat3::Identity()),
      feedback_(most_measured) {
  require_touchable(parts, model);
  for (const ContactPart& part : parts) {
    dxGeom* const geometry = geometry_of(part);
    dSpaceAdd((part.link < 0 ? obstacles_ : links_).get(), geometry);
    if (part.link < 0) {
      place(geometry, part.X_LP);
      continue;
    }
    const auto link = static_cast<std::size_t>(part.link);
    place_on(body[link], geometry, Eigen::Translation3d(-model.links[link].p_LC) * part.X_LP);
  }
  surface_.mode =
      dContactSoftERP | dContactSoftCFM | dContactSlip1 | dContactSlip2 | dContactApprox1;
  surface_.mu = options.contact_friction;
  // Two faces in contact have more contact points than sliding directions: without the damper their
  // friction forces would not be unique.
  surface_.slip1 = surface_.slip2 = 1.0 / options.contact_damping;
}

// A spring K and damper C at the penetration depth x, which changes by -h v' in the sub-step, with
// v' the separation speed: force = K (x - h v') - C v'. In ODE's form: v' + CFM force = ERP x / h.
void Contacts::find(double h) noexcept {
  // ODE needs collision memory in each calling thread, and a step may run in any thread.
  (void)dAllocateODEDataForThread(dAllocateFlagCollisionData);
  const double damping = options_.contact_damping + h * options_.contact_stiffness;
  surface_.soft_cfm = 1.0 / damping;
  surface_.soft_erp = h * options_.contact_stiffness / damping;
  dJointGroupEmpty(joints_.get());
  points_ = 0;
  const dReal* r = dBodyGetQuaternion(last_);
  R_WC_ = Eigen::Quaterniond(r[0], r[1], r[2], r[3]).toRotationMatrix();
  dSpaceCollide2(reinterpret_cast<dxGeom*>(links_.get()),
                 reinterpret_cast<dxGeom*>(obstacles_.get()), this,
                 [](void* contacts, dxGeom* first, dxGeom* second) {
                   static_cast<Contacts*>(contacts)->touch(first, second);
                 });
}

void Contacts::touch(dGeomID first, dGeomID second) noexcept {
  dContactGeom points[most_points];
  const int count = dCollide(first, second, most_points, points, sizeof points[0]);
  for (int i = 0; i < count; ++i) {
    dContact contact{};
    contact.surface = surface_;
    contact.geom = points[i];
    dxJoint* const joint = dJointCreateContact(world_, joints_.get(), &contact);
    dxBody* const one = dGeomGetBody(points[i].g1);
    dxBody* const other = dGeomGetBody(points[i].g2);
    dJointAttach(joint, one, other);
    listen(joint, one != nullptr ? one : other);
    tally_.touch(points[i].depth);
  }
}

void Contacts::listen(dxJoint* joint, dxBody* link) noexcept {
  if (link == last_ && points_ < feedback_.size()) dJointSetFeedback(joint, &feedback_[points_++]);
}

// The only body of a joint is its first; its torque is about the centre of mass.
void Contacts::note_forces() noexcept {
  Wrench F_C_W;
  for (const dJointFeedback& point : std::span(feedback_).first(points_)) {
    F_C_W +=
        Wrench{{point.f1[0], point.f1[1], point.f1[2]}, {point.t1[0], point.t1[1], point.t1[2]}};
  }
  const Mat3 R_TW = (R_WC_ * X_CT_.linear()).transpose();
  tally_.push(rotated(R_TW, moved_to(F_C_W, R_WC_ * X_CT_.translation())));
}

void Contacts::forget() noexcept {
  dJointGroupEmpty(joints_.get());
  points_ = 0;
}

}  // namespace repel::ode::detail
