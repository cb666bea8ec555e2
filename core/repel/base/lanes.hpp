// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// SIMD: four numbers in the registers of the target, for code that works on several vertices or
/// pairs at once.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <type_traits>

#include <repel/base/vec.hpp>

namespace repel::detail {

/// On every processor: all units make the same sums in the same order, and types have the same
/// layout, at any register width.
inline constexpr int lane_count = 4;
inline constexpr int lane_bytes = 8 * lane_count;
#if defined(__AVX__)
inline constexpr int register_bytes = 32;
#else
inline constexpr int register_bytes = 16;
#endif

using DoubleRegister = double __attribute__((vector_size(register_bytes)));
using MaskRegister = std::int64_t __attribute__((vector_size(register_bytes)));

template <class Number>
struct Wide;
using Lanes = Wide<double>;
/// All bits of a lane are set, or none: the result of comparing Lanes.
using LaneMask = Wide<std::int64_t>;

/// f of the registers of each of `a`.
template <class Result, class F, class... A>
[[gnu::always_inline, nodiscard]] inline Result by_register(const F& f, const A&... a) noexcept {
#if defined(__AVX__)
  return {f(a.whole...)};
#else
  return {f(a.low...), f(a.high...)};
#endif
}

/// Four numbers, in one register or in two.
template <class Number>
struct alignas(lane_bytes) Wide {
  using Register = std::conditional_t<std::is_same_v<Number, double>, DoubleRegister, MaskRegister>;
#if defined(__AVX__)
  Register whole;
#else
  Register low, high;
#endif

  [[nodiscard]] Number operator[](int k) const noexcept {
    return reinterpret_cast<const Number*>(this)[k];
  }
  [[nodiscard]] Number& operator[](int k) noexcept {
    return reinterpret_cast<Number*>(this)[k];
  }

  /// x in every lane.
  [[nodiscard]] static Wide all(Number x) noexcept {
    const Register one = x - Register{};
#if defined(__AVX__)
    return {one};
#else
    return {one, one};
#endif
  }

  [[nodiscard]] friend Wide operator+(const Wide& a, const Wide& b) noexcept {
    return by_register<Wide>([](const auto& x, const auto& y) { return x + y; }, a, b);
  }
  [[nodiscard]] friend Wide operator-(const Wide& a, const Wide& b) noexcept {
    return by_register<Wide>([](const auto& x, const auto& y) { return x - y; }, a, b);
  }
  [[nodiscard]] friend Wide operator*(const Wide& a, const Wide& b) noexcept {
    return by_register<Wide>([](const auto& x, const auto& y) { return x * y; }, a, b);
  }
  [[nodiscard]] friend Wide operator/(const Wide& a, const Wide& b) noexcept {
    return by_register<Wide>([](const auto& x, const auto& y) { return x / y; }, a, b);
  }
  [[nodiscard]] friend Wide operator-(const Wide& a) noexcept {
    return by_register<Wide>([](const auto& x) { return -x; }, a);
  }
  [[nodiscard]] friend Wide operator+(const Wide& a, Number b) noexcept {
    return a + all(b);
  }
  [[nodiscard]] friend Wide operator+(Number a, const Wide& b) noexcept {
    return all(a) + b;
  }
  [[nodiscard]] friend Wide operator-(const Wide& a, Number b) noexcept {
    return a - all(b);
  }
  [[nodiscard]] friend Wide operator-(Number a, const Wide& b) noexcept {
    return all(a) - b;
  }
  [[nodiscard]] friend Wide operator*(const Wide& a, Number b) noexcept {
    return a * all(b);
  }
  [[nodiscard]] friend Wide operator*(Number a, const Wide& b) noexcept {
    return all(a) * b;
  }
  [[nodiscard]] friend Wide operator/(const Wide& a, Number b) noexcept {
    return a / all(b);
  }
  [[nodiscard]] friend Wide operator/(Number a, const Wide& b) noexcept {
    return all(a) / b;
  }

  [[nodiscard]] friend LaneMask operator<(const Wide& a, const Wide& b) noexcept {
    return by_register<LaneMask>([](const auto& x, const auto& y) { return (MaskRegister)(x < y); },
                                 a, b);
  }
  [[nodiscard]] friend LaneMask operator<=(const Wide& a, const Wide& b) noexcept {
    return by_register<LaneMask>(
        [](const auto& x, const auto& y) { return (MaskRegister)(x <= y); }, a, b);
  }
  [[nodiscard]] friend LaneMask operator==(const Wide& a, const Wide& b) noexcept {
    return by_register<LaneMask>(
        [](const auto& x, const auto& y) { return (MaskRegister)(x == y); }, a, b);
  }
  [[nodiscard]] friend LaneMask operator>(const Wide& a, const Wide& b) noexcept {
    return b < a;
  }
  [[nodiscard]] friend LaneMask operator>=(const Wide& a, const Wide& b) noexcept {
    return b <= a;
  }
  [[nodiscard]] friend LaneMask operator<(const Wide& a, Number b) noexcept {
    return a < all(b);
  }
  [[nodiscard]] friend LaneMask operator<=(const Wide& a, Number b) noexcept {
    return a <= all(b);
  }
  [[nodiscard]] friend LaneMask operator>(const Wide& a, Number b) noexcept {
    return a > all(b);
  }
  [[nodiscard]] friend LaneMask operator>=(const Wide& a, Number b) noexcept {
    return a >= all(b);
  }
  [[nodiscard]] friend LaneMask operator==(const Wide& a, Number b) noexcept {
    return a == all(b);
  }

  [[nodiscard]] friend Wide operator&(const Wide& a, const Wide& b) noexcept {
    return by_register<Wide>([](const auto& x, const auto& y) { return x & y; }, a, b);
  }
  [[nodiscard]] friend Wide operator|(const Wide& a, const Wide& b) noexcept {
    return by_register<Wide>([](const auto& x, const auto& y) { return x | y; }, a, b);
  }
  [[nodiscard]] friend Wide operator~(const Wide& a) noexcept {
    return by_register<Wide>([](const auto& x) { return ~x; }, a);
  }
};

[[nodiscard]] inline Lanes four(double a, double b, double c, double d) noexcept {
#if defined(__AVX__)
  return Lanes{DoubleRegister{a, b, c, d}};
#else
  return Lanes{DoubleRegister{a, b}, DoubleRegister{c, d}};
#endif
}
/// x in every lane.
[[nodiscard]] inline Lanes all_of(double x) noexcept {
  return Lanes::all(x);
}
/// f(k) in lane k.
template <class F>
[[nodiscard]] Lanes lanes_of(const F& f) noexcept {
  return four(f(0), f(1), f(2), f(3));
}

/// `a` in the lanes of `first`, `b` in the others.
[[nodiscard]] inline Lanes either(const LaneMask& first, const Lanes& a, const Lanes& b) noexcept {
  return by_register<Lanes>([](const auto& m, const auto& x, const auto& y) { return m ? x : y; },
                            first, a, b);
}
/// The larger in each lane; b where one of the two is NaN.
[[nodiscard]] inline Lanes larger(const Lanes& a, const Lanes& b) noexcept {
#if defined(__AVX__)
  return {__builtin_ia32_maxpd256(a.whole, b.whole)};
#elif defined(__SSE2__)
  return {__builtin_ia32_maxpd(a.low, b.low), __builtin_ia32_maxpd(a.high, b.high)};
#else
  return either(a > b, a, b);
#endif
}
/// The smaller in each lane; b where one of the two is NaN.
[[nodiscard]] inline Lanes smaller(const Lanes& a, const Lanes& b) noexcept {
#if defined(__AVX__)
  return {__builtin_ia32_minpd256(a.whole, b.whole)};
#elif defined(__SSE2__)
  return {__builtin_ia32_minpd(a.low, b.low), __builtin_ia32_minpd(a.high, b.high)};
#else
  return either(a < b, a, b);
#endif
}
[[nodiscard]] inline Lanes magnitudes(const Lanes& a) noexcept {
  return by_register<Lanes>(
      [](const auto& x) {
        return (DoubleRegister)((MaskRegister)x & std::int64_t{0x7FFFFFFFFFFFFFFF});
      },
      a);
}
[[nodiscard]] inline Lanes roots(const Lanes& a) noexcept {
#if defined(__clang__) || !defined(__SSE2__)
  // The builtin functions of clang differ from version to version.
  return lanes_of([&](int k) { return std::sqrt(a[k]); });
#elif defined(__AVX__)
  return {__builtin_ia32_sqrtpd256(a.whole)};
#else
  return {__builtin_ia32_sqrtpd(a.low), __builtin_ia32_sqrtpd(a.high)};
#endif
}
// In halves: a chain through all lanes would be waited for.
[[nodiscard]] inline double largest_of(const Lanes& a) noexcept {
  return std::max(std::max(a[0], a[2]), std::max(a[1], a[3]));
}
[[nodiscard]] inline double least_of(const Lanes& a) noexcept {
  return std::min(std::min(a[0], a[2]), std::min(a[1], a[3]));
}
/// Bit k is set when the mask of lane k is set.
[[nodiscard]] inline unsigned bits_of(const LaneMask& mask) noexcept {
#if defined(__AVX__)
  return static_cast<unsigned>(__builtin_ia32_movmskpd256((DoubleRegister)mask.whole));
#elif defined(__SSE2__)
  return static_cast<unsigned>(__builtin_ia32_movmskpd((DoubleRegister)mask.low) |
                               __builtin_ia32_movmskpd((DoubleRegister)mask.high) << 2);
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
    return {either(first, a.x, b.x), either(first, a.y, b.y), either(first, a.z, b.z)};
  }
};

#if defined(__AVX__)
template <class F>
LaneVec LaneVec::of(const F& v) noexcept {
  const auto a = v(0).lanes();
  const auto b = v(1).lanes();
  const auto c = v(2).lanes();
  const auto d = v(3).lanes();
  const auto xz_ab = __builtin_shufflevector(a, b, 0, 4, 2, 6);
  const auto xz_cd = __builtin_shufflevector(c, d, 0, 4, 2, 6);
  const auto y_ab = __builtin_shufflevector(a, b, 1, 5, 3, 7);
  const auto y_cd = __builtin_shufflevector(c, d, 1, 5, 3, 7);
  return {Lanes{__builtin_shufflevector(xz_ab, xz_cd, 0, 1, 4, 5)},
          Lanes{__builtin_shufflevector(y_ab, y_cd, 0, 1, 4, 5)},
          Lanes{__builtin_shufflevector(xz_ab, xz_cd, 2, 3, 6, 7)}};
}
inline std::array<Vec<double>, lane_count> LaneVec::each() const noexcept {
  const DoubleRegister none{};
  const auto xy_ac = __builtin_shufflevector(x.whole, y.whole, 0, 4, 2, 6);
  const auto xy_bd = __builtin_shufflevector(x.whole, y.whole, 1, 5, 3, 7);
  const auto z_ac = __builtin_shufflevector(z.whole, none, 0, 4, 2, 6);
  const auto z_bd = __builtin_shufflevector(z.whole, none, 1, 5, 3, 7);
  return {Vec<double>(__builtin_shufflevector(xy_ac, z_ac, 0, 1, 4, 5)),
          Vec<double>(__builtin_shufflevector(xy_bd, z_bd, 0, 1, 4, 5)),
          Vec<double>(__builtin_shufflevector(xy_ac, z_ac, 2, 3, 6, 7)),
          Vec<double>(__builtin_shufflevector(xy_bd, z_bd, 2, 3, 6, 7))};
}
#else
template <class F>
LaneVec LaneVec::of(const F& v) noexcept {
  const Vec<double> a = v(0);
  const Vec<double> b = v(1);
  const Vec<double> c = v(2);
  const Vec<double> d = v(3);
  return {four(a.x(), b.x(), c.x(), d.x()), four(a.y(), b.y(), c.y(), d.y()),
          four(a.z(), b.z(), c.z(), d.z())};
}
inline std::array<Vec<double>, lane_count> LaneVec::each() const noexcept {
  const auto one = [this](int k) { return Vec<double>(x[k], y[k], z[k]); };
  return {one(0), one(1), one(2), one(3)};
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
