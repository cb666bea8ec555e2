// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The scenes of the repository, each run once for all tests of a program.
#pragma once

#include <map>
#include <set>
#include <string>

#include "end_to_end/teleop.hpp"

namespace repel::test {

/// The names of all scenes, sorted.
inline std::set<std::string> scene_names() {
  std::set<std::string> all;
  for (const auto& entry : fs::directory_iterator(REPEL_SOURCE "/scenes")) {
    if (entry.path().extension() == ".yaml") all.insert(entry.path().stem().string());
  }
  return all;
}

/// 20 s of a scene, as fast as it goes, with the engine of its reference report.
struct WholeRun {
  nlohmann::json reference;  ///< scenes/reports/NAME.json
  Folder folder;             ///< log.csv
  Ending ending;
  nlohmann::json report;  ///< null if the engine is not built in, or the run failed
};

/// That of the scene; the first call for it makes it.
inline const WholeRun& whole_run_of(const std::string& name) {
  static std::map<std::string, WholeRun> runs;
  const auto [at, is_new] = runs.try_emplace(name);
  WholeRun& run = at->second;
  if (!is_new) return run;
  run.reference = report_of(REPEL_SOURCE "/scenes/reports/" + name + ".json");
  const std::string engine = run.reference.at("backend");
  run.ending =
      teleop(name + " --fast --seconds 20 --backend " + engine + " --log " +
             quoted(run.folder / "log.csv") + " --report " + quoted(run.folder / "r.json"));
  if (run.ending.status == 0) run.report = report_of(run.folder / "r.json");
  return run;
}

}  // namespace repel::test
