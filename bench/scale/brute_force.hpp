// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Reference answer by brute force: every pair is tested at every tick.
#pragma once

#include <cstdint>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

#include <repel/reduction/separation.hpp>

#include "scene.hpp"

namespace repel::scale {

/// Compares the bounding spheres of both parts of every pair, one by one, and queries every pair
/// whose spheres are within range, with a warm start: in deep overlap witness points are not
/// unique, and a cold start may find others. Shares the query, the contact patch and the force law
/// with the world model, but nothing that decides which pairs are queried.
class BruteForce {
 public:
  /// Copies the present state of the scene.
  explicit BruteForce(const Scene& scene);

  /// The forces at that tick, and the pairs within range, sorted.
  void tick(std::span<const Placement> placements);
  [[nodiscard]] const std::vector<Wrench>& on_body() const { return on_body_; }
  [[nodiscard]] const std::vector<std::int32_t>& within() const { return within_; }
  /// Over all ticks so far.
  [[nodiscard]] std::int64_t asked() const { return asked_; }
  [[nodiscard]] std::int64_t overlapping() const { return overlapping_; }

  /// Number of pairs within range; `most` if there are more.
  [[nodiscard]] int count_near(std::span<const Placement> placements, int most);

 private:
  static constexpr int lane = 64;
  using Lane = Eigen::Array<float, lane, 1>;

  /// The bounding spheres of some obstacles of one body, in its frame.
  struct Spheres {
    std::int32_t body = 0;
    std::int32_t first = 0;  ///< first obstacle; the others follow
    int count = 0;
    Lane x = Lane::Zero(), y = Lane::Zero(), z = Lane::Zero();
    Lane radius = Lane::Zero();  ///< of the sphere, plus the range
  };

  void place(std::span<const Placement> placements);
  template <class Found>
  void look(Found&& found);
  [[nodiscard]] std::pair<const Part&, const Part&> parts(std::int32_t pair) const;
  [[nodiscard]] Separation ask(std::int32_t pair, WarmStart& warm);
  void push(std::int32_t pair, const Separation& s);

  const Scene& scene_;
  std::vector<Spheres> spheres_;
  std::vector<Pose> X_WB_;
  std::vector<Twist> V_WB_;
  std::unordered_map<std::int32_t, WarmStart> warm_;  ///< of all pairs queried so far
  std::vector<std::int32_t> found_;
  std::vector<std::int32_t> within_;
  std::vector<Wrench> on_body_;
  std::int64_t asked_ = 0;
  std::int64_t overlapping_ = 0;
};

}  // namespace repel::scale
