/// @file
/// The answer, found the plain way: every pair is looked at, at every tick.
#pragma once

#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

#include <repel/reduction/separation.hpp>

#include "scene.hpp"

namespace repel::scale {

/// Compares the spheres around both parts of every pair, one by one, and asks every pair whose
/// spheres are within range, warm: in deep overlap the witness points are not the only ones, and
/// from a cold start others may be found. It shares with the world model the query and the
/// force law, and nothing that decides which pairs are asked.
class BruteForce {
 public:
  /// Keeps the scene as it stands now.
  explicit BruteForce(const Scene& scene);

  /// The forces at that tick, and the pairs within range in their order.
  void tick(std::span<const Placement> placements);
  [[nodiscard]] const std::vector<Wrench>& on_body() const { return on_body_; }
  [[nodiscard]] const std::vector<std::int32_t>& within() const { return within_; }
  /// Of all ticks so far.
  [[nodiscard]] std::int64_t asked() const { return asked_; }
  [[nodiscard]] std::int64_t overlapping() const { return overlapping_; }

  /// How many pairs are within range; `most` when there are more.
  [[nodiscard]] int count_near(std::span<const Placement> placements, int most);

 private:
  static constexpr int lane = 64;
  using Lane = Eigen::Array<float, lane, 1>;

  /// The spheres of some obstacles of one body, in its frame.
  struct Spheres {
    std::int32_t body = 0;
    std::int32_t first = 0;  ///< obstacle; the others follow
    int count = 0;
    Lane x = Lane::Zero(), y = Lane::Zero(), z = Lane::Zero();
    Lane radius = Lane::Zero();  ///< of the sphere, and the range
  };

  void place(std::span<const Placement> placements);
  template <class Found>
  void look(Found&& found);
  [[nodiscard]] Separation ask(std::int32_t pair, WarmStart& warm);
  void push(std::int32_t pair, const Separation& s);

  const Scene& scene_;
  std::vector<Spheres> spheres_;
  std::vector<Pose> X_WB_;
  std::vector<Twist> V_WB_;
  std::unordered_map<std::int32_t, WarmStart> warm_;  ///< of all pairs that were ever asked
  std::vector<std::int32_t> found_;
  std::vector<std::int32_t> within_;
  std::vector<Wrench> on_body_;
  std::vector<std::vector<Wrench>> on_body_of_;  ///< by block of the sum
  std::int64_t asked_ = 0;
  std::int64_t overlapping_ = 0;
};

}  // namespace repel::scale
