// SPDX-License-Identifier: BSD-3-Clause
#include <repel/world/world.hpp>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <nanobind/nanobind.h>
#include <nanobind/stl/vector.h>

#include <repel/base/setup_error.hpp>
#include <repel/schedule/coprocessor.hpp>

#include "arrays.hpp"
#include "bindings.hpp"
#include "description.hpp"
#include "interpreter.hpp"

namespace repel::python {
namespace {

/// A world with the evaluation of its pairs.
class OwnWorld {
 public:
  OwnWorld(const std::string& measure, nb::handle limits)
      : world_(capacities_of(limits), measure_of(measure)) {}

  int add_body(const std::string& name, nb::handle X_WB) {
    const InUse in_use(is_in_use_);
    require_open();
    return world_.add_body(name, X_WB.is_none() ? Pose::Identity() : pose_of(X_WB, "X_WB")).index;
  }
  int add_part(int body, const std::string& name, const Shape& shape, nb::handle X_BP) {
    const InUse in_use(is_in_use_);
    require_open();
    return world_
        .add_part({body}, name, shape, X_BP.is_none() ? Pose::Identity() : pose_of(X_BP, "X_BP"))
        .index;
  }
  int add_pair(int a, int b, const ForceLaw& law) {
    const InUse in_use(is_in_use_);
    require_open();
    return world_.add_pair({a}, {b}, law).index;
  }

  void place(int body, nb::handle X_WB, nb::handle V_WB) {
    const InUse in_use(is_in_use_);
    checked("body", body, 1, world_.body_count() - 1, "");
    const Pose X = pose_of(X_WB, "X_WB");
    const Twist V = V_WB.is_none() ? Twist{} : twist_of(V_WB, "V_WB");
    if (!world_.place({body}, X, V)) throw SetupError("V_WB: an entry is not finite");
    is_fresh_ = false;
  }

  nb::list near() {
    const InUse in_use(is_in_use_);
    // Nothing may be thrown while the coprocessor goes through them, as Python does without memory.
    std::size_t count = 0;
    evaluated().for_each_near([&count](const NearPair&) { ++count; });
    std::vector<NearPair> pairs;
    pairs.reserve(count);
    coprocessor_->for_each_near([&pairs](const NearPair& near) {
      if (!near.is_watched) pairs.push_back(near);
    });
    nb::list all;
    for (const NearPair& near : pairs) {
      const Pair& pair = world_.pair(near.pair);
      nb::dict each;
      each["pair"] = near.pair.index;
      each["a"] = world_.part(pair.a).name;
      each["b"] = world_.part(pair.b).name;
      each["separation"] = near.separation;
      each["force"] = near.force;
      all.append(each);
    }
    return all;
  }

  nb::object force_on(int body) {
    const InUse in_use(is_in_use_);
    checked("body", body, 0, world_.body_count() - 1, "");
    (void)evaluated();
    return to_array(forces_->on_body[static_cast<std::size_t>(body)]);
  }

  [[nodiscard]] const World& world() const { return world_; }

 private:
  const Coprocessor& evaluated() {
    if (coprocessor_ == nullptr) {
      coprocessor_ = std::make_unique<Coprocessor>(world_, CoprocessorOptions{});
    }
    if (!is_fresh_) {
      const Released others_go_on;
      ++world_.motion().tick;
      forces_ = &coprocessor_->exchange();
      is_fresh_ = true;
    }
    return *coprocessor_;
  }

  void require_open() const {
    if (coprocessor_ != nullptr) {
      throw SetupError("the world has been evaluated: bodies, parts and pairs are added before");
    }
  }

  World world_;
  std::unique_ptr<Coprocessor> coprocessor_;  ///< from the first evaluation on
  const PairForces* forces_ = nullptr;
  bool is_fresh_ = false;  ///< the forces are those of where the bodies are
  bool is_in_use_ = false;
};

}  // namespace

void bind_world(nb::module_& m) {
  nb::class_<OwnWorld>(m, "World",
                       "Bodies with convex parts, and pairs of parts to be kept apart. Bodies, "
                       "parts and pairs are numbers, counted from 0; body 0 is the fixed one.")
      .def(nb::init<const std::string&, nb::handle>(), nb::kw_only(),
           nb::arg("measure") = "deepest_point", nb::arg("limits") = nb::none(),
           nb::sig("def __init__(self, *, measure: str = 'deepest_point', limits: repel.Capacities "
                   "| None = None) -> None"),
           "measure of overlaps: deepest_point, reduction or exact. limits: how much it can hold; "
           "none: Capacities().")
      .def("add_body", &OwnWorld::add_body, nb::arg("name"), nb::arg("X_WB") = nb::none(),
           "Adds a body that can be placed, at the pose X_WB [m]. Returns its number.")
      .def("add_part", &OwnWorld::add_part, nb::arg("body"), nb::arg("name"), nb::arg("shape"),
           nb::arg("X_BP") = nb::none(),
           "Adds a part at the pose X_BP [m] in its body; body 0 never moves. Returns its number.")
      .def("add_pair", &OwnWorld::add_pair, nb::arg("a"), nb::arg("b"), nb::arg("law"),
           "Keeps part `a` off part `b`. Returns the number of the pair.")
      .def(
          "add_pairs",
          [](OwnWorld& world, const nb::sequence& group_a, const nb::sequence& group_b,
             const ForceLaw& law) {
            constexpr const char* expected = "the numbers of parts";
            const auto all_a = value_of<std::vector<int>>(group_a, "group_a", expected);
            const auto all_b = value_of<std::vector<int>>(group_b, "group_b", expected);
            for (const int a : all_a) {
              for (const int b : all_b) (void)world.add_pair(a, b, law);
            }
            return all_a.size() * all_b.size();
          },
          nb::arg("group_a"), nb::arg("group_b"), nb::arg("law"),
          nb::sig("def add_pairs(self, group_a: collections.abc.Sequence[int], group_b: "
                  "collections.abc.Sequence[int], law: ForceLaw) -> int"),
          "Keeps every part of one group off every part of the other. Returns how many pairs.")
      .def("place", &OwnWorld::place, nb::arg("body"), nb::arg("X_WB"),
           nb::arg("V_WB") = nb::none(),
           "Moves a body to the pose X_WB [m], with the twist V_WB (6,): velocity [m/s] of its "
           "origin, then angular velocity [rad/s], world axes; none: at rest.")
      .def("near", &OwnWorld::near, nb::sig("def near(self) -> list[dict[str, typing.Any]]"),
           "The pairs that may be within the range of their law: dicts with the number of the "
           "`pair`, the names `a` and `b`, the `separation` (Separation) and the `force` [N] on a "
           "along its extraction direction.")
      .def("force_on", &OwnWorld::force_on, nb::arg("body"),
           nb::sig("def force_on(self, body: int) -> numpy.ndarray"),
           "(6,) force [N] and torque [N m] of all pairs on a body, about its origin, world axes.")
      .def_prop_ro("body_count", [](const OwnWorld& w) { return w.world().body_count(); })
      .def_prop_ro("part_count", [](const OwnWorld& w) { return w.world().parts().size(); })
      .def_prop_ro("pair_count", [](const OwnWorld& w) { return w.world().pairs().size(); });
}

}  // namespace repel::python
