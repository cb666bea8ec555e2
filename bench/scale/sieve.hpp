// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The broad phase of another library, followed by repel's query on the pairs it reports.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include <repel/geometry/box_tree.hpp>
#include <repel/reduction/separation.hpp>

#include "method.hpp"

namespace repel::scale {

/// World-axis-aligned boxes of tool parts and of obstacles.
class BroadPhase {
 public:
  virtual ~BroadPhase() = default;
  /// Updates the box of a part. Parts are numbered as in Scene::parts().
  virtual void move(int part, const Box& box) noexcept = 0;
  /// Writes all pairs of tool part and obstacle whose boxes overlap into `found`, each once.
  virtual void find(std::vector<std::pair<int, int>>& found) noexcept = 0;
};

/// The boxes of the parts that moved go to the broad phase, enlarged by the range for tool parts;
/// every pair whose boxes overlap is queried with a warm start. With forces it gives what repel
/// does; without, the pairs within range.
class Sieve final : public Method {
 public:
  using Maker = std::unique_ptr<BroadPhase> (*)(std::span<const Box> boxes, int tool_parts);

  Sieve(const Scene& scene, Maker make, bool with_forces);
  void tick(std::int64_t tick, std::span<const Placement> placements) noexcept override;
  void note(Record& record) const override;
  [[nodiscard]] int evaluated() const override { return evaluated_; }

 private:
  struct Moving {
    int part;
    Box box;  ///< [m] in the frame of its body
  };

  void place(int part, const Pose& X_WB) noexcept;
  [[nodiscard]] Box box_of(const Moving& moving, const Pose& X_WB) const noexcept;

  std::vector<Part> parts_;
  int tool_parts_;
  int obstacles_;
  int pairs_;
  double range_;
  std::vector<Pose> X_WP_;                   ///< by part
  std::vector<std::vector<Moving>> moving_;  ///< by body
  std::vector<WarmStart> warm_;              ///< by pair
  std::vector<Placement> bodies_;            ///< where they are
  std::vector<Wrench> on_body_;
  std::vector<ForceLaw> laws_;  ///< by pair; empty: no forces
  std::unique_ptr<BroadPhase> broad_;
  std::vector<std::pair<int, int>> found_;
  std::vector<std::int32_t> within_;
  int evaluated_ = 0;
};

/// Registers a broad phase at program start.
struct Enlisted {
  Enlisted(const std::string& name, const std::string& settings, Sieve::Maker make);
};

}  // namespace repel::scale
