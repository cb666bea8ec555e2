// SPDX-License-Identifier: BSD-3-Clause
#include <repel/octrees/mapped_parts.hpp>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>

#include <repel/base/setup_error.hpp>

namespace repel::octrees {
namespace {

using cover::CubeRange;
using cover::OccupancyGrid;

constexpr double few = 0.7;  // of the most boxes: smaller cubes may be tried
constexpr int most_doublings = 10;

double diagonal(double cube) {
  return std::sqrt(3.0) * cube;
}

std::int64_t volume(const CubeRange& range) {
  std::int64_t cubes = 1;
  for (std::size_t k = 0; k < 3; ++k) cubes *= range.high[k] + 1 - range.low[k];
  return cubes;
}

}  // namespace

/// The boxes of a tree with cubes of one size. In cubes of that size, counted from the first of
/// the grid.
class MappedParts::Plan {
 public:
  Plan(const OccupancyGrid& fine, const CubeRange& range, int level, double room)
      : factor_(1 << level), room_(room) {
    std::array<int, 3> before{};
    for (std::size_t k = 0; k < 3; ++k) {
      // Towards minus infinity, so that large cubes begin at multiples of their edge.
      first_[k] = range.low[k] >> level;
      before[k] = range.low[k] - first_[k] * factor_;
    }
    if (level > 0) coarse_ = coarser(fine, factor_, before);
    grid_ = level > 0 ? &coarse_ : &fine;
    count_.assign(grid_->solid.size(), 0);
  }

  /// Keeps a box that is a part, if it is solid.
  void keep(const CubeRange& cubes) {
    CubeRange here;
    for (std::size_t k = 0; k < 3; ++k) {
      if (cubes.low[k] % factor_ != 0 || (cubes.high[k] + 1) % factor_ != 0) return;
      here.low[k] = cubes.low[k] / factor_ - first_[k];
      here.high[k] = (cubes.high[k] + 1) / factor_ - 1 - first_[k];
      if (here.low[k] < 0 || here.high[k] >= grid_->size[k]) return;
    }
    if (all(here, [&](std::size_t place) { return grid_->solid[place] != 0; })) take(here);
  }

  /// Adds boxes until every solid cube is in one. @return false if they are clearly too many
  bool fill(std::size_t most) {
    const std::vector<std::uint8_t>& solid = grid_->solid;
    for (std::size_t place = 0; place < solid.size(); ++place) {
      if (solid[place] == 0) {
        // Most of a map may be free: one step of this search takes 16 cubes or more.
        const void* const next = std::memchr(&solid[place], 1, solid.size() - place);
        if (next == nullptr) break;
        place = static_cast<std::size_t>(static_cast<const std::uint8_t*>(next) - solid.data());
      }
      if (count_[place] != 0) continue;
      if (boxes_.size() >= most) return false;
      take(grown_from(*grid_, grid_->cube(place), room_));
    }
    return true;
  }

  /// Takes away boxes that others cover together, small ones first.
  void thin_out() {
    std::vector<std::size_t> order(boxes_.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
      return volume(boxes_[a]) < volume(boxes_[b]);
    });
    std::vector<std::uint8_t> is_needed(boxes_.size(), 1);
    for (const std::size_t i : order) {
      if (!all(boxes_[i], [&](std::size_t place) { return count_[place] > 1; })) continue;
      is_needed[i] = 0;
      (void)all(boxes_[i], [&](std::size_t place) { return --count_[place] > 0; });
    }
    std::size_t i = 0;
    const auto is_spare = [&](const CubeRange& /*box*/) { return is_needed[i++] == 0; };
    boxes_.erase(std::remove_if(boxes_.begin(), boxes_.end(), is_spare), boxes_.end());
  }

  [[nodiscard]] std::size_t size() const { return boxes_.size(); }

  /// The boxes, in cubes of the tree, counted from its origin.
  [[nodiscard]] std::vector<CubeRange> boxes() const {
    std::vector<CubeRange> result = boxes_;
    for (CubeRange& box : result) {
      for (std::size_t k = 0; k < 3; ++k) {
        box.low[k] = (box.low[k] + first_[k]) * factor_;
        box.high[k] = (box.high[k] + 1 + first_[k]) * factor_ - 1;
      }
    }
    return result;
  }

 private:
  [[nodiscard]] bool all(const CubeRange& range, const auto& is_true) const {
    for (int z = range.low[2]; z <= range.high[2]; ++z) {
      for (int y = range.low[1]; y <= range.high[1]; ++y) {
        for (int x = range.low[0]; x <= range.high[0]; ++x) {
          if (!is_true(grid_->place(x, y, z))) return false;
        }
      }
    }
    return true;
  }
  void take(const CubeRange& box) {
    boxes_.push_back(box);
    (void)all(box, [&](std::size_t place) { return ++count_[place] > 0; });
  }

  int factor_;
  double room_;  ///< [m]
  std::array<int, 3> first_{};
  OccupancyGrid coarse_;
  const OccupancyGrid* grid_ = nullptr;
  std::vector<std::uint32_t> count_;  ///< boxes that a cube is in
  std::vector<CubeRange> boxes_;
};

MappedParts::MappedParts(double resolution, WorldChanges& changes, const MappedOptions& options)
    : resolution_(repel::checked("edge of a cube", resolution, 1e-3, 10.0, "m")),
      changes_(&changes),
      options_(options),
      reach_(options.room - diagonal(repel::checked("slack", options.slack, 0.0, 0.1, "m"))),
      range_(cubes_in(options.region, resolution)) {
  repel::checked("boxes", options.most, 1, 100'000, "");
  repel::checked("over", options.over, 0.0, 10.0, "s");
  repel::checked("room", options.room, diagonal(0.5 * resolution + options.slack), 100.0, "m");
  const auto has_room = [&](int level) {
    return 0.5 * diagonal(std::ldexp(resolution, level)) <= reach_;
  };
  while (most_level_ < most_doublings && has_room(most_level_ + 1)) ++most_level_;
}

MapCounts MappedParts::see(const octomap::OcTree& tree) {
  if (!(std::abs(tree.getResolution() - resolution_) <= 1e-9 * resolution_)) {
    throw SetupError("the map has cubes of " + to_text(tree.getResolution()) +
                     " m; allowed: " + to_text(resolution_) + " m, as before");
  }
  MapCounts counts;
  const OccupancyGrid fine = grid_of(tree, range_, options_.is_unseen_solid);
  take_over(planned(fine, counts), counts);
  return counts;
}

std::vector<CubeRange> MappedParts::planned(const OccupancyGrid& fine, MapCounts& counts) {
  const auto most = static_cast<std::size_t>(options_.most);
  const auto boxes_of = [&](const Plan& plan) {
    counts.boxes = static_cast<int>(plan.size());
    counts.cube = std::ldexp(resolution_, level_);
    return plan.boxes();
  };
  const auto makes = [&](Plan& plan, bool keeps, std::size_t limit, std::size_t at_once) {
    for (const Mapped& part : parts_) {
      if (keeps) plan.keep(part.cubes);
    }
    if (!plan.fill(at_once)) return false;
    plan.thin_out();
    return plan.size() <= limit;
  };
  if (level_ > 0) {
    const auto limit = static_cast<std::size_t>(few * options_.most);
    Plan finer(fine, range_, level_ - 1, reach_);
    if (makes(finer, false, limit, 2 * limit)) --level_;
  }
  for (;; ++level_) {
    for (const bool keeps : {true, false}) {
      Plan plan(fine, range_, level_, reach_);
      // Thinning out makes fewer of them, but not of any number.
      if (makes(plan, keeps, most, 2 * most)) return boxes_of(plan);
    }
    if (level_ == most_level_) break;
  }
  Plan plan(fine, range_, level_, reach_);
  (void)plan.fill(fine.solid.size());
  plan.thin_out();
  std::vector<CubeRange> boxes = boxes_of(plan);
  std::stable_sort(boxes.begin(), boxes.end(),
                   [](const CubeRange& a, const CubeRange& b) { return volume(a) > volume(b); });
  if (boxes.size() > most) {
    counts.left_out = static_cast<int>(boxes.size() - most);
    boxes.resize(most);
  }
  return boxes;
}

void MappedParts::take_over(const std::vector<CubeRange>& boxes, MapCounts& counts) {
  for (Mapped& part : parts_) part.stays = false;
  std::vector<CubeRange> waiting;
  const std::size_t before = parts_.size();
  for (const CubeRange& box : boxes) {
    const auto end = parts_.begin() + static_cast<std::ptrdiff_t>(before);
    const auto there =
        std::find_if(parts_.begin(), end, [&](const Mapped& part) { return part.cubes == box; });
    if (there != end) {
      there->stays = true;
      ++counts.kept;
    } else if (add(box)) {
      ++counts.added;
    } else {
      waiting.push_back(box);
    }
  }
  const auto goes = [&](const Mapped& part) {
    if (part.stays || !remove(part)) return false;  // the queue is full: next time
    ++counts.removed;
    return true;
  };
  parts_.erase(std::remove_if(parts_.begin(), parts_.end(), goes), parts_.end());
  for (const CubeRange& box : waiting) (add(box) ? counts.added : counts.left_out) += 1;
}

bool MappedParts::add(const CubeRange& cubes) {
  Vec3 half = Vec3::Zero();
  Pose X_WP = Pose::Identity();
  for (int axis = 0; axis < 3; ++axis) {
    const auto k = static_cast<std::size_t>(axis);
    half[axis] = 0.5 * resolution_ * (cubes.high[k] + 1 - cubes.low[k]) + options_.slack;
    X_WP.translation()[axis] = 0.5 * resolution_ * (cubes.high[k] + 1 + cubes.low[k]);
  }
  const Shape shape = Shape::box(half, {.levels = 1});
  const PartId part = changes_->add(shape, X_WP, options_.over, options_.share);
  if (!part.valid()) return false;
  if (options_.on_add) options_.on_add(part, shape);
  parts_.push_back({cubes, part, true});
  return true;
}

void MappedParts::clear() {
  const auto goes = [&](const Mapped& part) { return remove(part); };
  parts_.erase(std::remove_if(parts_.begin(), parts_.end(), goes), parts_.end());
}

std::vector<CubeRange> MappedParts::boxes() const {
  std::vector<CubeRange> result;
  for (const Mapped& part : parts_) result.push_back(part.cubes);
  return result;
}

}  // namespace repel::octrees
