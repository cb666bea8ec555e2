/// @file
/// Logs of every tick, written by a thread of their own.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <thread>

#include <repel/loop/tap.hpp>

#include "heading.hpp"

namespace repel::teleop {

/// A file that gets every tick. Not for the tick itself: it takes heap and makes system calls.
/// Trouble while writing does not throw: it stays in trouble().
class TickLog {
 public:
  virtual void write(const Snapshot& tick) = 0;
  /// What was written so far survives the program.
  virtual void flush() = 0;
  /// Ends the file.
  virtual void close(std::int64_t dropped) = 0;
  /// Why the file cannot become whole, with its name; empty: nothing is lost so far.
  [[nodiscard]] virtual std::string trouble() const = 0;

  TickLog() = default;
  TickLog(const TickLog&) = delete;
  TickLog& operator=(const TickLog&) = delete;
  virtual ~TickLog() = default;
};

/// A row for every tick, a column for every number, units in the names: CSV as of RFC 4180, but for
/// lines that end in a line feed alone.
/// @throws SetupError when the file cannot be written
[[nodiscard]] std::unique_ptr<TickLog> csv_log(const std::string& path, const Heading& heading);

/// Takes ticks out of the tap and writes them. Never delays the loop: what the thread is too slow
/// for is dropped and counted by the tap. With a file that cannot be written, or a log that throws,
/// the run goes on, and what comes after is counted as dropped.
class LogThread {
 public:
  /// Both must live as long as it does.
  /// @param on_trouble called once, from the thread, as soon as the file cannot become whole
  LogThread(Ring<Snapshot>& ticks, TickLog& log,
            std::function<void(const std::string&)> on_trouble);

  /// Writes what is left and ends the file; returns how many ticks were dropped.
  std::int64_t close();

 private:
  void write_all();
  template <class Work>
  void attempt(const Work& work) noexcept;
  void lose(const std::string& trouble);

  Ring<Snapshot>& ticks_;
  TickLog& log_;
  std::function<void(const std::string&)> on_trouble_;
  bool is_lost_ = false;        ///< nothing more need be written
  std::int64_t unwritten_ = 0;  ///< ticks since then
  std::jthread thread_;
};

}  // namespace repel::teleop
