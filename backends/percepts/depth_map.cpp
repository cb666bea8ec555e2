// SPDX-License-Identifier: BSD-3-Clause
#include <repel/octrees/depth_map.hpp>

#include <algorithm>
#include <bit>
#include <cmath>

#include <repel/base/setup_error.hpp>

namespace repel::octrees {
namespace {

constexpr int middle_cube = 32768;  // of OctoMap's count, that begins at the origin

// [log odds] What one image that sees through a cube takes from it.
constexpr double less = 0.4;

double probability(double log_odds) {
  return 1.0 - 1.0 / (1.0 + std::exp(log_odds));
}

// [px] Largest distance of rays.
constexpr unsigned most_step = 64;

/// [px] Distance of the widest grid of rays, up to `most_step`, that has one through this pixel.
unsigned widest_grid(int u, int v) {
  return 1U << std::countr_zero(static_cast<unsigned>(u | v) | most_step);
}

/// The faces of cubes across one axis that a ray meets. Where it meets them is counted in 2^-45 of
/// its length: whole numbers are compared and added in fewer cycles, and one cube after another
/// waits for both.
struct Faces {
  std::int64_t next, period;
  int at, step;  ///< the cube, counted along the axis

  /// Goes into the next cube where `is_next` has all its bits set, and stays where it has none:
  /// which axis is next cannot be predicted.
  void pass(std::int64_t is_next) {
    next += is_next & period;
    at += static_cast<int>(is_next) & step;
  }
};

/// All bits set, or none.
std::int64_t all_bits(bool are_set) {
  return -std::int64_t{are_set};
}

/// @param share of the length of a ray; it ends at 1, so what is beyond 2 is never met
std::int64_t counted(double share) {
  return static_cast<std::int64_t>(0x1p45 * std::clamp(share, -2.0, 2.0));
}

octomap::point3d point_of(const Vec3& p) {
  return {static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z())};
}

}  // namespace

DepthMap::DepthMap(const percepts::DepthCamera& camera, const DepthMapOptions& options)
    : camera_(percepts::checked(camera)),
      options_(options),
      tree_(repel::checked("edge of a cube", options.cube, 1e-3, 10.0, "m")) {
  repel::checked("slack", options.slack, 0.0, 0.25 * options.cube, "m");
  repel::checked("images until a cube is free", options.frees, 1, 1000, "");
  repel::checked("keeps", options.keeps, 0.0, 1e6, "s");
  const cover::CubeRange cubes = cubes_in(options_.region, options_.cube);
  places_ = 1;
  for (std::size_t k = 0; k < 3; ++k) {
    low_[k] = cubes.low[k] + middle_cube;
    size_[k] = static_cast<unsigned>(cubes.high[k] + 1 - cubes.low[k]);
    places_ *= size_[k];
  }
  marks_.assign(places_, Mark::none);
  states_.assign(places_, State::unknown);
  hit_at_.assign(places_, 0.0F);
  // A hit fills up, whatever there was; so many images take it all and a little more. What is free
  // is as free after one image as after many.
  const double most = less * (options.frees - 1);
  tree_.setOccupancyThres(probability(-0.5 * less));
  tree_.setProbHit(probability(most + 2.0 * less));
  tree_.setProbMiss(probability(-less));
  tree_.setClampingThresMax(probability(most));
  tree_.setClampingThresMin(probability(-less));
}

int DepthMap::insert(std::span<const float> depth, const Pose& X_WC, double time) {
  if (depth.size() < camera_.pixels()) return 0;
  marked_.clear();
  mark_pixels(depth, X_WC);
  int hits = 0;
  for (const octomap::OcTreeKey& key : marked_) {
    const std::size_t place = place_of(key);
    hits += marks_[place] == Mark::hit ? 1 : 0;
    settle(place, key, time);
    marks_[place] = Mark::none;
  }
  return hits;
}

void DepthMap::mark(const octomap::OcTreeKey& key, Mark what) {
  const std::size_t place = place_of(key);
  if (place == places_ || marks_[place] >= what) return;
  if (marks_[place] == Mark::none) marked_.push_back(key);
  marks_[place] = what;
}

void DepthMap::mark_pixels(std::span<const float> depth, const Pose& X_WC) {
  // [m px] Divided by a depth: the pixels across half a cube there.
  const double half_cube = 0.5 * options_.cube * std::min(camera_.fx, camera_.fy);
  for (int v = 0; v < camera_.height; ++v) {
    for (int u = 0; u < camera_.width; ++u) {
      const float z = depth[camera_.at(u, v)];
      const bool is_hit = camera_.measures(z);
      if (!is_hit && !camera_.measures(-z)) continue;
      const double far = std::abs(static_cast<double>(z));
      const octomap::point3d end = point_of(X_WC * (far * camera_.ray(u, v)));
      octomap::OcTreeKey key;
      if (!tree_.coordToKeyChecked(end, key)) continue;
      mark(is_hit ? taken_for(end, key) : key, is_hit ? Mark::hit : Mark::hidden);
      // Pixel stride whose footprint at this depth is half a cube. A power of two puts the rays of
      // farther surfaces between those of nearer ones.
      const double pixels = std::clamp(half_cube / far, 1.0, double{most_step});
      const unsigned grid = widest_grid(u, v);
      if (grid < std::bit_floor(static_cast<unsigned>(pixels))) continue;
      // Before this depth the rays of the next wider grid are less than half a cube apart. Those of
      // a cube wholly before a surface reach it, so this ray need not go there.
      const double begin = grid < most_step ? 0.5 * half_cube / grid : 0.0;
      mark_ray(point_of(X_WC * (begin * camera_.ray(u, v))), end);
    }
  }
}

bool DepthMap::is_taken(const octomap::OcTreeKey& key) const noexcept {
  const std::size_t place = place_of(key);
  if (place == places_) return false;
  return states_[place] == State::occupied || marks_[place] == Mark::hit;
}

octomap::OcTreeKey DepthMap::taken_for(const octomap::point3d& p,
                                       const octomap::OcTreeKey& own) const {
  if (options_.slack == 0.0 || is_taken(own)) return own;
  // The neighbours within the slack: over a face, an edge or a corner.
  std::array<int, 3> step{0, 0, 0};
  for (unsigned k = 0; k < 3; ++k) {
    const double from_middle = static_cast<double>(p(k)) - tree_.keyToCoord(own[k]);
    if (std::abs(from_middle) < 0.5 * options_.cube - options_.slack) continue;
    step[k] = from_middle > 0.0 ? 1 : -1;
  }
  for (unsigned choice = 1; choice < 8; ++choice) {
    octomap::OcTreeKey other = own;
    bool is_near = true;
    for (unsigned k = 0; k < 3; ++k) {
      if ((choice >> k & 1U) == 0U) continue;
      is_near = is_near && step[k] != 0;
      other[k] = static_cast<octomap::key_type>(other[k] + step[k]);
    }
    if (is_near && is_taken(other)) return other;
  }
  return own;
}

// Finds the cubes that computeRayKeys of OctoMap does, without a list of their keys.
void DepthMap::mark_ray(const octomap::point3d& begin, const octomap::point3d& end) {
  octomap::OcTreeKey first, last;
  if (!tree_.coordToKeyChecked(begin, first) || !tree_.coordToKeyChecked(end, last)) return;
  int left = 0;  // faces on the way
  const auto faces_across = [&](unsigned k) {
    const double from = static_cast<double>(begin(k));
    const double length = static_cast<double>(end(k)) - from;
    const int step = length < 0.0 ? -1 : 1;
    const double face = tree_.keyToCoord(first[k]) + 0.5 * step * options_.cube;
    left += std::abs(last[k] - first[k]);
    return Faces{length == 0.0 ? counted(2.0) : counted((face - from) / length),
                 counted(options_.cube / std::abs(length)), first[k] - low_[k], step};
  };
  Faces x = faces_across(0);
  Faces y = faces_across(1);
  Faces z = faces_across(2);
  for (; left > 0; --left) {
    const std::size_t place = place_at(x.at, y.at, z.at);
    // Nothing changes in what is free already, and that is most of it.
    if (place != places_ && states_[place] != State::free && marks_[place] == Mark::none) {
      const auto key = [](int cube) { return static_cast<octomap::key_type>(cube); };
      marked_.emplace_back(key(x.at + low_[0]), key(y.at + low_[1]), key(z.at + low_[2]));
      marks_[place] = Mark::free;
    }
    const std::int64_t is_z = all_bits(z.next < std::min(x.next, y.next));
    const std::int64_t is_y = all_bits(y.next < x.next) & ~is_z;
    x.pass(~(is_y | is_z));
    y.pass(is_y);
    z.pass(is_z);
  }
}

void DepthMap::settle(std::size_t place, const octomap::OcTreeKey& key, double time) {
  if (marks_[place] == Mark::hit) {
    (void)tree_.updateNode(key, true);
    states_[place] = State::occupied;
    hit_at_[place] = static_cast<float>(time);
    return;
  }
  if (states_[place] == State::free) return;
  const bool is_occupied = states_[place] == State::occupied;
  if (marks_[place] == Mark::hidden) {
    // What the robot hides within its margin may have gone unseen.
    if (!is_occupied || time - static_cast<double>(hit_at_[place]) <= options_.keeps) return;
    (void)tree_.setNodeValue(key, tree_.getClampingThresMinLog());
    states_[place] = State::free;
    return;
  }
  const octomap::OcTreeNode* const node = tree_.updateNode(key, false);
  if (!tree_.isNodeOccupied(node)) states_[place] = State::free;
}

}  // namespace repel::octrees
