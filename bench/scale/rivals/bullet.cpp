// SPDX-License-Identifier: BSD-3-Clause
#include <BulletCollision/BroadphaseCollision/btDbvtBroadphase.h>

#include "../sieve.hpp"

namespace repel::scale {

namespace {

btVector3 to_bullet(const Vec3& v) {
  return {v.x(), v.y(), v.z()};
}

/// Bullet enlarges its boxes by a margin and keeps a pair listed while these overlap, so the
/// original boxes are compared once more.
class Bullet final : public BroadPhase {
 public:
  Bullet(std::span<const Box> boxes, int tool_parts) {
    constexpr int tool = 1;
    constexpr int obstacle = 2;
    for (const Box& box : boxes) {
      const bool is_tool = static_cast<int>(proxies_.size()) < tool_parts;
      proxies_.push_back(broad_.createProxy(to_bullet(box.min()), to_bullet(box.max()), 0, nullptr,
                                            is_tool ? tool : obstacle, is_tool ? obstacle : tool,
                                            nullptr));
      proxies_.back()->m_clientObject = reinterpret_cast<void*>(proxies_.size() - 1);
    }
    broad_.optimize();
  }

  void move(int part, const Box& box) noexcept override {
    broad_.setAabb(proxies_[part], to_bullet(box.min()), to_bullet(box.max()), nullptr);
  }
  void find(std::vector<std::pair<int, int>>& found) noexcept override {
    broad_.calculateOverlappingPairs(nullptr);
    const btBroadphasePairArray& pairs =
        broad_.getOverlappingPairCache()->getOverlappingPairArray();
    for (int i = 0; i < pairs.size(); ++i) {
      const btBroadphaseProxy* a = pairs[i].m_pProxy0;
      const btBroadphaseProxy* b = pairs[i].m_pProxy1;
      if (!TestAabbAgainstAabb2(a->m_aabbMin, a->m_aabbMax, b->m_aabbMin, b->m_aabbMax)) continue;
      found.emplace_back(std::min(part_of(a), part_of(b)), std::max(part_of(a), part_of(b)));
    }
  }

 private:
  static int part_of(const btBroadphaseProxy* proxy) noexcept {
    return static_cast<int>(reinterpret_cast<std::intptr_t>(proxy->m_clientObject));
  }

  btDbvtBroadphase broad_;
  std::vector<btBroadphaseProxy*> proxies_;
};

const Enlisted enlisted("bullet",
                        "btDbvtBroadphase with its margin of 5 cm: setAabb of the parts that moved",
                        [](std::span<const Box> boxes, int tool_parts) {
                          return std::unique_ptr<BroadPhase>(
                              std::make_unique<Bullet>(boxes, tool_parts));
                        });

}  // namespace

}  // namespace repel::scale
