// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include <nanobind/nanobind.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <repel/base/setup_error.hpp>
#include <repel/cell/layout.hpp>
#include <repel/loop/tap.hpp>

#include "arrays.hpp"
#include "bindings.hpp"
#include "own_cell.hpp"

namespace repel::python {
namespace {

const char* group_of(const Cell& cell, BodyId body) {
  for (std::size_t arm = 0; arm < cell.arms(); ++arm) {
    const auto& layout = cell.layout(arm);
    if (layout.tool == body) return "tool";
    const bool is_link = std::any_of(layout.links.begin(), layout.links.end(),
                                     [body](const auto& link) { return link.body == body; });
    if (is_link) return "link";
  }
  return "obstacle";
}

/// Whether everything that meets the part may enter it.
bool is_passable(const World& world, std::int32_t part) {
  bool meets = false;
  for (const Pair& pair : world.pairs()) {
    if (pair.b.index != part) continue;
    if (!pair.law.passable) return false;
    meets = true;
  }
  return meets;
}

/// The parts as they are now, by PartId.
nb::list parts_of(OwnCell& own) {
  const InUse in_use = own.use();
  const Cell& cell = own.cell();
  const World& world = cell.world();
  nb::list all;
  for (std::size_t i = 0; i < world.parts().size(); ++i) {
    const Part& part = world.parts()[i];
    nb::dict each;
    each["name"] = part.name;
    each["body"] = part.body.index;
    each["group"] = group_of(cell, part.body);
    each["passable"] = is_passable(world, static_cast<std::int32_t>(i));
    each["shape"] = part.shape;
    each["X_BP"] = to_array(part.X_BP);
    all.append(each);
  }
  return all;
}

nb::list bodies_of(OwnCell& own) {
  const InUse in_use = own.use();
  const World& world = std::as_const(own.cell()).world();
  nb::list names;
  for (int i = 0; i < world.body_count(); ++i) names.append(world.body_name({i}));
  return names;
}

}  // namespace

nb::dict OwnCell::picture() {
  const InUse in_use = use();
  if (records_.empty()) throw SetupError("log comes after a tick of the cell");
  const Cell& cell = *cell_;
  TapOptions options;
  options.arms = static_cast<int>(cell.arms());
  Tap tap(cell.world(), options);
  tap.show(cell.coprocessor(), records_, {});
  (void)tap.pictures().take();
  const Snapshot& now = tap.pictures().newest();
  nb::list ticks;
  for (std::size_t i = 0; i < records_.size(); ++i) ticks.append(Tick{*records_[i], names_[i]});
  nb::list poses;
  for (const Pose& X : now.X_WB) poses.append(to_array(X));
  std::vector<Vec3> a;
  std::vector<Vec3> b;
  std::vector<Vec3> forces;
  for (const NearPair& near : now.near()) {
    const Separation& s = near.separation;
    a.push_back(s.p_WA);
    b.push_back(s.p_WB);
    forces.emplace_back(near.force * s.extraction_W);
  }
  nb::dict all;
  all["ticks"] = ticks;
  all["X_WB"] = poses;
  all["is_there"] = std::vector<int>(now.is_there.begin(), now.is_there.end());
  all["a"] = to_array(a);
  all["b"] = to_array(b);
  all["forces"] = to_array(forces);
  return all;
}

void bind_pictures(nb::module_& /*m*/) {
  nb::borrow<nb::class_<OwnCell>>(nb::type<OwnCell>())
      .def("_parts", &parts_of, nb::sig("def _parts(self) -> list[dict[str, typing.Any]]"))
      .def("_bodies", &bodies_of, nb::sig("def _bodies(self) -> list[str]"))
      .def("_picture", &OwnCell::picture, nb::sig("def _picture(self) -> dict[str, typing.Any]"));
}

}  // namespace repel::python
