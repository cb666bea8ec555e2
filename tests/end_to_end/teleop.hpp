/// @file
/// Runs the program teleop as a user would, and reads what it leaves behind.
#pragma once

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <charconv>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

namespace repel::test {

namespace fs = std::filesystem;

inline std::string text_of(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// A folder of its own for one test, removed with it.
class Folder {
 public:
  Folder() {
    std::string name = (fs::temp_directory_path() / "repel_").string() + std::string(6, 'X');
    if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary folder");
    path_ = name;
  }
  ~Folder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  [[nodiscard]] std::string operator/(const std::string& name) const {
    return (path_ / name).string();
  }
  /// Writes a file into the folder and returns its path.
  [[nodiscard]] std::string with(const std::string& name, const std::string& text) const {
    std::ofstream(path_ / name, std::ios::binary) << text;
    return *this / name;
  }

 private:
  fs::path path_;
};

/// How a run of teleop ended and what it said.
struct Ending {
  int status = -1;  ///< exit status; 128 + signal when it was killed
  std::string out;
  std::string err;
  [[nodiscard]] bool says(const std::string& words) const {
    return out.find(words) != std::string::npos || err.find(words) != std::string::npos;
  }
};

inline std::ostream& operator<<(std::ostream& stream, const Ending& ending) {
  return stream << "exit status " << ending.status << '\n' << ending.out << ending.err;
}

/// `word` as the shell takes it whole.
inline std::string quoted(const std::string& word) {
  return std::string(1, '\'').append(word).append(1, '\'');
}

/// Runs teleop with `arguments`, as a shell splits them.
inline Ending teleop(const std::string& arguments) {
  const Folder folder;
  const std::string command = quoted(REPEL_TELEOP) + " " + arguments + " >" +
                              quoted(folder / "out") + " 2>" + quoted(folder / "err") +
                              " </dev/null";
  const int raw = std::system(command.c_str());
  const int status = WIFEXITED(raw) ? WEXITSTATUS(raw) : 128 + WTERMSIG(raw);
  return {status, text_of(folder / "out"), text_of(folder / "err")};
}

inline nlohmann::json report_of(const std::string& path) {
  return nlohmann::json::parse(text_of(path));
}

/// A CSV file column by column.
using Columns = std::map<std::string, std::vector<double>>;

inline Columns columns_of(const std::string& path) {
  std::istringstream lines(text_of(path));
  std::string line;
  std::getline(lines, line);
  std::vector<std::string> names;
  std::istringstream header(line);
  for (std::string name; std::getline(header, name, ',');) names.push_back(name);
  Columns columns;
  while (std::getline(lines, line)) {
    std::istringstream cells(line);
    for (const std::string& name : names) {
      std::string cell;
      std::getline(cells, cell, ',');
      double value = std::nan("");
      std::from_chars(cell.data(), cell.data() + cell.size(), value);
      columns[name].push_back(value);
    }
  }
  return columns;
}

/// The start of every scene written by a test: the robot of the repository.
inline std::string robot_text(const std::string& urdf = REPEL_SOURCE "/robots/puma560.urdf") {
  return "robot:\n  urdf: " + urdf +
         "\n  start: 0 45 -180 0 -45 0 deg\n  tool_frame: {position: 0 0 100 mm}\n"
         "tool:\n"
         "  - {name: rod, shape: capsule, radius: 15 mm, length: 60 mm, position: 0 0 -30 mm}\n";
}

/// A table just below the tool, and a push against it.
inline std::string table_text() {
  return "obstacles:\n"
         "  - {name: table, shape: box, size: 0.6 0.8 0.05 m, position: 0.6 -0.15 0.425 m}\n";
}

inline std::string push_text() {
  return "script:\n"
         "  - {name: push, device: spaceball, duration: 1 s, linear: 0 0 -100 mm/s}\n";
}

}  // namespace repel::test
