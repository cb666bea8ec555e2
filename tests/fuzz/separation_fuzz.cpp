// SPDX-License-Identifier: BSD-3-Clause
// Arbitrary shapes, poses, options and warm starts: every answer is finite with an ordered bracket,
// or bad_input that bounds nothing; answers to the same query do not contradict each other.
#include <repel/reduction/separation.hpp>

#include <optional>
#include <vector>

#include <fuzz/bytes.hpp>

#include <repel/reduction/shape.hpp>

namespace repel {
namespace {

using fuzz::Bytes;
using fuzz::require;

std::optional<Shape> shape_of(Bytes& bytes) {
  const auto kind = bytes.take<std::uint8_t>();
  try {
    const ReductionOptions levels{.levels = 1 + kind / 6 % 4};
    switch (kind % 6) {
      case 0:
        return Shape::box(bytes.vector(), levels);
      case 1:
        return Shape::sphere(bytes.number(), levels);
      case 2: {
        const double radius = bytes.number();
        return Shape::capsule(radius, bytes.number(), levels);
      }
      case 3: {
        const double radius = bytes.number();
        return Shape::cylinder(radius, bytes.number(), levels);
      }
      case 4:
        return Shape::ellipsoid(bytes.vector(), levels);
      default: {
        std::vector<Vec3> points(1 + bytes.take<std::uint8_t>() % 12);
        for (Vec3& p : points) p = bytes.vector();
        return Shape::hull(points, levels);
      }
    }
  } catch (const SetupError&) {
    return std::nullopt;
  }
}

QueryOptions options_of(Bytes& bytes) {
  QueryOptions options;
  const auto kind = bytes.take<std::uint8_t>();
  if ((kind & 1) != 0) options.tolerance = bytes.number();
  if ((kind & 2) != 0) options.iterations = bytes.take<std::int16_t>();
  if ((kind & 4) != 0) options.ignore_beyond = bytes.number();
  return options;
}

WarmStart warm_of(Bytes& bytes) {
  WarmStart warm;
  for (int i = 0; i < 4; ++i) {
    warm.a[i] = bytes.take<std::uint32_t>();
    warm.b[i] = bytes.take<std::uint32_t>();
  }
  warm.size = bytes.take<std::uint8_t>();
  warm.level_a = bytes.take<std::uint8_t>();
  warm.level_b = bytes.take<std::uint8_t>();
  return warm;
}

bool is_rigid_and_near(const Pose& X) {
  return is_finite(X) && is_rigid(X) && X.translation().norm() <= 1e9;
}

void check(const Separation& s, bool good_input) {
  if (s.end == QueryEnd::bad_input) {
    require(!good_input, "good input is not called bad");
    require(s.lower == -std::numeric_limits<double>::infinity(), "bad input claims nothing");
    require(s.upper == std::numeric_limits<double>::infinity(), "bad input claims nothing");
    return;
  }
  if (!good_input) return;
  require(std::isfinite(s.distance), "the distance is a number");
  require(s.lower <= s.distance, "the lower bound is one");
  require(s.distance <= s.upper, "the upper bound is one");
  require(is_finite(s.p_WA) && is_finite(s.p_WB), "witness points are numbers");
  require(std::abs(s.extraction_W.norm() - 1.0) <= 1e-9, "the direction is unit");
}

void check_one(Bytes bytes) {
  const auto A = shape_of(bytes);
  const auto B = shape_of(bytes);
  if (!A || !B) return;
  const Pose X_WA = bytes.pose();
  const Pose X_WB = bytes.pose();
  const QueryOptions options = options_of(bytes);
  WarmStart warm = warm_of(bytes);
  const bool good_options =
      options.tolerance >= 0.0 && options.iterations >= 1 && options.ignore_beyond >= 0.0;
  const bool good = good_options && is_rigid_and_near(X_WA) && is_rigid_and_near(X_WB);
  const Separation first = separation(*A, X_WA, *B, X_WB, options, warm);
  const Separation again = separation(*A, X_WA, *B, X_WB, options, warm);
  const Separation swapped = separation(*B, X_WB, *A, X_WA, options);
  for (const Separation& s : {first, again, swapped}) {
    check(s, good);
    if (!good) continue;
    require(s.lower <= first.upper && first.lower <= s.upper, "brackets agree");
  }
}

}  // namespace
}  // namespace repel

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  repel::check_one({data, size});
  return 0;
}
