// SPDX-License-Identifier: BSD-3-Clause
#include "gaps.hpp"

#include <cstddef>
#include <utility>
#include <vector>

#include <repel/cell/layout.hpp>

namespace repel::hard_walls {
namespace {

std::vector<BodyId> moved_by_arms(const Cell& cell, bool with_links) {
  std::vector<BodyId> moved;
  for (std::size_t i = 0; i < cell.arms(); ++i) {
    moved.push_back(cell.layout(i).tool);
    if (!with_links) continue;
    for (const LinkBody& link : cell.layout(i).links) moved.push_back(link.body);
  }
  return moved;
}

}  // namespace

Gaps::Gaps(CellDescription description, bool with_links)
    : cell_(std::move(description)), contacts_(cell_.world(), moved_by_arms(cell_, with_links)) {}

void Gaps::sense(std::span<const ArmReadings> readings, std::chrono::nanoseconds now) {
  cell_.sense(readings, now);
  (void)cell_.act({});
}

}  // namespace repel::hard_walls
