// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The fast search for the nearest features of two convex sets.
#pragma once

#include <array>
#include <bit>
#include <limits>

#include <repel/distance/feature.hpp>
#include <repel/geometry/turned.hpp>

namespace repel::detail {

/// GJK in double, without safeguards against rounding in the choice of features: its result is a
/// candidate, valid only when `proves` accepts it. What is rejected - overlap, contact, needles -
/// is left to the robust search of gjk.hpp.
class FeatureSearch {
 public:
  static constexpr int cap = 40;  ///< limit of support-map pairs, then the robust search takes over

  explicit FeatureSearch(const PosedPair& pair) noexcept
      : A_(pair.A, pair.X_WA), B_(pair.B, pair.X_WB), p_AB_(pair.p_AB), margin_(pair.margin()) {}

  /// True when `gap` is the proven result. In any case `warm`, which may hold points initially,
  /// receives the names of the last feature, and `gap` the number of support-map pairs evaluated.
  /// Four names: these corners enclose the origin but for rounding, so the sets seem to intersect.
  [[nodiscard, gnu::flatten, gnu::noinline]] bool run(const QueryOptions& options, WarmStart& warm,
                                                      Gap& gap) noexcept {
    gap.iterations = begin(warm);
    const int last = std::min(cap, options.iterations);
    const double beyond = options.ignore_beyond + 2.0 * margin_;
    bool found = false;
    bool stuck = false;
    while (gap.iterations < last && !stuck) {
      Corner& n = corners_[slots().free];
      n = support(d_);
      ++gap.iterations;
      const double vw = scale_ * dot(d_, n.w);
      const double length = std::sqrt(vv_);
      // A corner found again gives v.w = v.v except for rounding.
      const bool nearest = vv_ - vw <= std::max(options.tolerance * vv_, margin_ * length);
      if (nearest || vw > beyond * length) {
        found = accept(vw, options, gap);
        break;
      }
      stuck = !approach(n);
    }
    const Slots in_use = slots();
    const bool encloses = stuck && in_use.count == 3;
    const std::array<std::uint8_t, 4> named{in_use.older[0], in_use.older[1], in_use.older[2],
                                            encloses ? in_use.free : in_use.older[2]};
    warm.size = encloses ? 4 : in_use.count;
    for (std::size_t i = 0; i < 4; ++i) {
      warm.a[i] = corners_[named[i]].name_a;
      warm.b[i] = corners_[named[i]].name_b;
    }
    return found;
  }

 private:
  struct Corner {
    Vec<double> a;  ///< [m] point of A, from the origin of A, world axes
    Vec<double> w;  ///< [m] a - b
    std::uint32_t name_a;
    std::uint32_t name_b;
  };
  /// The use of the four corner slots: `count` of them in use, at most three, listed in `older`
  /// with the last one repeated, and one free slot.
  struct Slots {
    std::array<std::uint8_t, 3> older;
    std::uint8_t count;
    std::uint8_t free;
  };
  [[nodiscard]] const Slots& slots() const noexcept {
    static constexpr std::array<Slots, 16> by_bits = [] {
      std::array<Slots, 16> all{};
      for (unsigned bits = 1; bits < 15; ++bits) {
        Slots& s = all[bits];
        for (std::uint8_t slot = 0; slot < 4; ++slot) {
          if ((bits >> slot & 1U) == 0U) {
            s.free = slot;
          } else if (s.count < 3) {
            for (std::size_t k = s.count; k < 3; ++k) s.older[k] = slot;
            ++s.count;
          }
        }
      }
      return all;
    }();
    return by_bits[in_use_];
  }

  [[nodiscard]] Corner corner(const Turned::Point& a, const Turned::Point& b) const noexcept {
    return {a.p, a.p - (b.p + p_AB_), a.name, b.name};
  }
  [[nodiscard]] Corner support(const Vec<double>& v) const noexcept {
    return corner(A_.support(-v), B_.support(v));
  }

  /// Initializes the feature. Returns the number of support-map pairs evaluated.
  int begin(const WarmStart& warm) noexcept {
    const bool cold = warm.size == 0;
    corners_[0] = cold ? support(-p_AB_) : corner(A_.point(warm.a[0]), B_.point(warm.b[0]));
    vv_ = std::numeric_limits<double>::infinity();
    newest_ = 1U;
    offer_corner(corners_[0].w);
    for (std::size_t i = 1; i < std::min<std::size_t>(warm.size, 3); ++i) {
      Corner& n = corners_[slots().free];
      n = corner(A_.point(warm.a[i]), B_.point(warm.b[i]));
      approach(n);
    }
    return cold ? 1 : 0;
  }

  [[nodiscard]] bool accept(double vw, const QueryOptions& options, Gap& gap) const noexcept {
    const Slots& in_use = slots();
    const auto& [p, q, r] = in_use.older;
    const Feature f{{corners_[p].a, corners_[q].a, corners_[r].a},
                    {corners_[p].w, corners_[q].w, corners_[r].w},
                    in_use.count};
    return prove(f, {scale_ * d_, foot_on(f).weights}, vw, margin_, options, options.ignore_beyond,
                 gap);
  }

  /// Moves to the nearest feature containing `n`, the corner in the free slot; false if none is
  /// nearer, or if the corners enclose the origin.
  bool approach(const Corner& n) noexcept {
    const Slots& in_use = slots();
    const auto& [i, j, k] = in_use.older;
    newest_ = 1U << in_use.free;
    if (in_use.count == 1) {
      offer_edge(i, n.w);
    } else if (in_use.count == 2) {
      offer_face(i, j, n.w, cross(corners_[i].w - n.w, corners_[j].w - n.w));
    } else {
      offer_tetrahedron(i, j, k, n.w);
    }
    return (in_use_ & newest_) != 0U;
  }

  /// Offers a feature made of the newest corner and the `older` ones, one bit per slot, with its
  /// point v = `scale` `d` nearest to the origin and vv = v.v [m^2]. The nearest one offered is
  /// kept.
  void offer(const Vec<double>& d, double scale, double vv, unsigned older) noexcept {
    if (!(vv < vv_)) return;
    d_ = d;
    scale_ = scale;
    vv_ = vv;
    in_use_ = older | newest_;
  }
  void offer_corner(const Vec<double>& n) noexcept { offer(n, 1.0, dot(n, n), 0U); }

  void offer_edge(int i, const Vec<double>& n) noexcept {
    const Vec<double> e = corners_[i].w - n;
    const double along = -dot(n, e);
    if (!(along > 0.0)) return offer_corner(n);
    const double ee = dot(e, e);
    const double scale = 1.0 / ee;
    Vec<double> d = ee * n + along * e;
    // Near contact, the error of the first dot product is relative to the size, not to the gap.
    if (dot(d, d) < 1e-3 * ee * along * along) d = d - (scale * dot(d, e)) * e;
    offer(d, scale, scale * dot(d, d) * scale, bit(i));
  }

  void offer_face(int i, int j, const Vec<double>& n, const Vec<double>& normal) noexcept {
    const Vec<double>& p = corners_[i].w;
    const Vec<double>& q = corners_[j].w;
    const Vec<double> areas = dots(cross(q, n), cross(n, p), cross(p, q), normal);
    if (areas.x() > 0.0 && areas.y() > 0.0) {
      const double height = dot(normal, n);
      const double scale = std::abs(height) / dot(normal, normal);
      if (areas.z() > 0.0) {
        offer(std::copysign(1.0, height) * normal, scale, scale * std::abs(height),
              bit(i) | bit(j));
      }
      return;
    }
    if (!(areas.x() > 0.0)) offer_edge(j, n);
    if (!(areas.y() > 0.0)) offer_edge(i, n);
  }

  // Seen from n, the other three corners span the volume e0 x e1 . e2 in any cyclic order, so one
  // dot product with each normal tells on which side of its face the origin lies.
  void offer_tetrahedron(int i, int j, int k, const Vec<double>& n) noexcept {
    const std::array<int, 4> around{i, j, k, i};
    const std::array<Vec<double>, 3> e{corners_[i].w - n, corners_[j].w - n, corners_[k].w - n};
    const std::array<Vec<double>, 3> normals{cross(e[0], e[1]), cross(e[1], e[2]),
                                             cross(e[2], e[0])};
    const double volume = dot(normals[0], e[2]);
    unsigned outside = ~minus_signs(volume * dots(normals[0], normals[1], normals[2], n)) & 7U;
    for (; outside != 0U; outside &= outside - 1U) {
      const int face = std::countr_zero(outside);
      offer_face(around[face], around[face + 1], n, normals[face]);
    }
  }

  [[nodiscard]] static unsigned bit(int slot) noexcept { return 1U << static_cast<unsigned>(slot); }

  Turned A_;
  Turned B_;
  Vec<double> p_AB_;  ///< [m] world axes
  double margin_;     ///< [m] error bound of a support value due to rounding
  std::array<Corner, 4> corners_;
  unsigned in_use_ = 0;  ///< one bit for each corner of the present feature
  unsigned newest_ = 0;  ///< the bit of the corner being added
  // The point v = scale d of that feature nearest to the origin. A support map needs only the
  // direction and does not have to wait for a division.
  Vec<double> d_;
  double scale_ = 0.0;
  double vv_ = 0.0;  ///< [m^2]
};

}  // namespace repel::detail
