// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// SIMD: several numbers in one register of the target, for code that works on several vertices or
/// pairs at once.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include <repel/base/vec.hpp>

namespace repel::detail {

// As many numbers as one register holds. The result in a lane does not depend on the lane count.
#if defined(__AVX512F__)
inline constexpr int lane_bytes = 64;
#elif defined(__AVX__)
inline constexpr int lane_bytes = 32;
#else
inline constexpr int lane_bytes = 16;
#endif
inline constexpr int lane_count = lane_bytes / 8;
using Lanes = double __attribute__((vector_size(lane_bytes)));
/// All bits of a lane are set, or none: the result of comparing Lanes.
using LaneMask = std::int64_t __attribute__((vector_size(lane_bytes)));

/// x in every lane.
[[nodiscard]] inline Lanes all_of(double x) noexcept {
  return x - Lanes{};
}
/// f(k) in lane k.
template <class F>
[[nodiscard]] Lanes lanes_of(const F& f) noexcept {
  Lanes lanes{};
  for (int k = 0; k < lane_count; ++k) lanes[k] = f(k);
  return lanes;
}
/// The larger in each lane; b where one of the two is NaN.
[[nodiscard]] inline Lanes larger(const Lanes& a, const Lanes& b) noexcept {
#if defined(__AVX__) && !defined(__AVX512F__)
  return __builtin_ia32_maxpd256(a, b);
#else
  return a > b ? a : b;
#endif
}
[[nodiscard]] inline Lanes smaller(const Lanes& a, const Lanes& b) noexcept {
#if defined(__AVX__) && !defined(__AVX512F__)
  return __builtin_ia32_minpd256(a, b);
#else
  return a < b ? a : b;
#endif
}
[[nodiscard]] inline Lanes magnitudes(const Lanes& a) noexcept {
  return (Lanes)((LaneMask)a & std::int64_t{0x7FFFFFFFFFFFFFFF});
}
[[nodiscard]] inline Lanes roots(const Lanes& a) noexcept {
#if defined(__clang__)
  // The builtin functions differ from version to version.
  return lanes_of([&](int k) { return std::sqrt(a[k]); });
#elif defined(__AVX512F__)
  return __builtin_ia32_sqrtpd512_mask(a, a, -1, 4);
#elif defined(__AVX__)
  return __builtin_ia32_sqrtpd256(a);
#elif defined(__SSE2__)
  return __builtin_ia32_sqrtpd(a);
#else
  return lanes_of([&](int k) { return std::sqrt(a[k]); });
#endif
}
// In halves: a chain through all lanes would be waited for.
[[nodiscard]] inline double largest_of(Lanes a) noexcept {
  for (int half = lane_count / 2; half > 0; half /= 2) {
    for (int k = 0; k < half; ++k) a[k] = std::max(a[k], a[k + half]);
  }
  return a[0];
}
[[nodiscard]] inline double least_of(Lanes a) noexcept {
  for (int half = lane_count / 2; half > 0; half /= 2) {
    for (int k = 0; k < half; ++k) a[k] = std::min(a[k], a[k + half]);
  }
  return a[0];
}
/// Bit k is set when the mask of lane k is set.
[[nodiscard]] inline unsigned bits_of(const LaneMask& mask) noexcept {
#if defined(__AVX512DQ__)
  using Long = long long __attribute__((vector_size(lane_bytes)));
  return static_cast<unsigned char>(__builtin_ia32_cvtq2mask512((Long)mask));
#elif defined(__AVX__) && !defined(__AVX512F__)
  return static_cast<unsigned>(__builtin_ia32_movmskpd256((Lanes)mask));
#elif defined(__SSE2__) && !defined(__AVX__)
  return static_cast<unsigned>(__builtin_ia32_movmskpd((Lanes)mask));
#else
  unsigned bits = 0;
  for (int k = 0; k < lane_count; ++k) bits |= static_cast<unsigned>(mask[k] & 1) << k;
  return bits;
#endif
}

/// One vector per lane.
struct LaneVec {
  Lanes x, y, z;

  LaneVec() = default;
  LaneVec(const Lanes& all_x, const Lanes& all_y, const Lanes& all_z) noexcept
      : x(all_x), y(all_y), z(all_z) {}
  // The default copy is bytewise, through memory in pieces that the compiler chooses; a register
  // load from several narrower stores stalls until all are done.
  // NOLINTBEGIN(modernize-use-equals-default)
  LaneVec(const LaneVec& v) noexcept : x(v.x), y(v.y), z(v.z) {}
  LaneVec& operator=(const LaneVec& v) noexcept {
    x = v.x;
    y = v.y;
    z = v.z;
    return *this;
  }
  // NOLINTEND(modernize-use-equals-default)

  /// The same vector in all lanes.
  [[nodiscard]] static LaneVec all(const Vec<double>& v) noexcept {
    return {all_of(v.x()), all_of(v.y()), all_of(v.z())};
  }
  /// The vector v(k) in lane k.
  template <class F>
  [[nodiscard]] static LaneVec of(const F& v) noexcept;
  /// Stores `v` in lane k.
  void set(int k, const Vec<double>& v) noexcept {
    x[k] = v.x();
    y[k] = v.y();
    z[k] = v.z();
  }
  /// The vector in lane k.
  [[nodiscard]] Vec3 at(int k) const noexcept { return {x[k], y[k], z[k]}; }
  /// The vectors of all lanes.
  [[nodiscard]] std::array<Vec<double>, lane_count> each() const noexcept;

  friend LaneVec operator+(const LaneVec& a, const LaneVec& b) noexcept {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
  }
  friend LaneVec operator-(const LaneVec& a, const LaneVec& b) noexcept {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
  }
  friend LaneVec operator-(const LaneVec& a) noexcept { return {-a.x, -a.y, -a.z}; }
  friend LaneVec operator*(const Lanes& s, const LaneVec& a) noexcept {
    return {s * a.x, s * a.y, s * a.z};
  }
  friend Lanes dot(const LaneVec& a, const LaneVec& b) noexcept {
    return a.x * b.x + a.y * b.y + a.z * b.z;
  }
  friend LaneVec cross(const LaneVec& a, const LaneVec& b) noexcept {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
  }
  friend LaneVec product(const LaneVec& a, const LaneVec& b) noexcept {
    return {a.x * b.x, a.y * b.y, a.z * b.z};
  }
  friend LaneVec magnitudes(const LaneVec& a) noexcept {
    return {magnitudes(a.x), magnitudes(a.y), magnitudes(a.z)};
  }
  friend Lanes sum(const LaneVec& a) noexcept { return a.x + a.y + a.z; }
  friend LaneVec either(const LaneMask& first, const LaneVec& a, const LaneVec& b) noexcept {
    return {first ? a.x : b.x, first ? a.y : b.y, first ? a.z : b.z};
  }
};

#if defined(__AVX__) && !defined(__AVX512F__)
template <class F>
LaneVec LaneVec::of(const F& v) noexcept {
  const Lanes a = v(0).lanes();
  const Lanes b = v(1).lanes();
  const Lanes c = v(2).lanes();
  const Lanes d = v(3).lanes();
  const Lanes xz_ab = __builtin_shufflevector(a, b, 0, 4, 2, 6);
  const Lanes xz_cd = __builtin_shufflevector(c, d, 0, 4, 2, 6);
  const Lanes y_ab = __builtin_shufflevector(a, b, 1, 5, 3, 7);
  const Lanes y_cd = __builtin_shufflevector(c, d, 1, 5, 3, 7);
  return {__builtin_shufflevector(xz_ab, xz_cd, 0, 1, 4, 5),
          __builtin_shufflevector(y_ab, y_cd, 0, 1, 4, 5),
          __builtin_shufflevector(xz_ab, xz_cd, 2, 3, 6, 7)};
}
inline std::array<Vec<double>, lane_count> LaneVec::each() const noexcept {
  const Lanes none{};
  const Lanes xy_ac = __builtin_shufflevector(x, y, 0, 4, 2, 6);
  const Lanes xy_bd = __builtin_shufflevector(x, y, 1, 5, 3, 7);
  const Lanes z_ac = __builtin_shufflevector(z, none, 0, 4, 2, 6);
  const Lanes z_bd = __builtin_shufflevector(z, none, 1, 5, 3, 7);
  return {Vec<double>(__builtin_shufflevector(xy_ac, z_ac, 0, 1, 4, 5)),
          Vec<double>(__builtin_shufflevector(xy_bd, z_bd, 0, 1, 4, 5)),
          Vec<double>(__builtin_shufflevector(xy_ac, z_ac, 2, 3, 6, 7)),
          Vec<double>(__builtin_shufflevector(xy_bd, z_bd, 2, 3, 6, 7))};
}
#else
template <class F>
LaneVec LaneVec::of(const F& v) noexcept {
  LaneVec lanes;
  for (int k = 0; k < lane_count; ++k) {
    const Vec<double> one = v(k);
    lanes.x[k] = one.x();
    lanes.y[k] = one.y();
    lanes.z[k] = one.z();
  }
  return lanes;
}
inline std::array<Vec<double>, lane_count> LaneVec::each() const noexcept {
  std::array<Vec<double>, lane_count> all;
  for (int k = 0; k < lane_count; ++k) all[static_cast<std::size_t>(k)] = {x[k], y[k], z[k]};
  return all;
}
#endif

/// One pose per lane: the columns of the rotation and the translation [m].
struct LanePose {
  std::array<LaneVec, 4> columns;

  /// The same pose in all lanes.
  [[nodiscard]] static LanePose all(const Pose& X) noexcept {
    return {LaneVec::all(column<double>(X, 0)), LaneVec::all(column<double>(X, 1)),
            LaneVec::all(column<double>(X, 2)), LaneVec::all(column<double>(X, 3))};
  }
  /// The pose X[k] in lane k.
  [[nodiscard]] static LanePose of(const std::array<const Pose*, lane_count>& X) noexcept {
    const auto columns_of = [&](int c) {
      return LaneVec::of([&](int k) { return column<double>(*X[static_cast<std::size_t>(k)], c); });
    };
    return {columns_of(0), columns_of(1), columns_of(2), columns_of(3)};
  }
  /// Stores `X` in lane k.
  void set(int k, const Pose& X) noexcept {
    for (int c = 0; c < 4; ++c) columns[c].set(k, column<double>(X, c));
  }
  [[nodiscard]] LaneVec rotate(const LaneVec& v) const noexcept {
    return v.x * columns[0] + v.y * columns[1] + v.z * columns[2];
  }
  [[nodiscard]] LaneVec rotate_transposed(const LaneVec& v) const noexcept {
    return {dot(columns[0], v), dot(columns[1], v), dot(columns[2], v)};
  }
  /// The poses X Y.
  friend LanePose composed(const LanePose& X, const LanePose& Y) noexcept {
    return {X.rotate(Y.columns[0]), X.rotate(Y.columns[1]), X.rotate(Y.columns[2]),
            X.rotate(Y.columns[3]) + X.columns[3]};
  }
};

}  // namespace repel::detail
