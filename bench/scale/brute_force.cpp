// SPDX-License-Identifier: BSD-3-Clause
#include "brute_force.hpp"

#include <algorithm>

#include "pair_force.hpp"

namespace repel::scale {

BruteForce::BruteForce(const Scene& scene)
    : scene_(scene),
      X_WB_(scene.setting().bodies + 1, Pose::Identity()),
      V_WB_(X_WB_.size()),
      on_body_(X_WB_.size()) {
  for (std::int32_t i = 0; i < scene.obstacles(); ++i) {
    const Part& part = scene.parts()[scene.tool_parts() + i];
    if (spheres_.empty() || spheres_.back().body != part.body.index ||
        spheres_.back().count == lane) {
      spheres_.emplace_back().body = part.body.index;
      spheres_.back().first = i;
    }
    Spheres& s = spheres_.back();
    const Eigen::Vector3f centre = part.X_BP.translation().cast<float>();
    s.x[s.count] = centre.x();
    s.y[s.count] = centre.y();
    s.z[s.count] = centre.z();
    // Larger than the rounding error of single precision within 20 m.
    s.radius[s.count] = static_cast<float>(part.shape.reach() + scene.law().range + 2e-5);
    ++s.count;
  }
}

void BruteForce::place(std::span<const Placement> placements) {
  for (const Placement& p : placements) {
    X_WB_[p.body.index] = p.X_WB;
    V_WB_[p.body.index] = p.V_WB;
  }
}

/// Calls `found(pair)` for those whose spheres are within range, until it returns false.
template <class Found>
void BruteForce::look(Found&& found) {
  for (int i = 0; i < scene_.tool_parts(); ++i) {
    const Part& part = scene_.parts()[i];
    const Vec3 p_WP = X_WB_[part.body.index] * part.X_BP.translation();
    const auto reach = static_cast<float>(part.shape.reach());
    std::int32_t body = -1;
    Eigen::Vector3f p = Eigen::Vector3f::Zero();
    for (const Spheres& s : spheres_) {
      if (s.body != body) p = (X_WB_[s.body].inverse() * p_WP).cast<float>();
      body = s.body;
      const Lane beyond = (s.x - p.x()).square() + (s.y - p.y()).square() + (s.z - p.z()).square() -
                          (s.radius + reach).square();
      if (beyond.minCoeff() > 0.0F) continue;
      for (int k = 0; k < s.count; ++k) {
        if (beyond[k] > 0.0F) continue;
        const std::int32_t pair = scene_.pair(i, s.first + k);
        if (pair < scene_.setting().pairs && !found(pair)) return;
      }
    }
  }
}

std::pair<const Part&, const Part&> BruteForce::parts(std::int32_t pair) const {
  return {scene_.parts()[pair / scene_.obstacles()],
          scene_.parts()[scene_.tool_parts() + pair % scene_.obstacles()]};
}

Separation BruteForce::ask(std::int32_t pair, WarmStart& warm) {
  ++asked_;
  const auto [a, b] = parts(pair);
  return separation(a.shape, X_WB_[a.body.index] * a.X_BP, b.shape, X_WB_[b.body.index] * b.X_BP,
                    {}, warm);
}

void BruteForce::push(std::int32_t pair, const Separation& s) {
  const auto [part_a, part_b] = parts(pair);
  const std::size_t a = part_a.body.index;
  const std::size_t b = part_b.body.index;
  const ForceLaw law = World::effective(scene_.law(), part_a.shape, part_b.shape);
  const Pose X_WA = X_WB_[a] * part_a.X_BP;
  const Pose X_WB = X_WB_[b] * part_b.X_BP;
  scale::push(s, {part_a.shape, X_WA, X_WB_[a], V_WB_[a]}, {part_b.shape, X_WB, X_WB_[b], V_WB_[b]},
              law, on_body_[a], on_body_[b]);
}

void BruteForce::tick(std::span<const Placement> placements) {
  place(placements);
  found_.clear();
  within_.clear();
  look([&](std::int32_t pair) {
    found_.push_back(pair);
    return true;
  });
  std::sort(found_.begin(), found_.end());
  std::fill(on_body_.begin(), on_body_.end(), Wrench{});
  for (const std::int32_t pair : found_) {
    const Separation s = ask(pair, warm_[pair]);
    if (!(s.distance < scene_.law().range)) continue;
    within_.push_back(pair);
    overlapping_ += s.distance < 0.0 ? 1 : 0;
    push(pair, s);
  }
}

int BruteForce::count_near(std::span<const Placement> placements, int most) {
  place(placements);
  int count = 0;
  look([&](std::int32_t pair) {
    WarmStart cold;
    count += ask(pair, cold).distance < scene_.law().range ? 1 : 0;
    return count < most;
  });
  return count;
}

}  // namespace repel::scale
