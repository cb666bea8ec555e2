// SPDX-License-Identifier: BSD-3-Clause
#include <repel/percepts/perceived_parts.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include <nanobind/nanobind.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>

#include <repel/base/setup_error.hpp>
#include <repel/percepts/depth_cells.hpp>
#include <repel/percepts/depth_memory.hpp>
#include <repel/percepts/own_body.hpp>

#include "arrays.hpp"
#include "bindings.hpp"
#include "own_cell.hpp"

namespace repel::python {
namespace {

using percepts::CellOptions;
using percepts::DepthCamera;
using percepts::PerceivedOptions;

/// What a camera sees becomes loose parts of a cell.
class OwnCamera {
 public:
  OwnCamera(OwnCell& cell, const DepthCamera& camera, const CellOptions& cells, double margin,
            double keeps, PerceivedOptions parts)
      : cell_(&cell),
        division_(camera, cells),
        own_(camera, shapes(), margin),
        memory_(camera, keeps),
        parts_(cell.cell().changes(), told(std::move(parts))),
        X_CP_(known_.size()),
        image_(camera.pixels()) {}

  nb::dict see(nb::handle depth, nb::handle X_WC, double time) {
    const InUse in_use = cell_->use();
    take(depth);
    const Pose X = pose_of(X_WC, "X_WC");
    checked("time", time, -1e12, 1e12, "s");
    percepts::PerceptCounts counts;
    {
      const Released others_go_on;
      const World& world = std::as_const(cell_->cell()).world();
      const Pose X_CW = inverted(X);
      std::transform(known_.begin(), known_.end(), X_CP_.begin(), [&](PartId id) {
        const Part& part = world.part(id);
        const Pose& X_WB = world.motion().bodies[static_cast<std::size_t>(part.body.index)].X_WB;
        return composed(X_CW, composed(X_WB, part.X_BP));
      });
      own_.remove(X_CP_, image_);
      memory_.fill(image_, time);
      counts = parts_.see(division_.divide(image_), division_, X, time);
    }
    nb::dict all;
    all["cells"] = counts.cells;
    all["kept"] = counts.kept;
    all["added"] = counts.added;
    all["left_out"] = counts.left_out;
    all["removed"] = counts.removed;
    all["hidden"] = counts.hidden;
    return all;
  }

  void clear() {
    const InUse in_use = cell_->use();
    parts_.clear();
    memory_.forget();
  }

  [[nodiscard]] OwnCell* cell() const noexcept { return cell_; }

 private:
  /// Of all parts that the cell has anyway: they are no obstacles a second time.
  [[nodiscard]] std::vector<Shape> shapes() {
    const World& world = std::as_const(cell_->cell()).world();
    std::vector<Shape> all;
    for (std::size_t i = 0; i < world.parts().size(); ++i) {
      const Part& part = world.parts()[i];
      if (world.motion().bodies[static_cast<std::size_t>(part.body.index)].is_loose) continue;
      known_.push_back({static_cast<std::int32_t>(i)});
      all.push_back(part.shape);
    }
    return all;
  }

  [[nodiscard]] PerceivedOptions told(PerceivedOptions options) {
    options.on_add = [this](PartId part, const Shape& shape) { cell_->tell(part, shape); };
    return options;
  }

  void take(nb::handle depth) {
    const DepthCamera& camera = division_.camera();
    constexpr const char* expected = "depths [m], height x width of the camera";
    const Array pixels = array_of(depth, "depth", expected);
    if (pixels.ndim() != 2 || pixels.shape(0) != static_cast<std::size_t>(camera.height) ||
        pixels.shape(1) != static_cast<std::size_t>(camera.width)) {
      refuse_shape(pixels, "depth", expected);
    }
    std::transform(pixels.data(), pixels.data() + pixels.size(), image_.begin(),
                   [](double z) { return static_cast<float>(z); });
  }

  OwnCell* cell_;
  std::vector<PartId> known_;
  percepts::DepthCells division_;
  percepts::OwnBody own_;
  percepts::DepthMemory memory_;
  percepts::PerceivedParts parts_;
  std::vector<Pose> X_CP_;  ///< [m] of `known_`
  std::vector<float> image_;
};

}  // namespace

void bind_cameras(nb::module_& m) {
  static constexpr DepthCamera usual;
  static constexpr CellOptions cell_options;
  nb::class_<OwnCamera>(m, "DepthCamera", nb::type_slots(companion_slots<OwnCamera>),
                        "A camera beside a Cell: what it sees becomes loose parts of the cell.")
      .def(
          "__init__",
          [](OwnCamera* self, OwnCell& cell, int width, int height, double fx, double fy, double cx,
             double cy, double nearest, double farthest, int most, double tolerance,
             double thickness, double room, double margin, double keeps,
             std::optional<std::pair<int, int>> share) {
            PerceivedOptions parts{.keeps = keeps};
            if (share) {
              const auto count = static_cast<double>(cell.cell().loose().size());
              checked("first of share", share->first, 0.0, count, "");
              checked("count of share", share->second, 0.0, count, "");
              parts.share = {static_cast<std::size_t>(share->first),
                             static_cast<std::size_t>(share->second)};
            }
            new (self) OwnCamera(
                cell,
                {.width = width,
                 .height = height,
                 .fx = fx,
                 .fy = fy,
                 .cx = cx,
                 .cy = cy,
                 .nearest = nearest,
                 .farthest = farthest},
                {.most = most, .tolerance = tolerance, .thickness = thickness, .room = room},
                margin, keeps, std::move(parts));
          },
          nb::keep_alive<1, 2>(), nb::arg("cell"), nb::kw_only(), nb::arg("width"),
          nb::arg("height"), nb::arg("fx"), nb::arg("fy"), nb::arg("cx"), nb::arg("cy"),
          nb::arg("nearest") = usual.nearest, nb::arg("farthest") = usual.farthest,
          nb::arg("most") = cell_options.most, nb::arg("tolerance") = cell_options.tolerance,
          nb::arg("thickness") = cell_options.thickness, nb::arg("room") = cell_options.room,
          nb::arg("margin") = 0.03, nb::arg("keeps") = 2.0, nb::arg("share") = nb::none(),
          "A pinhole camera without distortion: width, height, focal lengths fx and fy, and cx and "
          "cy where the optical axis meets the image [px]; depths from nearest to farthest [m] are "
          "measurements. most: cells of an image; the cell should have twice as many Loose with "
          "can_be_held=False and this room [m], and somewhat more for the slack. tolerance [m] of "
          "a surface from its cell, thickness [m] of what is behind it, margin [m] around what the "
          "cell knows anyway, keeps [s] of what is hidden (docs/percepts.md). share: (first, "
          "count) of the loose parts, for this camera alone; none: all.")
      .def("see", &OwnCamera::see, nb::arg("depth"), nb::arg("X_WC"), nb::arg("time"),
           nb::sig(("def see(self, depth: numpy.typing.ArrayLike, X_WC: " + pose_type +
                    ", time: float) -> dict[str, int]")
                       .c_str()),
           "Takes over an image, between two ticks: depths [m] (height, width) along the optical "
           "axis, 0 or NaN where nothing was measured; X_WC [m] the camera when it was taken, x to "
           "the right, y down, z forward; time [s], growing. The arms count as they are at the "
           "last tick. Returns how many `cells` it has, how many are `kept`, `added` or `left_out` "
           "for lack of loose parts, and how many parts are `removed` or `hidden`.")
      .def("clear", &OwnCamera::clear, "Lets all that was seen go.");
}

}  // namespace repel::python
