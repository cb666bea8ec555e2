// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Logs of every tick, written by a separate thread.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <thread>

#include <repel/loop/tap.hpp>
#include <repel/runs/records/heading.hpp>

namespace repel::runs {

/// A file to which every tick is written. Not to be called in the tick: it allocates and makes
/// system calls. Write errors do not throw; trouble() reports them.
class TickLog {
 public:
  virtual void write(const Snapshot& tick) = 0;
  /// Passes everything written so far to the operating system.
  virtual void flush() = 0;
  /// Completes the file.
  virtual void close(std::int64_t dropped) = 0;
  /// Why the file is incomplete, with its name; empty: nothing is lost so far.
  [[nodiscard]] virtual std::string trouble() const = 0;

  TickLog() = default;
  TickLog(const TickLog&) = delete;
  TickLog& operator=(const TickLog&) = delete;
  virtual ~TickLog() = default;
};

/// One row per tick, one column per number, with units in the column names: CSV as of RFC 4180,
/// except that lines end in a line feed alone. A cell without a number, as the nearest distance
/// where nothing is near, is empty.
/// @param by_the_clock false: no times are written, so that two runs give the same file
/// @throws SetupError if the file cannot be written
[[nodiscard]] std::unique_ptr<TickLog> csv_log(const std::string& path, const Heading& heading,
                                               bool by_the_clock);

/// Takes ticks out of the tap and writes them. Never delays the loop: ticks for which it is too
/// slow are dropped and counted by the tap. If the file cannot be written or the log throws, the
/// run continues, and later ticks count as dropped.
class LogThread {
 public:
  /// `ticks` and `log` must outlive this object.
  /// @param on_trouble called once, from the thread, as soon as the file is known to be incomplete
  LogThread(Ring<Snapshot>& ticks, TickLog& log,
            std::function<void(const std::string&)> on_trouble);

  /// Writes the remaining ticks and completes the file; returns how many ticks were dropped.
  std::int64_t close();

 private:
  void write_all();
  template <class Work>
  void attempt(const Work& work) noexcept;
  void lose(const std::string& trouble);

  Ring<Snapshot>& ticks_;
  TickLog& log_;
  std::function<void(const std::string&)> on_trouble_;
  bool is_lost_ = false;        ///< writing has failed; nothing more is written
  std::int64_t unwritten_ = 0;  ///< ticks since then
  std::jthread thread_;
};

}  // namespace repel::runs
