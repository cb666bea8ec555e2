// SPDX-License-Identifier: BSD-3-Clause
#include <repel/percepts/perceived_parts.hpp>

#include <algorithm>
#include <array>
#include <limits>

#include <repel/reduction/shape.hpp>

namespace repel::percepts {
namespace {

constexpr double never = -std::numeric_limits<double>::infinity();

bool has_same_rectangle(const Cell& a, const Cell& b) noexcept {
  return a.u == b.u && a.v == b.v && a.width == b.width && a.height == b.height &&
         a.layer == b.layer;
}

Cell grown(Cell cell, double slack, double nearest) noexcept {
  for (std::size_t i = 0; i < 4; ++i) {
    cell.front[i] = static_cast<float>(std::max(0.5 * nearest, cell.front[i] - slack));
    cell.back[i] += static_cast<float>(slack);
  }
  return cell;
}

}  // namespace

PerceivedParts::PerceivedParts(WorldChanges& changes, const PerceivedOptions& options)
    : changes_(&changes), options_(options), seen_at_(never) {
  repel::checked("slack", options.slack, 0.0, 1.0, "m");
  repel::checked("over", options.over, 0.0, 10.0, "s");
  repel::checked("keeps", options.keeps, 0.0, 1e6, "s");
}

PerceptCounts PerceivedParts::see(std::span<const Cell> cells, const DepthCells& division,
                                  const Pose& X_WC, double time) {
  const bool has_moved = seen_at_ == never || !X_WC.isApprox(X_WC_, 1e-9);
  X_WC_ = X_WC;
  seen_at_ = time;
  PerceptCounts counts;
  counts.cells = static_cast<int>(cells.size());
  waiting_.clear();
  for (Perceived& part : parts_) part.is_seen = false;
  const std::size_t before = parts_.size();
  for (const Cell& cell : cells) {
    const auto end = parts_.begin() + static_cast<std::ptrdiff_t>(has_moved ? 0 : before);
    const auto there = std::find_if(parts_.begin(), end,
                                    [&](const Perceived& part) { return is_where(part, cell); });
    if (there != end) {
      there->is_seen = true;
      there->seen_at = time;
      ++counts.kept;
    } else if (add(cell, division.camera(), time)) {
      ++counts.added;
    } else {
      waiting_.push_back(cell);
    }
  }
  const auto goes = [&](Perceived& part) {
    if (part.is_seen) return false;
    const bool is_hidden = !has_moved && !division.measures_in(part.cell);
    if (is_hidden && time - part.seen_at <= options_.keeps) {
      ++counts.hidden;
      return false;
    }
    if (!changes_->remove(part.part, options_.over)) return false;  // the queue is full: next time
    ++counts.removed;
    return true;
  };
  parts_.erase(std::remove_if(parts_.begin(), parts_.end(), goes), parts_.end());
  for (const Cell& cell : waiting_) {
    (add(cell, division.camera(), time) ? counts.added : counts.left_out) += 1;
  }
  return counts;
}

void PerceivedParts::clear() {
  const auto goes = [&](const Perceived& part) {
    return changes_->remove(part.part, options_.over);
  };
  parts_.erase(std::remove_if(parts_.begin(), parts_.end(), goes), parts_.end());
}

/// A part of the same rectangle contains the cell, and is not much thicker.
bool PerceivedParts::is_where(const Perceived& part, const Cell& cell) const noexcept {
  if (!has_same_rectangle(part.cell, cell)) return false;
  const auto most = static_cast<float>(3.0 * options_.slack);
  for (std::size_t i = 0; i < 4; ++i) {
    const float before = cell.front[i] - part.cell.front[i];
    const float behind = part.cell.back[i] - cell.back[i];
    if (before < 0.0F || behind < 0.0F || before > most || behind > most) return false;
  }
  return true;
}

bool PerceivedParts::add(const Cell& cell, const DepthCamera& camera, double time) {
  const Cell wider = grown(cell, options_.slack, camera.nearest);
  std::array<Vec3, 8> corners = wider.corners(camera);
  Vec3 middle(0, 0, 0);
  for (const Vec3& p : corners) middle += p / 8.0;
  for (Vec3& p : corners) p -= middle;
  const Pose X_WP = X_WC_ * Pose(Eigen::Translation3d(middle.x(), middle.y(), middle.z()));
  const Shape shape = Shape::hull(corners, {.levels = 1});
  const PartId part = changes_->add(shape, X_WP, options_.over, options_.share);
  if (!part.valid()) return false;
  if (options_.on_add) options_.on_add(part, shape);
  parts_.push_back({wider, part, time, true});
  return true;
}

}  // namespace repel::percepts
