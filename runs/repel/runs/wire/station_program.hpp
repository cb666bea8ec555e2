// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The station of a scene as a program of its own, started by that of the site.
#pragma once

#include <sys/types.h>

#include <string>
#include <vector>

namespace repel::runs {

/// How it ended.
struct StationEnding {
  int status = 0;          ///< its exit status; 128 and the signal that killed it
  std::string printed;     ///< its report, for people
  std::string complaints;  ///< what it said on stderr
  std::string report;      ///< as of --report: JSON; empty if it wrote none
};

/// Runs this program once more, beside this one. Set-up and the time after the run only.
class StationProgram {
 public:
  /// @param arguments of the command line, --report excepted
  /// @throws SetupError if it cannot be started
  explicit StationProgram(std::vector<std::string> arguments);
  ~StationProgram();
  StationProgram(const StationProgram&) = delete;
  StationProgram& operator=(const StationProgram&) = delete;

  /// True once it has ended.
  [[nodiscard]] bool has_ended() noexcept;
  /// Asks it to stop, if it still runs, and waits for its end.
  [[nodiscard]] StationEnding stop();

 private:
  /// A file in memory.
  class Paper {
   public:
    explicit Paper(const char* name);
    ~Paper();
    Paper(const Paper&) = delete;
    Paper& operator=(const Paper&) = delete;
    [[nodiscard]] int file() const noexcept { return file_; }
    [[nodiscard]] std::string text() const;

   private:
    int file_;
  };

  /// As stop(). @return its exit status
  int wait() noexcept;

  Paper printed_{"station"};
  Paper complaints_{"complaints"};
  Paper report_{"report"};
  pid_t program_ = -1;
  int status_ = 0;
};

}  // namespace repel::runs
