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
    size_[k] = cubes.high[k] + 1 - cubes.low[k];
    places_ *= static_cast<std::size_t>(size_[k]);
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
  ends_.clear();
  mark_ends(depth, X_WC);
  mark_rays(point_of(X_WC.translation()));
  int hits = 0;
  for (const octomap::OcTreeKey& key : marked_) {
    const std::size_t place = place_of(key);
    hits += marks_[place] == Mark::hit ? 1 : 0;
    settle(place, key, time);
    marks_[place] = Mark::none;
  }
  return hits;
}

std::size_t DepthMap::place_of(const octomap::OcTreeKey& key) const noexcept {
  std::array<int, 3> at{};
  for (std::size_t k = 0; k < 3; ++k) {
    at[k] = static_cast<int>(key[static_cast<unsigned>(k)]) - low_[k];
    if (at[k] < 0 || at[k] >= size_[k]) return places_;
  }
  return (static_cast<std::size_t>(at[2]) * static_cast<std::size_t>(size_[1]) +
          static_cast<std::size_t>(at[1])) *
             static_cast<std::size_t>(size_[0]) +
         static_cast<std::size_t>(at[0]);
}

void DepthMap::mark(const octomap::OcTreeKey& key, Mark what) {
  const std::size_t place = place_of(key);
  if (place == places_ || marks_[place] >= what) return;
  if (marks_[place] == Mark::none) marked_.push_back(key);
  marks_[place] = what;
}

void DepthMap::mark_ends(std::span<const float> depth, const Pose& X_WC) {
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
      const double pixels = 0.5 * options_.cube * std::min(camera_.fx, camera_.fy) / far;
      const auto step =
          static_cast<int>(std::bit_floor(static_cast<unsigned>(std::clamp(pixels, 1.0, 64.0))));
      if (u % step == 0 && v % step == 0) ends_.push_back(end);
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

void DepthMap::mark_rays(const octomap::point3d& from) {
  for (const octomap::point3d& end : ends_) {
    if (!tree_.computeRayKeys(from, end, ray_)) continue;
    for (const octomap::OcTreeKey& key : ray_) mark(key, Mark::free);
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
