// SPDX-License-Identifier: BSD-3-Clause
// Arbitrary points: the result is a hull that contains them and whose levels are inside it by their
// stated depths, or SetupError exactly if a point or an option is not allowed.
#include <repel/reduction/shape.hpp>

#include <algorithm>
#include <optional>
#include <vector>

#include <fuzz/bytes.hpp>

namespace repel {
namespace {

using fuzz::Bytes;
using fuzz::require;

bool allowed(const std::vector<Vec3>& points, int levels) {
  const auto holds = [](const Vec3& p) { return p.cwiseAbs().maxCoeff() <= Shape::largest; };
  return !points.empty() && levels >= 1 && levels <= 64 &&
         std::all_of(points.begin(), points.end(),
                     [&](const Vec3& p) { return is_finite(p) && holds(p); });
}

/// New points, sometimes equal to or between earlier ones: flat, collinear, duplicated.
std::vector<Vec3> points_of(Bytes& bytes) {
  std::vector<Vec3> points(bytes.take<std::uint8_t>() % 24);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto kind = bytes.take<std::uint8_t>();
    if (kind < 32 && i > 0) {
      points[i] = points[kind % i];
    } else if (kind < 96 && i > 1) {
      const Vec3& p = points[kind % i];
      points[i] = p + bytes.length() * (points[i - 1] - p);
    } else {
      points[i] = bytes.vector();
    }
  }
  return points;
}

double reach_along(const Convex& set, const Vec3& d) {
  return to_vec3(set.support(Vec<double>(d)).p).dot(d);
}

void check_along(const Shape& shape, const std::vector<Vec3>& points, const Vec3& d) {
  // Squares of lengths below 1e-154 m lose all digits.
  const double tolerance = 1e-9 * shape.reach() + 1e-150;
  const double outermost = reach_along(shape.level(0).core, d);
  for (const Vec3& p : points) require(p.dot(d) <= outermost + tolerance, "it holds its points");
  for (int i = 0; i < shape.levels(); ++i) {
    const Level& level = shape.level(i);
    require(level.depth >= 0.0 && std::isfinite(level.depth), "depths are numbers");
    require(reach_along(level.core, d) + level.depth <= outermost + tolerance,
            "a level lies as deep as it says");
  }
}

void check_one(Bytes bytes) {
  const int levels = bytes.take<std::int8_t>();
  const std::vector<Vec3> points = points_of(bytes);
  std::optional<Shape> shape;
  try {
    shape = Shape::hull(points, {.levels = levels});
  } catch (const SetupError&) {
  }
  require(shape.has_value() == allowed(points, levels), "SetupError says what is not allowed");
  if (!shape) return;
  require(std::isfinite(shape->reach()), "its reach is a number");
  for (int k = 0; k < 27; ++k) {
    const Vec3 d(k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1);
    if (!d.isZero(0.0)) check_along(*shape, points, d.normalized());
  }
}

}  // namespace
}  // namespace repel

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  repel::check_one({data, size});
  return 0;
}
