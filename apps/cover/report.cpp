// SPDX-License-Identifier: BSD-3-Clause
#include "report.hpp"

namespace repel::cover {
namespace {

/// The points as lists of numbers [m].
nlohmann::ordered_json numbers(const std::vector<Vec3>& points) {
  auto list = nlohmann::ordered_json::array();
  for (const Vec3& p : points) list.push_back({p.x(), p.y(), p.z()});
  return list;
}

}  // namespace

nlohmann::ordered_json report_of(const Cover& cover, const std::string& mesh,
                                 const CoverOptions& options) {
  nlohmann::ordered_json report{{"mesh", mesh},
                                {"engine", cover.engine},
                                {"is_closed", cover.is_closed},
                                {"error_m", options.error},
                                {"overlap_m", options.overlap},
                                {"uncovered_m", cover.uncovered_m},
                                {"excess_m", cover.excess_m},
                                {"excess_reached_m", cover.excess_reached_m},
                                {"excess_mean_m", cover.excess_mean_m}};
  report["seam_m"] = cover.seam_m ? nlohmann::ordered_json(*cover.seam_m) : nullptr;
  report["faults"] = cover.faults;
  report["parts"] = nlohmann::ordered_json::array();
  for (const std::vector<Vec3>& part : cover.parts) report["parts"].push_back(numbers(part));
  report["uncovered"] = nlohmann::ordered_json::array();
  for (const Uncovered& piece : cover.uncovered) {
    report["uncovered"].push_back({{"depth_m", piece.depth}, {"polygon", numbers(piece.polygon)}});
  }
  return report;
}

}  // namespace repel::cover
