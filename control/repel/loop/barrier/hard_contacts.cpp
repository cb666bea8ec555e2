// SPDX-License-Identifier: BSD-3-Clause
#include <repel/loop/barrier/hard_contacts.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <span>

namespace repel {

bool has_hard(const World& world) noexcept {
  return std::any_of(world.pairs().begin(), world.pairs().end(),
                     [](const Pair& pair) { return pair.law.hold == HoldKind::hard; });
}

HardContacts::HardContacts(const World& world, std::span<const BodyId> moved)
    : world_(&world), is_moved_(static_cast<std::size_t>(world.body_count()), 0) {
  for (const BodyId body : moved) is_moved_[static_cast<std::size_t>(body.index)] = 1;
  const auto is_hard = [](const Pair& pair) { return pair.law.hold == HoldKind::hard; };
  const auto hard = std::count_if(world.pairs().begin(), world.pairs().end(), is_hard);
  for (int k = 0; k < ring; ++k) {
    const double angle = (k + 0.29) * 2.0 * std::numbers::pi / ring;
    around_[static_cast<std::size_t>(k)] = {std::cos(angle), std::sin(angle)};
  }
  contacts_.resize(std::min<std::size_t>(static_cast<std::size_t>(hard), most_pairs) * (1 + ring));
}

void HardContacts::collect(const Coprocessor& coprocessor, double reaction) noexcept {
  count_ = 0;
  left_out_ = 0;
  reaction_ = reaction;
  if (!any()) return;
  coprocessor.for_each_near([&](const NearPair& near) {
    const Pair& pair = world_->pair(near.pair);
    if (pair.law.hold == HoldKind::hard) add(near, pair);
  });
  // What is made of them must not depend on how the pairs are shared out to threads.
  std::sort(contacts_.begin(), contacts_.begin() + static_cast<std::ptrdiff_t>(count_),
            [](const HardContact& x, const HardContact& y) {
              return x.pair.index != y.pair.index ? x.pair.index < y.pair.index : x.at < y.at;
            });
}

std::span<const HardContact> HardContacts::all() const noexcept {
  return std::span(contacts_).first(count_);
}

Vec3 HardContacts::Side::farthest(const Vec3& d, const Vec3& out) const noexcept {
  const Vec<double> local = rotate_transposed(X_W, Vec<double>(d));
  return X_W * to_vec3(level.core.support(local).p) + level.depth * out;
}

void HardContacts::add(const NearPair& near, const Pair& pair) noexcept {
  const Vec3& n = near.separation.extraction_W;
  const Motion& motion = world_->motion();
  const Part& part_a = world_->part(pair.a);
  const Part& part_b = world_->part(pair.b);
  const BodyState& A = state(part_a.body);
  const BodyState& B = state(part_b.body);
  HardContact contact;
  contact.pair = near.pair;
  contact.a = carrier_of(motion, part_a.body);
  contact.b = carrier_of(motion, part_b.body);
  if (!is_moved(contact.a) && !is_moved(contact.b)) return;
  const BodyId arm_a = state(contact.a).arm;
  const BodyId arm_b = state(contact.b).arm;
  contact.is_between_arms = arm_a.valid() && arm_b.valid() && arm_a != arm_b;
  // Parts that are fading in use the soft law only.
  if (share_between(A, B).now < 1.0 || !(dot(n, n) > 0.5)) return;
  const Side a{part_a.shape.level(0), composed(A.X_WB, part_a.X_BP)};
  const Side b{part_b.shape.level(0), composed(B.X_WB, part_b.X_BP)};
  const Vec3 p_WA = a.farthest(-n, -n);
  const Vec3 p_WB = b.farthest(n, n);
  const double gap = dot(n, p_WA - p_WB);
  const double turns = norm(A.V_WB.angular - B.V_WB.angular);
  const double extent = std::min(part_a.shape.reach(), part_b.shape.reach());
  const double fastest = norm(velocity(A, p_WA) - velocity(B, p_WA)) + 2.0 * turns * extent;
  const double soon = reaction_ + braking;
  near_ = std::min(pair.law.range, acceleration * reaction_ * reaction_);
  if (gap > soon * fastest + near_) return;
  const double tilt = std::clamp(least_tilt + soon * turns, least_tilt, most_tilt);
  // The farthest points along n are any corners of faces that are normal to it, and may be far from
  // where the shapes are nearest.
  const Vec3 middle = near.is_watched ? Vec3(0.5 * (p_WA + p_WB))
                                      : Vec3(0.5 * (near.separation.p_WA + near.separation.p_WB));
  bool is_corner = false;  // that is where they are nearest
  std::array<Vec3, ring> corners;
  int found = 0;
  const Vec3 t1 = perpendicular_to(n);
  const Vec3 t2 = n.cross(t1);
  for (int k = 0; k < ring; ++k) {
    const auto& [along, across] = around_[static_cast<std::size_t>(k)];
    const Vec3 t = along * t1 + across * t2;
    const Vec3 corner_a = a.farthest(tilt * t - n, -n);
    const Vec3 corner_b = b.farthest(tilt * t + n, n);
    const bool ends_with_a = dot(t, corner_a) <= dot(t, corner_b);
    const Vec3& at = ends_with_a ? corner_a : corner_b;
    const double there = ends_with_a ? dot(n, corner_a - p_WB) : dot(n, p_WA - corner_b);
    const Vec3 off = at - middle;
    const auto is_there = [&](const Vec3& corner) { return norm(at - corner) < same; };
    if (std::any_of(corners.begin(), corners.begin() + found, is_there)) continue;
    corners[static_cast<std::size_t>(found++)] = at;
    const bool is_nearest = norm(off - dot(off, n) * n) < same;
    contact.at = is_nearest && !is_corner ? 0 : k + 1;
    is_corner |= is_nearest;
    push_back(contact, n, at, there);
  }
  contact.at = 0;
  if (!is_corner) push_back(contact, n, middle, gap);
}

void HardContacts::push_back(HardContact contact, const Vec3& n, const Vec3& p_W,
                             double gap) noexcept {
  const BodyState& A = state(contact.a);
  const BodyState& B = state(contact.b);
  contact.on_a = wrench_of_force(n, p_W - origin(A.X_WB));
  contact.on_b = wrench_of_force(-n, p_W - origin(B.X_WB));
  contact.gap = gap;
  contact.rate = power(contact.on_a, A.V_WB) + power(contact.on_b, B.V_WB);
  const double closes = -std::min(contact.rate, 0.0);
  if (contact.at > 0 && gap > near_ + (reaction_ + braking) * closes) return;
  if (count_ == contacts_.size()) {
    ++left_out_;
    return;
  }
  contact.bending = bending_of(n, p_W, A, B);
  contacts_[count_++] = contact;
}

double HardContacts::bending_of(const Vec3& n, const Vec3& p_W, const BodyState& A,
                                const BodyState& B) noexcept {
  const Vec3& of_a = A.V_WB.angular;
  const Vec3& of_b = B.V_WB.angular;
  const Vec3 to_a = of_a.cross(Vec3(of_a.cross(Vec3(p_W - origin(A.X_WB)))));
  const Vec3 to_b = of_b.cross(Vec3(of_b.cross(Vec3(p_W - origin(B.X_WB)))));
  // The normal turns with the body whose face it is of, or with both where edges cross. A direction
  // that stands still bounds the gap as well, so the worst of these is safe.
  const Vec3 slip = velocity(A, p_W) - velocity(B, p_W);
  const double with_a = 2.0 * dot(Vec3(of_a.cross(n)), slip);
  const double with_b = 2.0 * dot(Vec3(of_b.cross(n)), slip);
  return dot(n, Vec3(to_a - to_b)) + std::min({0.0, with_a, with_b});
}

Vec3 HardContacts::velocity(const BodyState& body, const Vec3& p_W) noexcept {
  return body.V_WB.linear + body.V_WB.angular.cross(Vec3(p_W - origin(body.X_WB)));
}

const BodyState& HardContacts::state(BodyId body) const noexcept {
  return world_->motion().bodies[static_cast<std::size_t>(body.index)];
}

bool HardContacts::is_moved(BodyId body) const noexcept {
  return is_moved_[static_cast<std::size_t>(body.index)] != 0;
}

}  // namespace repel
