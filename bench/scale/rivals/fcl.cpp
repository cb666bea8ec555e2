// SPDX-License-Identifier: BSD-3-Clause
#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>
#include <fcl/geometry/shape/sphere.h>

#include "../sieve.hpp"

namespace repel::scale {

namespace {

/// An object with a given box, not one computed from its geometry.
class Object final : public fcl::CollisionObjectd {
 public:
  Object(int part, const Box& box)
      : fcl::CollisionObjectd(std::make_shared<fcl::Sphered>(1.0)), part_(part) {
    set(box);
  }
  void set(const Box& box) {
    aabb.min_ = box.min();
    aabb.max_ = box.max();
  }
  [[nodiscard]] int part() const { return part_; }

 private:
  int part_;
};

class Fcl final : public BroadPhase {
 public:
  Fcl(std::span<const Box> boxes, int tool_parts) : tool_parts_(tool_parts) {
    for (const Box& box : boxes) {
      const int part = static_cast<int>(objects_.size());
      objects_.push_back(std::make_unique<Object>(part, box));
      manager_of(part).registerObject(objects_.back().get());
    }
    tool_.setup();
    obstacles_.setup();
  }

  void move(int part, const Box& box) noexcept override {
    objects_[part]->set(box);
    (part < tool_parts_ ? moved_tool_ : moved_obstacles_).push_back(objects_[part].get());
  }
  void find(std::vector<std::pair<int, int>>& found) noexcept override {
    tool_.update(moved_tool_);
    if (!moved_obstacles_.empty()) obstacles_.update(moved_obstacles_);
    moved_tool_.clear();
    moved_obstacles_.clear();
    tool_.collide(&obstacles_, &found, take);
  }

 private:
  using Manager = fcl::DynamicAABBTreeCollisionManagerd;

  Manager& manager_of(int part) { return part < tool_parts_ ? tool_ : obstacles_; }

  static bool take(fcl::CollisionObjectd* a, fcl::CollisionObjectd* b, void* found) {
    const int i = static_cast<Object*>(a)->part();
    const int j = static_cast<Object*>(b)->part();
    static_cast<std::vector<std::pair<int, int>>*>(found)->emplace_back(std::min(i, j),
                                                                        std::max(i, j));
    return false;
  }

  int tool_parts_;
  std::vector<std::unique_ptr<Object>> objects_;
  std::vector<fcl::CollisionObjectd*> moved_tool_, moved_obstacles_;
  Manager tool_, obstacles_;
};

const Enlisted enlisted("fcl",
                        "DynamicAABBTreeCollisionManager, one of the tool and one of the "
                        "obstacles: update of the objects that moved, collide",
                        [](std::span<const Box> boxes, int tool_parts) {
                          return std::unique_ptr<BroadPhase>(
                              std::make_unique<Fcl>(boxes, tool_parts));
                        });

}  // namespace

}  // namespace repel::scale
