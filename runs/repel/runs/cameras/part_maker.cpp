// SPDX-License-Identifier: BSD-3-Clause
#include <repel/runs/cameras/part_maker.hpp>

#include <algorithm>

#include <repel/base/setup_error.hpp>
#include <repel/percepts/depth_memory.hpp>
#include <repel/percepts/perceived_parts.hpp>
#include <repel/runs/setup/seen_parts.hpp>

#ifdef REPEL_RUNS_OCTREES
#include <repel/octrees/depth_map.hpp>
#include <repel/octrees/mapped_parts.hpp>
#endif

namespace repel::runs {
namespace {

percepts::CellOptions cells_of(const scene::CameraChoice& choice) {
  percepts::CellOptions options;
  options.most = choice.parts / 2;  // what is new comes before what it replaces goes
  options.room = room_of_seen - 0.1;
  if (choice.is_unseen_solid) options.thickness = options.room;
  // Twice the blocks to begin with must be within `most`.
  const auto blocks = [&] {
    return ((choice.width - 1) / options.largest + 1) * ((choice.height - 1) / options.largest + 1);
  };
  while (2 * blocks() > options.most) options.largest *= 2;
  return options;
}

percepts::PerceivedOptions perceived(const CameraPlace& place) {
  percepts::PerceivedOptions options;
  options.share = place.share;
  options.on_add = place.listeners.on_add;
  return options;
}

/// Each image is divided into cells.
class CellMaker final : public PartMaker {
 public:
  CellMaker(const scene::CameraChoice& choice, const percepts::DepthCamera& camera,
            const CameraPlace& place)
      : X_WC_(choice.X_WC),
        memory_(camera),
        division_(camera, cells_of(choice)),
        parts_(*place.changes, perceived(place)) {}

  void look(std::span<float> depth, double time) override {
    (void)memory_.fill(depth, time);
    cells_ = division_.divide(depth);
    time_ = time;
  }
  MadeParts make() override {
    const percepts::PerceptCounts counts = parts_.see(cells_, division_, X_WC_, time_);
    return {.cells = counts.cells, .added = counts.added, .left_out = counts.left_out};
  }

 private:
  Pose X_WC_;  ///< [m]
  percepts::DepthMemory memory_;
  percepts::DepthCells division_;
  percepts::PerceivedParts parts_;
  std::span<const percepts::Cell> cells_;
  double time_ = 0.0;  ///< [s]
};

#ifdef REPEL_RUNS_OCTREES
/// [m] As that of cells, unless the cubes are too small for it.
double slack_of(const scene::MapChoice& choice) {
  return std::min(percepts::PerceivedOptions{}.slack, 0.25 * choice.cube);
}

octrees::DepthMapOptions map_of(const scene::MapChoice& choice) {
  octrees::DepthMapOptions options;
  options.cube = choice.cube;
  options.slack = slack_of(choice);
  options.keeps = choice.keeps;
  options.region = {choice.low, choice.high};
  return options;
}

octrees::MappedOptions mapped(const scene::CameraChoice& choice, const CameraPlace& place) {
  octrees::MappedOptions options;
  options.most = choice.parts / 2;
  options.region = {choice.map->low, choice.map->high};
  options.room = room_of_seen - 0.1;
  options.slack = slack_of(*choice.map);
  options.share = place.share;
  options.on_add = place.listeners.on_add;
  return options;
}

/// All images are entered in one map.
class MapMaker final : public PartMaker {
 public:
  MapMaker(const scene::CameraChoice& choice, const percepts::DepthCamera& camera,
           const CameraPlace& place)
      : X_WC_(choice.X_WC),
        map_(camera, map_of(*choice.map)),
        parts_(choice.map->cube, *place.changes, mapped(choice, place)) {}

  void look(std::span<float> depth, double time) override { (void)map_.insert(depth, X_WC_, time); }
  MadeParts make() override {
    const octrees::MapCounts counts = parts_.see(map_.tree());
    return {.cells = counts.boxes,
            .added = counts.added,
            .left_out = counts.left_out,
            .cube = counts.cube};
  }

 private:
  Pose X_WC_;  ///< [m]
  octrees::DepthMap map_;
  octrees::MappedParts parts_;
};
#endif

}  // namespace

std::unique_ptr<PartMaker> make_part_maker(const scene::CameraChoice& choice,
                                           const percepts::DepthCamera& camera,
                                           const CameraPlace& place) {
  if (!choice.map) return std::make_unique<CellMaker>(choice, camera, place);
#ifdef REPEL_RUNS_OCTREES
  return std::make_unique<MapMaker>(choice, camera, place);
#else
  throw SetupError(
      "the scene has a camera with 'map', which this build cannot make; to have it: apt-get "
      "install liboctomap-dev, then build again");
#endif
}

}  // namespace repel::runs
