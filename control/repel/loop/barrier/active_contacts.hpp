// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The contacts exerting force in a tick, with directions and damping, for the implicit solution of
/// the network.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <repel/base/spatial.hpp>
#include <repel/loop/arms/arm_bodies.hpp>
#include <repel/loop/arms/arm_inertia.hpp>
#include <repel/schedule/coprocessor.hpp>
#include <repel/world/world.hpp>

namespace repel {

/// A pair that exerts a force in this tick.
struct ActiveContact {
  PairId pair;           ///< that exerts a force
  BodyId a;              ///< the body that moves
  BodyId b;              ///< likewise, of the other part
  Wrench on_a;           ///< [1, m] on A of a unit separating force, about the origin of its body
  Wrench on_b;           ///< on B, likewise
  double damping = 0.0;  ///< [N s/m] how much its force falls with the speed along that force
  /// [N m/rad] How much its torque rises as A turns across the force: F a / e on a contact patch of
  /// half width a and tilt e (ForceLaw::tilt), 0 elsewhere.
  double turning = 0.0;
};

/// Collects the contacts of the bodies that arms move, in the order of their pairs. Allocates at
/// construction only; contacts beyond its capacity are left out.
class ActiveContacts {
 public:
  /// @param capacity largest number of contacts @param moved the bodies that arms move
  ActiveContacts(const World& world, std::size_t capacity, std::span<const BodyId> moved);

  /// Collects those of the last exchange. Cost: a look at each near pair.
  void collect(const Coprocessor& coprocessor) noexcept;

  /// The contacts of the last `collect`.
  [[nodiscard]] std::span<const ActiveContact> all() const noexcept;

 private:
  void add(const NearPair& near) noexcept;
  [[nodiscard]] int is_moved(BodyId body) const noexcept;

  const World* world_;
  std::vector<std::uint8_t> is_moved_;  // by BodyId
  std::vector<ActiveContact> contacts_;
  std::size_t count_ = 0;
};

/// The damping of the contacts at the joints of one arm [N m s/rad], sum of c h h' with h the joint
/// torques of the unit force of a contact; of size 0 without contacts. @param jacobian of the
/// `tool`
[[gnu::noinline]] void gather_damping(std::span<const ActiveContact> contacts, BodyId tool,
                                      const Jacobian& jacobian, const ArmBodies& links,
                                      network::Mat<network::any_size>& damping) noexcept;

/// The arm behind a contact patch.
struct TurnedArm {
  const ArmInertia::Matrix& mass;  ///< M of the arm
  double period = 0.0;             ///< T [s]
  double drive_delay = 0.0;        ///< [ticks]
};

/// Damps the turning of a tool that is light for the contact patches it rests on: a patch is a
/// spring K against turning and has no damping of its own, so from K T^2 / I = 0.25 on, the damping
/// wall_ticks T K is added by degrees, whole at 0.5. I is the inertia about an axis across the
/// force, by the diagonal of M.
/// @param w [rad/s] of the tool @param damping [N m s/rad] of all contacts at the joints, to which
/// it is added
/// @return [N m] the torque on the tool; it only takes energy
[[nodiscard]] Wrench damp_turning(std::span<const ActiveContact> contacts, BodyId tool,
                                  const Jacobian& jacobian, const Vec3& w, const TurnedArm& arm,
                                  network::Mat<network::any_size>& damping) noexcept;

}  // namespace repel
