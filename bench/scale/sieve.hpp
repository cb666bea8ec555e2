/// @file
/// The broad phase of another library, and our query on the pairs it lets through.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include <repel/geometry/box_tree.hpp>
#include <repel/reduction/separation.hpp>

#include "method.hpp"

namespace repel::scale {

/// Boxes along the axes of the world, of tool parts and of obstacles.
class BroadPhase {
 public:
  virtual ~BroadPhase() = default;
  /// The box of a part is now this one. Parts as Scene::parts() counts them.
  virtual void move(int part, const Box& box) noexcept = 0;
  /// All tool parts and obstacles whose boxes overlap, once each, into `found`.
  virtual void find(std::vector<std::pair<int, int>>& found) noexcept = 0;
};

/// Boxes of the parts that moved go to the broad phase, larger by the range for tool parts, and
/// the query, warm, to every pair whose boxes overlap.
class Sieve final : public Method {
 public:
  using Maker = std::unique_ptr<BroadPhase> (*)(std::span<const Box> boxes, int tool_parts);

  Sieve(const Scene& scene, Maker make);
  void tick(std::int64_t tick, std::span<const Placement> placements) noexcept override;
  void note(Record& record) const override;
  [[nodiscard]] int evaluated() const override { return evaluated_; }

 private:
  struct Moving {
    int part;
    Box box;  ///< [m] in its body
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
  std::unique_ptr<BroadPhase> broad_;
  std::vector<std::pair<int, int>> found_;
  std::vector<std::int32_t> within_;
  int evaluated_ = 0;
};

/// Puts a broad phase on the list when the program starts.
struct Enlisted {
  Enlisted(const std::string& name, const std::string& settings, Sieve::Maker make);
};

}  // namespace repel::scale
