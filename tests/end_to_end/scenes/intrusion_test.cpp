// SPDX-License-Identifier: BSD-3-Clause
// No part of an arm is deeper in an obstacle than the report states: every scene is recomputed from
// the joints in its log by Wolfe's algorithm with 113 bits, not by the library's own distance.
#include <repel/cell/cell.hpp>
#include <repel/cell/layout.hpp>
#include <repel/runs/setup/describe.hpp>
#include <repel/world/kinematics.hpp>
#include <support/wolfe.hpp>

#include "end_to_end/whole_run.hpp"
#include "support/families.hpp"

namespace repel::test {
namespace intrusion_test {

using nlohmann::json;
using oracle::Point;
using oracle::Real;

/// A part at its pose.
struct PlacedPart {
  const Shape& shape;
  Pose X_WP;

  [[nodiscard]] Vec3 farthest(const Vec3& d_W) const {
    const Vec3 d = X_WP.linear().transpose() * d_W;
    return X_WP * to_vec3(shape.level(0).core.support(Vec<double>(d)).p);
  }
  /// Radius by which the shape is rounded beyond its core [m].
  [[nodiscard]] double rounding() const { return shape.level(0).depth; }
};

/// A lower bound of the distance of two parts [m]; 0 if their cores intersect.
double distance_below(const PlacedPart& a, const PlacedPart& b) {
  const auto support = [&](const Point& x) {
    const oracle::Rough d = oracle::rough(x);
    const Vec3 n(d.x[0], d.x[1], d.x[2]);
    const Vec3 p = a.farthest(-n) - b.farthest(n);
    return Point{{p.x(), p.y(), p.z()}};
  };
  const Real size = a.shape.reach() + b.shape.reach();
  const oracle::Bracket bracket = oracle::minimum_norm(support, support(Point{{1, 0, 0}}), size);
  return static_cast<double>(bracket.lower) - a.rounding() - b.rounding();
}

/// Upper bound of the translation that separates the two [m].
double depth_above(const PlacedPart& a, const PlacedPart& b, families::Rng& rng) {
  double least = 1e9;
  const auto try_along = [&](const Vec3& n) {
    const double overlap = n.dot(b.farthest(n) - a.farthest(-n)) + a.rounding() + b.rounding();
    least = std::min(least, overlap);
  };
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {-1.0, 1.0}) {
      try_along(side * a.X_WP.linear().col(axis));
      try_along(side * b.X_WP.linear().col(axis));
    }
  }
  for (int i = 0; i < 300; ++i) try_along(families::direction(rng));
  return least;
}

/// A scene with the bodies at the poses of the log.
class Replay {
 public:
  explicit Replay(const scene::Scene& scene, const Columns& log)
      : log_(log), cell_(runs::describe(scene, scene.rate_hz).cell), world_(cell_.world()) {
    for (const ArmDescription& arm : cell_.description().arms) kinematics_.emplace_back(arm.model);
  }

  [[nodiscard]] const World& world() const { return world_; }
  [[nodiscard]] PlacedPart placed(PartId id) const {
    const Part& part = world_.part(id);
    const BodyState& body = world_.motion().bodies[static_cast<std::size_t>(part.body.index)];
    return {part.shape, body.X_WB * part.X_BP};
  }

  void go_to(std::size_t row) {
    for (const MovingBody& moving : cell_.moving()) {
      ASSERT_TRUE(moving.place(world_, log_.at("time_s")[row]));
    }
    for (std::size_t i = 0; i < cell_.arms(); ++i) place(i, row);
  }

 private:
  void place(std::size_t i, std::size_t row) {
    const ArmDescription& arm = cell_.description().arms[i];
    const std::string prefix = arm.name.empty() ? "" : arm.name + "/";
    std::vector<double> q;
    for (const ArmLink& link : arm.model.links) {
      const bool turns = link.type == JointType::revolute;
      const std::string name =
          prefix + "q" + std::to_string(q.size() + 1) + (turns ? "_rad" : "_m");
      q.push_back(log_.at(name)[row]);
    }
    kinematics_[i].update(q);
    ASSERT_TRUE(world_.place(cell_.layout(i).tool, kinematics_[i].X_WT(), {}));
    for (const LinkBody& link : cell_.layout(i).links) {
      ASSERT_TRUE(world_.place(link.body, kinematics_[i].X_WL(link.link), {}));
    }
  }

  const Columns& log_;
  Cell cell_;
  World world_;
  std::vector<Kinematics> kinematics_;
};

/// The intrusion into each obstacle according to the report [m].
std::map<std::string, double> deepest_of(const json& report) {
  std::map<std::string, double> deepest;
  for (const json& obstacle : report.at("obstacles")) {
    deepest[obstacle.at("name")] = obstacle.at("deepest_m");
  }
  return deepest;
}

struct Found {
  double nearest = 1e9;         ///< [m] of the pairs within range
  double nearest_of_all = 1e9;  ///< [m] of all that were looked at
  int met = 0;                  ///< pairs that touch or overlap
};

/// Checks every pair that can be within its range.
void check_row(const Replay& replay, const std::map<std::string, double>& deepest,
               families::Rng& rng, Found& found) {
  for (const Pair& pair : replay.world().pairs()) {
    const PlacedPart a = replay.placed(pair.a);
    const PlacedPart b = replay.placed(pair.b);
    const double apart = (a.X_WP.translation() - b.X_WP.translation()).norm();
    if (apart > a.shape.reach() + b.shape.reach() + pair.law.range) continue;
    const double distance = distance_below(a, b);
    if (distance < pair.law.range) found.nearest = std::min(found.nearest, distance);
    found.nearest_of_all = std::min(found.nearest_of_all, distance);
    if (distance > 0.0) continue;
    ++found.met;
    const std::string& name = replay.world().part(pair.b).name;
    ASSERT_LE(depth_above(a, b, rng), deepest.at(name) + 1e-9) << name;
  }
}

TEST(Intrusion, IsNeverDeeperThanTheReportSaysInAnyScene) {
  constexpr unsigned seed = 90;
  families::Rng rng(seed);
  int scenes = 0;
  int compared = 0;
  for (const std::string& name : scene_names()) {
    SCOPED_TRACE(name + ", seed " + std::to_string(seed));
    // No row of the log says where a tool gripped what it holds, or a camera saw what it sees.
    const scene::Scene scene = scene::load(REPEL_SOURCE "/scenes/" + name + ".yaml");
    if (!scene.loose.empty() || !scene.cameras.empty()) continue;
    const WholeRun& run = whole_run_of(name);
    if (run.ending.says("is not built in")) GTEST_SKIP() << run.ending;
    ASSERT_EQ(run.ending.status, 0) << run.ending;
    const Columns log = columns_of(run.folder / "log.csv");
    Replay replay(scene, log);
    const auto deepest = deepest_of(run.report);
    const auto& nearest = log.at("nearest_m");
    const auto closest = static_cast<std::size_t>(std::min_element(nearest.begin(), nearest.end()) -
                                                  nearest.begin());
    std::vector<std::size_t> rows{closest};
    for (std::size_t row = 0; row < nearest.size(); row += 80) rows.push_back(row);
    for (const std::size_t row : rows) {
      replay.go_to(row);
      Found found;
      check_row(replay, deepest, rng, found);
      if (found.met > 0 || found.nearest > 1e8) continue;
      // A pair just out of its range may be evaluated or not.
      ASSERT_LE(nearest[row], found.nearest + 1e-6) << "row " << row;
      ASSERT_GE(nearest[row], found.nearest_of_all - 1e-6) << "row " << row;
      ++compared;
    }
    ++scenes;
  }
  EXPECT_GE(scenes, 4);
  EXPECT_GT(compared, 100);
}

}  // namespace intrusion_test
}  // namespace repel::test
