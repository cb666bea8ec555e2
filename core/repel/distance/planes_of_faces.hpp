/// @file
/// The planes of the faces of a polytope, in SIMD lanes.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstring>

#include <repel/base/lanes.hpp>
#include <repel/base/vec.hpp>

namespace repel::detail {

/// The planes of the faces of a closed polytope of triangles with at most that many corners, found
/// together.
template <std::size_t most_corners>
class PlanesOfFaces {
 public:
  /// The face with these corners, counter-clockwise seen from outside.
  void set(std::size_t f, const Vec<double>& p, const Vec<double>& q,
           const Vec<double>& r) noexcept {
    const Vec<double> n = cross(q - p, r - p);
    x_[f] = n.x();
    y_[f] = n.y();
    z_[f] = n.z();
    offset_[f] = std::max({dot(n, p), dot(n, q), dot(n, r)});
  }
  /// Call when `count` faces are set. False where a face has no area, or an offset of at most
  /// `least` [m].
  [[nodiscard]] bool find(std::size_t count, double least) noexcept {
    for (std::size_t f = count; f % lane_count != 0; ++f) {
      x_[f] = x_[0];
      y_[f] = y_[0];
      z_[f] = z_[0];
      offset_[f] = offset_[0];
    }
    LaneMask beyond = Lanes{} == Lanes{};
    for (std::size_t f = 0; f < count; f += lane_count) {
      const LaneVec n{some(x_, f), some(y_, f), some(z_, f)};
      const Lanes part = 1.0 / roots(dot(n, n));
      const Lanes offset = part * some(offset_, f);
      beyond &= offset > all_of(least);
      store(part * n.x, x_, f);
      store(part * n.y, y_, f);
      store(part * n.z, z_, f);
      store(offset, offset_, f);
    }
    return bits_of(~beyond) == 0U;
  }
  /// Unit, outward.
  [[nodiscard]] Vec<double> normal(std::size_t f) const noexcept { return {x_[f], y_[f], z_[f]}; }
  [[nodiscard]] double offset(std::size_t f) const noexcept { return offset_[f]; }

 private:
  using Numbers =
      std::array<double, (2 * most_corners - 4 + lane_count - 1) / lane_count * lane_count>;
  [[nodiscard]] static Lanes some(const Numbers& numbers, std::size_t f) noexcept {
    Lanes lanes;
    std::memcpy(&lanes, numbers.data() + f, sizeof lanes);
    return lanes;
  }
  static void store(const Lanes& lanes, Numbers& numbers, std::size_t f) noexcept {
    std::memcpy(numbers.data() + f, &lanes, sizeof lanes);
  }

  Numbers x_, y_, z_;  ///< normals
  Numbers offset_;     ///< [m]
};

}  // namespace repel::detail
