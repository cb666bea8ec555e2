// SPDX-License-Identifier: BSD-3-Clause
#include "table.hpp"

#include <algorithm>

#include "markdown.hpp"

namespace repel::bench {

namespace {

const char* to_text(Start start) {
  return start == Start::warm ? "warm" : "cold";
}

/// The names in order of first appearance, each once.
template <class Name>
std::vector<std::string> each_once(const Measurements& all, Name&& name) {
  std::vector<std::string> names;
  for (const auto& m : all) {
    if (std::find(names.begin(), names.end(), name(*m)) == names.end()) names.push_back(name(*m));
  }
  return names;
}
std::vector<std::string> library_names(const Measurements& all) {
  return each_once(all, [](const Measurement& m) { return m.library().name; });
}
std::vector<std::string> task_names(const Measurements& all) {
  return each_once(all, [](const Measurement& m) { return m.task().name; });
}

const Measurement* find(const Measurements& all, const std::string& task, Start start,
                        const std::string& library) {
  for (const auto& m : all) {
    if (m->task().name == task && m->start() == start && m->library().name == library) {
      return m.get();
    }
  }
  return nullptr;
}

/// The median time, or the number of wrong answers if there are any: then no time is shown.
std::string cell(const Measurement* m) {
  if (m == nullptr) return "";
  const double p50 = m->cost().p50;
  const int wrong = m->verdict().wrong();
  if (wrong == 0) return text("%.0f", p50);
  return text("(%.0f) wrong: %d of %d", p50, wrong, m->verdict().asked);
}

std::string settings_of(const Measurements& all) {
  std::string out = heading({"library", "version", "tolerance", "setting"}, false);
  for (const std::string& name : library_names(all)) {
    const auto used = std::find_if(all.begin(), all.end(),
                                   [&](const auto& m) { return m->library().name == name; });
    const Library& library = (*used)->library();
    out += text("| %s | %s | %g | %s |\n", name.c_str(), library.version.c_str(), library.tolerance,
                library.settings.c_str());
  }
  return out;
}

/// Calls `row(task, start)` for every measured task, cold and warm.
template <class Row>
void for_each_row(const Measurements& all, Row&& row) {
  const std::vector<std::string> libraries = library_names(all);
  for (const std::string& task : task_names(all)) {
    for (const Start start : {Start::cold, Start::warm}) {
      const bool any = std::any_of(libraries.begin(), libraries.end(), [&](const auto& library) {
        return find(all, task, start, library) != nullptr;
      });
      if (any) row(task, start);
    }
  }
}

std::string medians(const Measurements& all) {
  const std::vector<std::string> libraries = library_names(all);
  std::vector<std::string> columns{"task"};
  columns.insert(columns.end(), libraries.begin(), libraries.end());
  std::string out = heading(columns);
  for_each_row(all, [&](const std::string& task, Start start) {
    out += text("| %s, %s |", task.c_str(), to_text(start));
    for (const std::string& library : libraries) {
      out += text(" %s |", cell(find(all, task, start, library)).c_str());
    }
    out += "\n";
  });
  return out;
}

/// The median time of each rival divided by that of repel.
std::string ratios(const Measurements& all) {
  std::vector<std::string> libraries = library_names(all);
  std::erase(libraries, "repel");
  std::vector<std::string> columns{"task", "repel"};
  columns.insert(columns.end(), libraries.begin(), libraries.end());
  std::string out = heading(columns);
  for_each_row(all, [&](const std::string& task, Start start) {
    const Measurement* ours = find(all, task, start, "repel");
    if (ours == nullptr) return;
    const double p50 = ours->cost().p50;
    out += text("| %s, %s | %.0f |", task.c_str(), to_text(start), p50);
    for (const std::string& library : libraries) {
      const Measurement* rival = find(all, task, start, library);
      const bool earned = rival != nullptr && rival->verdict().wrong() == 0;
      out +=
          rival == nullptr ? " |" : text(earned ? " %.2f |" : " (%.2f) |", rival->cost().p50 / p50);
    }
    out += "\n";
  });
  return out;
}

std::string details(const Measurements& all) {
  std::string out = heading({"task", "library", "p50", "p99", "p99.9", "worst",
                             "wrong by 1e-6 of the size", "wrong by 1e-6 of the distance",
                             "outside its bracket", "asked", "largest error [m]"});
  for (const auto& m : all) {
    const Cost c = m->cost();
    const Verdict& v = m->verdict();
    const bool bound = m->task().overlap && !m->library().exact_depths;
    const std::string error = bound ? text("a bound: %.0f %% of the depth", 100.0 * v.median_share)
                                    : text("%.1e", v.worst_error);
    out += text("| %s, %s | %s | %.0f | %.0f | %.0f | %.0f | %d | %d | %d | %d | %s |\n",
                m->task().name.c_str(), to_text(m->start()), m->library().name.c_str(), c.p50,
                c.p99, c.p999, c.worst, v.wrong_by_size, v.wrong_by_distance, v.outside, v.asked,
                error.c_str());
  }
  return out;
}

}  // namespace

std::string comparison_table(const Measurements& all) {
  if (all.empty()) return {};
  return "## Settings\n\n" + settings_of(all) + "\n## Median time of one question [ns]\n\n" +
         medians(all) + "\n## Times the median of repel\n\n" + ratios(all) +
         "\n## Everything [ns]\n\n" + details(all);
}

std::string sweep_table(const Measurements& all) {
  if (all.empty()) return {};
  std::string out =
      "## Time against error\n\n" + heading({"task", "library", "tolerance", "p50 [ns]",
                                             "median relative error", "worst relative error"});
  for (const auto& m : all) {
    out += text("| %s | %s | %.0e | %.0f | %.1e | %.1e |\n", m->task().name.c_str(),
                m->library().name.c_str(), m->tolerance(), m->cost().p50,
                m->verdict().median_relative, m->verdict().worst_relative);
  }
  return out;
}

}  // namespace repel::bench
