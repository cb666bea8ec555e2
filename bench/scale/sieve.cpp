// SPDX-License-Identifier: BSD-3-Clause
#include "sieve.hpp"

#include <algorithm>

#include <repel/pairs/pair_search.hpp>

#include "pair_force.hpp"

namespace repel::scale {

Sieve::Sieve(const Scene& scene, Maker make, bool with_forces)
    : parts_(scene.parts()),
      tool_parts_(scene.tool_parts()),
      obstacles_(scene.obstacles()),
      pairs_(scene.setting().pairs),
      range_(scene.law().range),
      moving_(scene.setting().bodies + 1),
      warm_(pairs_),
      bodies_(moving_.size()),
      on_body_(moving_.size()) {
  for (const Placement& p : scene.placements(0)) bodies_[p.body.index] = p;
  std::vector<Box> boxes;
  for (const Part& part : parts_) {
    const Moving moving{static_cast<int>(boxes.size()), detail::box_of(part)};
    if (part.body != World::fixed) moving_[part.body.index].push_back(moving);
    const Pose& X_WB = bodies_[part.body.index].X_WB;
    X_WP_.push_back(X_WB * part.X_BP);
    boxes.push_back(box_of(moving, X_WB));
  }
  broad_ = make(boxes, tool_parts_);
  for (std::int32_t pair = 0; with_forces && pair < pairs_; ++pair) {
    laws_.push_back(World::effective(scene.law(), parts_[pair / obstacles_].shape,
                                     parts_[tool_parts_ + pair % obstacles_].shape));
  }
}

Box Sieve::box_of(const Moving& moving, const Pose& X_WB) const noexcept {
  const Box box = detail::moved(moving.box, X_WB);
  const Vec3 more = Vec3::Constant(moving.part < tool_parts_ ? range_ : 0.0);
  return {box.min() - more, box.max() + more};
}

void Sieve::tick(std::int64_t /*tick*/, std::span<const Placement> placements) noexcept {
  std::fill(on_body_.begin(), on_body_.end(), Wrench{});
  for (const Placement& p : placements) {
    bodies_[p.body.index] = p;
    for (const Moving& moving : moving_[p.body.index]) {
      X_WP_[moving.part] = p.X_WB * parts_[moving.part].X_BP;
      broad_->move(moving.part, box_of(moving, p.X_WB));
    }
  }
  found_.clear();
  within_.clear();
  broad_->find(found_);
  evaluated_ = 0;
  for (const auto& [a, b] : found_) {
    const std::int32_t pair = a * obstacles_ + b - tool_parts_;
    if (pair >= pairs_) continue;
    ++evaluated_;
    const Separation s =
        separation(parts_[a].shape, X_WP_[a], parts_[b].shape, X_WP_[b], {}, warm_[pair]);
    if (!(s.distance < range_)) continue;
    within_.push_back(pair);
    if (laws_.empty()) continue;
    const Placement& of_a = bodies_[parts_[a].body.index];
    const Placement& of_b = bodies_[parts_[b].body.index];
    push(s, {parts_[a].shape, X_WP_[a], of_a.X_WB, of_a.V_WB},
         {parts_[b].shape, X_WP_[b], of_b.X_WB, of_b.V_WB}, laws_[pair],
         on_body_[parts_[a].body.index], on_body_[parts_[b].body.index]);
  }
}

void Sieve::note(Record& record) const {
  if (!laws_.empty()) {
    record.on_body.insert(record.on_body.end(), on_body_.begin(), on_body_.end());
    return;
  }
  const auto begin = static_cast<std::ptrdiff_t>(record.within.size());
  record.within.insert(record.within.end(), within_.begin(), within_.end());
  std::sort(record.within.begin() + begin, record.within.end());
  record.end.push_back(record.within.size());
}

std::vector<Way>& rivals() {
  static std::vector<Way> all;
  return all;
}

Enlisted::Enlisted(const std::string& name, const std::string& settings, Sieve::Maker make) {
  for (const bool with_forces : {false, true}) {
    rivals().push_back({.name = with_forces ? name + ", with forces" : name,
                        .settings = settings,
                        .load = [make, with_forces](const Scene& scene) {
                          return std::make_unique<Sieve>(scene, make, with_forces);
                        }});
  }
}

}  // namespace repel::scale
