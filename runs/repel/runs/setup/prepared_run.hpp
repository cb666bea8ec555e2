// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// A scene that is ready to run once.
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include <repel/cell/cell.hpp>
#include <repel/robots/urdf.hpp>
#include <repel/runs/faults/injected_faults.hpp>
#include <repel/runs/options/run_options.hpp>
#include <repel/runs/records/recording.hpp>
#include <repel/runs/setup/describe.hpp>
#include <repel/scene/scene.hpp>

namespace repel::runs {

/// The state that a run starts from and consumes.
struct PreparedRun {
  PreparedRun(scene::Scene changed, const RunOptions& run, DescribedScene described,
              std::unique_ptr<faults::InjectedFaults> injected = nullptr)
      : scene(std::move(changed)),
        options(run),
        robots(std::move(described.robots)),
        shown(std::move(described.shown)),
        faults(std::move(injected)),
        cell(std::move(described.cell)) {}

  /// With the changes made by the options, the obstacles of its models, and all lists of parts.
  scene::Scene scene;
  RunOptions options;
  std::vector<Robot> robots;        ///< of the arms, in their order
  std::vector<scene::Shown> shown;  ///< of DescribedScene
  /// Of the first arm; null: none. The cell has its kinematics by them.
  std::unique_ptr<faults::InjectedFaults> faults;
  Cell cell;
};

/// How a scene asks to be run: its rate and its coprocessor; the rest by default.
[[nodiscard]] RunOptions options_of(const scene::Scene& scene);

/// Builds the cell of a scene, and starts the threads of its coprocessor.
/// @param recording to be replayed; null: none
/// @param remote see `describe`
/// @throws SetupError for a scene that cannot be built, with file and line
[[nodiscard]] std::unique_ptr<PreparedRun> prepare(const scene::Scene& scene,
                                                   const RunOptions& options,
                                                   const Recording* recording = nullptr,
                                                   network::RemoteLink* remote = nullptr);

}  // namespace repel::runs
