/// @file
/// The quick search for the features of two convex sets that are nearest to each other.
#pragma once

#include <array>
#include <bit>
#include <limits>

#include <repel/distance/feature.hpp>

namespace repel::detail {

/// GJK in double, with no care for what rounding does to the choice of features: what it finds is a
/// guess, and counts only when `proves` accepts it. What is rejected - overlap, contact, needles -
/// is left to the careful search of gjk.hpp.
class FeatureSearch {
 public:
  static constexpr int cap = 40;  ///< support-map pairs; the careful search takes over then

  explicit FeatureSearch(const PosedPair& pair) noexcept : pair_(pair) {}

  /// True when `gap` is the proven answer. In any case the names of the last feature are left in
  /// `warm`, which may hold points to begin with, and the support-map pairs evaluated in `gap`.
  [[nodiscard, gnu::flatten, gnu::noinline]] bool run(const QueryOptions& options, WarmStart& warm,
                                                      Gap& gap) noexcept {
    gap.iterations = begin(warm);
    const double margin = pair_.margin();
    const int last = std::min(cap, options.iterations);
    bool found = false;
    while (gap.iterations < last) {
      const Corner n = support(v_);
      ++gap.iterations;
      const double vw = dot(v_, n.w);
      const bool far = vw > (options.ignore_beyond + 2.0 * margin) * std::sqrt(vv_);
      if (far || vv_ - vw <= options.tolerance * vv_ || holds(n)) {
        found = accept(vw, margin, options, gap);
        break;
      }
      if (!approach(n)) break;
    }
    warm.size = static_cast<std::uint8_t>(size_);
    for (int i = 0; i < size_; ++i) {
      warm.a[i] = corners_[i].name_a;
      warm.b[i] = corners_[i].name_b;
    }
    return found;
  }

 private:
  struct Corner {
    Vec<double> a;  ///< [m] point of A, from the origin of A, world axes
    Vec<double> w;  ///< [m] a - b
    std::uint32_t name_a = 0;
    std::uint32_t name_b = 0;
  };
  /// The point nearest to the origin on a feature that has the newest corner, and which of the
  /// older corners it has, a bit each.
  struct Candidate {
    Vec<double> v{};
    double vv = std::numeric_limits<double>::infinity();
    unsigned older = 0;
  };

  [[nodiscard]] Corner corner(const Convex::Point<double>& a,
                              const Convex::Point<double>& b) const noexcept {
    Corner c;
    c.a = rotate(pair_.X_WA, a.p);
    c.w = c.a - (rotate(pair_.X_WB, b.p) + pair_.p_AB);
    c.name_a = a.name;
    c.name_b = b.name;
    return c;
  }
  [[nodiscard]] Corner support(const Vec<double>& v) const noexcept {
    return corner(pair_.A.support(rotate_transposed(pair_.X_WA, -v)),
                  pair_.B.support(rotate_transposed(pair_.X_WB, v)));
  }

  [[nodiscard]] bool holds(const Corner& n) const noexcept {
    for (int i = 0; i < size_; ++i) {
      if (corners_[i].name_a == n.name_a && corners_[i].name_b == n.name_b) return true;
    }
    return false;
  }

  /// The number of support-map pairs evaluated.
  int begin(const WarmStart& warm) noexcept {
    size_ = 1;
    const bool cold = warm.size == 0;
    corners_[0] =
        cold ? support(-pair_.p_AB) : corner(pair_.A.point(warm.a[0]), pair_.B.point(warm.b[0]));
    v_ = corners_[0].w;
    vv_ = dot(v_, v_);
    for (int i = 1; i < std::min<int>(warm.size, 3); ++i) {
      const Corner n = corner(pair_.A.point(warm.a[i]), pair_.B.point(warm.b[i]));
      if (!holds(n)) approach(n);
    }
    return cold ? 1 : 0;
  }

  [[nodiscard]] bool accept(double vw, double margin, const QueryOptions& options,
                            Gap& gap) const noexcept {
    Feature f;
    f.size = size_;
    for (int i = 0; i < size_; ++i) {
      f.a[i] = corners_[i].a;
      f.w[i] = corners_[i].w;
    }
    return proves(f, {v_, foot_on(f).weights}, vw, margin, options, options.ignore_beyond, gap);
  }

  /// Moves to the nearest feature that has `n`; false when none is nearer than the present one, or
  /// when the corners enclose the origin.
  bool approach(const Corner& n) noexcept {
    const Candidate best = size_ == 1   ? on_edge(0, n.w)
                           : size_ == 2 ? on_face(0, 1, n.w, normal(0, 1, n.w))
                                        : on_tetrahedron(n.w);
    if (!(best.vv < vv_)) return false;
    // By the bits of the older corners kept, at most two: the first, the second, and how many.
    static constexpr std::array<std::array<std::uint8_t, 3>, 7> kept{
        {{0, 0, 0}, {0, 0, 1}, {1, 1, 1}, {0, 1, 2}, {2, 2, 1}, {0, 2, 2}, {1, 2, 2}}};
    const auto [first, second, count] = kept[best.older];
    corners_[0] = corners_[first];
    corners_[1] = corners_[second];
    corners_[count] = n;
    size_ = count + 1;
    v_ = best.v;
    vv_ = best.vv;
    return true;
  }

  [[nodiscard]] Vec<double> normal(int i, int j, const Vec<double>& n) const noexcept {
    return cross(corners_[i].w - n, corners_[j].w - n);
  }

  [[nodiscard]] Candidate on_edge(int i, const Vec<double>& n) const noexcept {
    const Vec<double> e = corners_[i].w - n;
    const double along = -dot(n, e);
    const double nn = dot(n, n);
    if (!(along > 0.0)) return {n, nn, 0U};
    const double scale = 1.0 / dot(e, e);
    Vec<double> v = n + (scale * along) * e;
    // Near contact the first product is right to the size, not to the gap.
    if (dot(v, v) < 1e-3 * nn) v = v - (scale * dot(v, e)) * e;
    return {v, dot(v, v), 1U << static_cast<unsigned>(i)};
  }

  [[nodiscard]] Candidate on_face(int i, int j, const Vec<double>& n,
                                  const Vec<double>& normal) const noexcept {
    const Vec<double>& p = corners_[i].w;
    const Vec<double>& q = corners_[j].w;
    const Vec<double> areas = dots(cross(q, n), cross(n, p), cross(p, q), normal);
    Candidate best;
    if (areas.x() > 0.0 && areas.y() > 0.0) {
      if (!(areas.z() > 0.0)) return best;
      best.v = (dot(normal, n) / dot(normal, normal)) * normal;
      best.vv = dot(best.v, best.v);
      best.older = 1U << static_cast<unsigned>(i) | 1U << static_cast<unsigned>(j);
      return best;
    }
    if (!(areas.x() > 0.0)) best = on_edge(j, n);
    if (areas.y() > 0.0) return best;
    const Candidate other = on_edge(i, n);
    return other.vv < best.vv ? other : best;
  }

  // Seen from n, the other three corners span the volume e0 x e1 . e2 whichever comes first, so one
  // product with each normal tells on which side of its face the origin lies.
  [[nodiscard]] Candidate on_tetrahedron(const Vec<double>& n) const noexcept {
    const std::array<Vec<double>, 3> e{corners_[0].w - n, corners_[1].w - n, corners_[2].w - n};
    const std::array<Vec<double>, 3> normals{cross(e[0], e[1]), cross(e[1], e[2]),
                                             cross(e[2], e[0])};
    const double volume = dot(normals[0], e[2]);
    unsigned outside = ~minus_signs(volume * dots(normals[0], normals[1], normals[2], n)) & 7U;
    Candidate best;
    for (; outside != 0U; outside &= outside - 1U) {
      const int i = std::countr_zero(outside);
      const Candidate found = on_face(i, i == 2 ? 0 : i + 1, n, normals[i]);
      if (found.vv < best.vv) best = found;
    }
    return best;
  }

  PosedPair pair_;
  std::array<Corner, 4> corners_;
  int size_ = 0;
  Vec<double> v_;    ///< [m] the point of the corners' hull nearest to the origin
  double vv_ = 0.0;  ///< [m^2]
};

}  // namespace repel::detail
