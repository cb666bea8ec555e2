#include "sieve.hpp"

#include <algorithm>

#include <repel/pairs/pair_search.hpp>

namespace repel::scale {

Sieve::Sieve(const Scene& scene, Maker make)
    : parts_(scene.parts()),
      tool_parts_(scene.tool_parts()),
      obstacles_(scene.obstacles()),
      pairs_(scene.setting().pairs),
      range_(scene.law().range),
      moving_(scene.setting().bodies + 1),
      warm_(pairs_) {
  std::vector<Pose> X_WB(moving_.size(), Pose::Identity());
  for (const Placement& p : scene.placements(0)) X_WB[p.body.index] = p.X_WB;
  std::vector<Box> boxes;
  for (const Part& part : parts_) {
    const Moving moving{static_cast<int>(boxes.size()), detail::box_of(part)};
    if (part.body != World::fixed) moving_[part.body.index].push_back(moving);
    X_WP_.push_back(X_WB[part.body.index] * part.X_BP);
    boxes.push_back(box_of(moving, X_WB[part.body.index]));
  }
  broad_ = make(boxes, tool_parts_);
}

Box Sieve::box_of(const Moving& moving, const Pose& X_WB) const noexcept {
  const Box box = detail::moved(moving.box, X_WB);
  const Vec3 more = Vec3::Constant(moving.part < tool_parts_ ? range_ : 0.0);
  return {box.min() - more, box.max() + more};
}

void Sieve::tick(std::int64_t /*tick*/, std::span<const Placement> placements) noexcept {
  for (const Placement& p : placements) {
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
    if (s.distance < range_) within_.push_back(pair);
  }
}

void Sieve::note(Record& record) const {
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
  rivals().push_back({.name = name, .settings = settings, .load = [make](const Scene& scene) {
                        return std::make_unique<Sieve>(scene, make);
                      }});
}

}  // namespace repel::scale
