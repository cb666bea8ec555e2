// SPDX-License-Identifier: BSD-3-Clause
#include <coal/broadphase/broadphase_dynamic_AABB_tree.h>
#include <coal/shape/geometric_shapes.h>

#include "../sieve.hpp"

namespace repel::scale {

namespace {

class Coal final : public BroadPhase {
 public:
  Coal(std::span<const Box> boxes, int tool_parts) : tool_parts_(tool_parts) {
    for (const Box& box : boxes) {
      const std::size_t part = objects_.size();
      objects_.push_back(
          std::make_unique<coal::CollisionObject>(std::make_shared<coal::Sphere>(1.0)));
      objects_.back()->setUserData(reinterpret_cast<void*>(part));
      set(static_cast<int>(part), box);
      (static_cast<int>(part) < tool_parts ? tool_ : obstacles_)
          .registerObject(objects_.back().get());
    }
    tool_.setup();
    obstacles_.setup();
  }

  void move(int part, const Box& box) noexcept override {
    set(part, box);
    (part < tool_parts_ ? moved_tool_ : moved_obstacles_).push_back(objects_[part].get());
  }
  void find(std::vector<std::pair<int, int>>& found) noexcept override {
    tool_.update(moved_tool_);
    if (!moved_obstacles_.empty()) obstacles_.update(moved_obstacles_);
    moved_tool_.clear();
    moved_obstacles_.clear();
    Take take(found);
    tool_.collide(&obstacles_, &take);
  }

 private:
  class Take final : public coal::CollisionCallBackBase {
   public:
    explicit Take(std::vector<std::pair<int, int>>& found) : found_(found) {}
    bool collide(coal::CollisionObject* a, coal::CollisionObject* b) override {
      found_.emplace_back(std::min(part_of(*a), part_of(*b)), std::max(part_of(*a), part_of(*b)));
      return false;
    }

   private:
    static int part_of(const coal::CollisionObject& object) {
      return static_cast<int>(reinterpret_cast<std::intptr_t>(object.getUserData()));
    }
    std::vector<std::pair<int, int>>& found_;
  };

  /// Uses the given box, not one computed from the geometry.
  void set(int part, const Box& box) {
    objects_[part]->getAABB().min_ = box.min();
    objects_[part]->getAABB().max_ = box.max();
  }

  int tool_parts_;
  std::vector<std::unique_ptr<coal::CollisionObject>> objects_;
  std::vector<coal::CollisionObject*> moved_tool_, moved_obstacles_;
  coal::DynamicAABBTreeCollisionManager tool_, obstacles_;
};

const Enlisted enlisted("coal",
                        "DynamicAABBTreeCollisionManager, one of the tool and one of the "
                        "obstacles: update of the objects that moved, collide",
                        [](std::span<const Box> boxes, int tool_parts) {
                          return std::unique_ptr<BroadPhase>(
                              std::make_unique<Coal>(boxes, tool_parts));
                        });

}  // namespace

}  // namespace repel::scale
