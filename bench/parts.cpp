// SPDX-License-Identifier: BSD-3-Clause
#include "parts.hpp"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>

#include <repel/host/times.hpp>

#include "distance/markdown.hpp"

namespace repel::bench {

namespace {

std::string shown(const Json& cell) {
  if (cell.is_null()) return "wrong";
  if (cell.is_string()) return cell.get<std::string>();
  if (cell.is_boolean()) return cell.get<bool>() ? "yes" : "no";
  if (cell.is_number_integer()) return std::to_string(cell.get<std::int64_t>());
  const double number = cell.get<double>();
  const bool is_long = std::abs(number) >= 1e4 && std::abs(number) < 1e9;
  return text(is_long ? "%.0f" : "%.4g", number);
}

void print(const Result& result) {
  std::printf("## %s\n\n%s", result.title.c_str(), heading(result.columns).c_str());
  for (const std::vector<Json>& row : result.rows) {
    for (const Json& cell : row) std::printf("| %s ", shown(cell).c_str());
    std::puts("|");
  }
  for (const std::string& note : result.notes) std::printf("\n%s\n", note.c_str());
  std::putchar('\n');
}

Json to_json(const Result& result) {
  Json rows = Json::array();
  for (const std::vector<Json>& row : result.rows) {
    Json& object = rows.emplace_back();
    for (std::size_t i = 0; i < row.size(); ++i) object[result.columns[i]] = row[i];
  }
  return {
      {"title", result.title}, {"rows", rows}, {"notes", result.notes}, {"series", result.series}};
}

}  // namespace

void describe(CLI::App& app, PartArguments& arguments, const Program& program) {
  std::vector<std::string> names;
  std::string list;
  for (const Part& part : program.all) {
    names.emplace_back(part.name);
    list += text("  %-14s %s\n", part.name, part.about);
  }
  app.add_option("--only", arguments.only,
                 "Only these parts, with commas between them; default: all")
      ->type_name("PART,PART")
      ->delimiter(',')
      ->check(CLI::IsMember(names));
  app.add_flag("--quick", arguments.options.quick, "Fewer and shorter runs: a look, not a result");
  app.add_option("--seed", arguments.options.seed, std::string(program.seeded) + ", 0 to 1e9")
      ->capture_default_str()
      ->check(CLI::Range(std::uint64_t{0}, std::uint64_t{1000000000}));
  app.add_option("--json", arguments.json, "Write the results as JSON to FILE")->type_name("FILE");
  app.footer(
      "Parts:\n" + list + "\n" + program.footer +
      "\n\nExit status: 0 it ran, 1 a result is wrong (its row is named) or bad file, 2 bad\n"
      "usage.");
}

int run(const PartArguments& arguments, const Program& program) {
  host::Output json(arguments.json);
  const host::Machine machine = host::describe_machine(program.scheduler);
  Json report{{"machine", host::to_json(machine)},
              {"seed", arguments.options.seed},
              {"quick", arguments.options.quick},
              {"parts", Json::object()}};
  std::printf("%s; %s; commit %s; seed %s\n\n", machine.cpu.c_str(), machine.compiler.c_str(),
              machine.commit.c_str(), std::to_string(arguments.options.seed).c_str());
  int status = 0;
  for (const Part& part : program.all) {
    const auto& only = arguments.only;
    if (!only.empty() && std::find(only.begin(), only.end(), part.name) == only.end()) continue;
    const Result result = part.run(arguments.options);
    print(result);
    report["parts"][part.name] = to_json(result);
    if (result.failure.empty()) continue;
    std::fprintf(stderr, "%s: %s, %s\n", program.name, part.name, result.failure.c_str());
    status = 1;
  }
  host::write(report, json);
  return status;
}

void progress(const char* part, std::size_t done, std::size_t of) {
  if (isatty(STDERR_FILENO) == 0 && done < of) return;
  std::fprintf(stderr, "\r%s: %zu of %zu%s", part, done, of, done < of ? "" : "\n");
}

}  // namespace repel::bench
