/// @file
/// Logs of every tick, written by a thread of their own.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <thread>

#include <repel/loop/tap.hpp>

#include "heading.hpp"

namespace repel::teleop {

/// A file that gets every tick. Not for the tick itself: it takes heap and makes system calls.
class TickLog {
 public:
  virtual void write(const Snapshot& tick) = 0;
  /// What was written so far survives the program.
  virtual void flush() = 0;
  /// Ends the file. @throws SetupError if something of it could not be written
  virtual void close(std::int64_t dropped) = 0;

  TickLog() = default;
  TickLog(const TickLog&) = delete;
  TickLog& operator=(const TickLog&) = delete;
  virtual ~TickLog() = default;
};

/// A row for every tick, a column for every number, units in the names.
/// @throws SetupError when the file cannot be written
[[nodiscard]] std::unique_ptr<TickLog> csv_log(const std::string& path, const Heading& heading);

/// Takes ticks out of the tap and writes them. Never delays the loop: what the thread is too slow
/// for is dropped and counted by the tap. Never ends it either: when the log throws, that is said
/// on stderr and kept, and what comes after it is counted as dropped.
class LogThread {
 public:
  /// Both must live as long as it does.
  LogThread(Ring<Snapshot>& ticks, TickLog& log);

  /// Writes what is left and ends the file; returns how many ticks were dropped.
  /// @throws SetupError if something of it could not be written
  std::int64_t close();
  /// What the log threw; empty if nothing. After `close`.
  [[nodiscard]] const std::string& failure() const noexcept { return failure_; }

 private:
  template <class Work>
  void attempt(const Work& work) noexcept;

  Ring<Snapshot>& ticks_;
  TickLog& log_;
  std::string failure_;         // of the thread until it has ended, as is what follows
  std::int64_t unwritten_ = 0;  // since then
  std::jthread thread_;
};

}  // namespace repel::teleop
