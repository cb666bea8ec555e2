// SPDX-License-Identifier: BSD-3-Clause
#include <repel/network/elements/fixture_path.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include <repel/base/setup_error.hpp>

namespace repel::network {

FixturePath::FixturePath(const std::vector<Vec3>& points, const std::vector<Mat3>& frames,
                         Course course) {
  checked("number of points of a path", static_cast<double>(points.size()), 2, most_points, "");
  if (!frames.empty() && frames.size() != points.size()) {
    throw SetupError("a path of " + std::to_string(points.size()) + " points has " +
                     std::to_string(frames.size()) + " frames; allowed: none or one for each");
  }
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    const Vec3 chord = points[i + 1] - points[i];
    Piece& piece = pieces_.emplace_back();
    piece.length = checked("distance of two points of a path", norm(chord), 1e-4, 1e3, "m");
    piece.p = points[i];
    piece.first = chord / piece.length;
    if (frames.empty()) continue;
    piece.R = frames[i];
    const Eigen::AngleAxisd turn(Mat3(frames[i + 1] * transposed(frames[i])));
    piece.turn = turn.angle() * turn.axis();
  }
  if (course == Course::spline) bend();
  has_frames_ = !frames.empty();
}

PathPoint FixturePath::at(const PathPlace& place) const noexcept {
  const Piece& c = pieces_[place.piece];
  const double u = place.along;
  return {c.p + u * (c.first + u * (c.second + u * c.third)),
          c.first + u * (2.0 * c.second + 3.0 * u * c.third), 2.0 * c.second + 6.0 * u * c.third};
}

Mat3 FixturePath::frame(const PathPlace& place) const noexcept {
  const Piece& c = pieces_[place.piece];
  const double turn = norm(c.turn);
  if (!(turn > 0.0)) return c.R;
  const double share = place.along / c.length;
  const double angle = turn * share * share * (3.0 - 2.0 * share);
  return Mat3(Eigen::AngleAxisd(angle, c.turn / turn).toRotationMatrix()) * c.R;
}

Vec3 FixturePath::turning(const PathPlace& place) const noexcept {
  const Piece& c = pieces_[place.piece];
  const double share = place.along / c.length;
  return 6.0 * share * (1.0 - share) / c.length * c.turn;
}

bool FixturePath::is_at_corner(const PathPlace& place) const noexcept {
  return place.along <= 0.0 || place.along >= pieces_[place.piece].length;
}

PathPlace FixturePath::nearest(const Vec3& x) const noexcept {
  PathPlace best;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < pieces_.size(); ++i) {
    constexpr double samples = 8.0;  // a spline leaves its chord
    const double spacing = pieces_[i].length / samples;
    PathPlace place{i, 0.0};
    double here = std::numeric_limits<double>::infinity();
    for (double k = 0.0; k <= samples; k += 1.0) {
      const double distance = norm(x - at({i, k * spacing}).p_W);
      if (distance < here) here = distance, place = {i, k * spacing};
    }
    if (!(here - spacing < least)) continue;
    for (int step = 0; step < 8; ++step) place = descended(place, x);
    const double reached = norm(x - at(place).p_W);
    if (reached < least) least = reached, best = place;
  }
  return best;
}

PathPlace FixturePath::followed(const PathPlace& from, const Vec3& x, double most) const noexcept {
  if (!(most > 0.0)) return from;
  const Vec3 start = at(from).p_W;
  PathPlace place = from;
  for (int step = 0; step < 4; ++step) {
    const PathPlace next = descended(place, x);
    if (next == place) break;
    const double moved = norm(at(next).p_W - start);
    if (moved > most) return part_way(place, next, start, most, x);
    place = next;
  }
  return place;
}

void FixturePath::bend() {
  const std::size_t n = pieces_.size();
  std::vector<Vec3> m(n + 1, Vec3(0, 0, 0));
  std::vector<double> share(n + 1, 0.0);
  for (std::size_t i = 1; i < n; ++i) {
    const double before = pieces_[i - 1].length, after = pieces_[i].length;
    const double pivot = 2.0 * (before + after) - before * share[i - 1];
    share[i] = after / pivot;
    m[i] = (6.0 * (pieces_[i].first - pieces_[i - 1].first) - before * m[i - 1]) / pivot;
  }
  for (std::size_t i = n; i-- > 1;) m[i] = m[i] - share[i] * m[i + 1];
  for (std::size_t i = 0; i < n; ++i) {
    Piece& c = pieces_[i];
    c.first = c.first - c.length / 6.0 * (2.0 * m[i] + m[i + 1]);
    c.second = 0.5 * m[i];
    c.third = (m[i + 1] - m[i]) / (6.0 * c.length);
  }
}

PathPlace FixturePath::descended(const PathPlace& from, const Vec3& x) const noexcept {
  const PathPlace place = turned_to(from, x);
  const PathPoint here = at(place);
  const Vec3 away = here.p_W - x;
  const double slope = dot(away, here.first_W);
  const double square = squared_norm(here.first_W);
  if (std::abs(slope) < 1e-15 * std::sqrt(square)) return from;
  const double curvature = std::max(square + dot(away, here.second_W), 0.25 * square);
  double step = -slope / curvature;
  const double length = pieces_[place.piece].length;
  for (int halved = 0; halved < 6; ++halved, step *= 0.5) {
    const PathPlace next{place.piece, std::clamp(place.along + step, 0.0, length)};
    if (squared_norm(at(next).p_W - x) <= squared_norm(away)) return next;
  }
  return from;
}

PathPlace FixturePath::turned_to(const PathPlace& place, const Vec3& x) const noexcept {
  const auto slope_at = [&](const PathPlace& there) {
    const PathPoint point = at(there);
    return dot(point.p_W - x, point.first_W);
  };
  if (place.along <= 0.0 && place.piece > 0 && slope_at(place) > 0.0) {
    const PathPlace other{place.piece - 1, pieces_[place.piece - 1].length};
    if (slope_at(other) > 0.0) return other;
  }
  if (place.along >= pieces_[place.piece].length && place.piece + 1 < pieces_.size() &&
      slope_at(place) < 0.0) {
    const PathPlace other{place.piece + 1, 0.0};
    if (slope_at(other) < 0.0) return other;
  }
  return place;
}

PathPlace FixturePath::part_way(const PathPlace& place, const PathPlace& next, const Vec3& start,
                                double most, const Vec3& x) const noexcept {
  const PathPlace begin =
      next.piece == place.piece
          ? place
          : PathPlace{next.piece, next.piece > place.piece ? 0.0 : pieces_[next.piece].length};
  double low = 0.0, high = 1.0;
  const auto between = [&](double share) {
    return PathPlace{next.piece, begin.along + share * (next.along - begin.along)};
  };
  for (int i = 0; i < 24; ++i) {
    const double middle = 0.5 * (low + high);
    (norm(at(between(middle)).p_W - start) > most ? high : low) = middle;
  }
  const PathPlace found = between(low);
  return squared_norm(at(found).p_W - x) <= squared_norm(at(place).p_W - x) ? found : place;
}

}  // namespace repel::network
