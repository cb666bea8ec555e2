// SPDX-License-Identifier: BSD-3-Clause
#include <repel/runs/records/log.hpp>

#include <pthread.h>

#include <cerrno>
#include <chrono>
#include <cmath>
#include <concepts>
#include <cstdio>
#include <fstream>
#include <system_error>
#include <type_traits>
#include <utility>

#include <repel/common/complaint.hpp>
#include <repel/host/times.hpp>
#include <repel/loop/columns.hpp>

namespace repel::runs {
namespace {

/// A CSV cell: quoted if requested or if the text requires it, with inner quotes doubled.
std::string cell_of(const std::string& text, bool in_quotes = false) {
  if (!in_quotes && text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string cell(1, '"');
  for (const char c : text) cell.append(c == '"' ? 2 : 1, c);
  return cell += '"';
}

/// A number, or nothing where there is none.
std::string or_nothing(double value) {
  return std::isfinite(value) ? to_text(value) : std::string();
}

void write_value(bool x, std::ostream& file) {
  file << ',' << (x ? 1 : 0);
}
void write_value(std::integral auto x, std::ostream& file) {
  file << ',' << x;
}
void write_value(std::floating_point auto x, std::ostream& file) {
  file << ',' << or_nothing(double{x});
}
void write_value(Stop stop, std::ostream& file) {
  file << ',' << to_text(stop);
}

void write_names(const ArmHeading& arm, std::ostream& file) {
  const TickRecord none;
  const ColumnNames names{arm.joints, arm.modules};
  for_each_field(
      [&](const TickField& field, const auto& x) {
        for (const std::string& name : names.of<std::remove_cvref_t<decltype(x)>>(field)) {
          file << ',' << cell_of(arm.prefix() + name);
        }
      },
      none);
}

void write_values(const TickRecord& k, const ArmHeading& arm, std::ostream& file) {
  for_each_value(k, arm.joints.size(), arm.modules.size(),
                 [&file](const auto& x) { write_value(x, file); });
}

class CsvLog final : public TickLog {
 public:
  CsvLog(const std::string& path, const Heading& heading, bool by_the_clock)
      : path_(path),
        heading_(heading),
        by_the_clock_(by_the_clock),
        file_(path, std::ios::binary | std::ios::app) {
    file_ << "tick,time_s,nearest_m,hardest_pair,hardest_n,pairs_near,pairs_evaluated,pairs_stale,"
             "oldest_age_ticks";
    for (const ArmHeading& arm : heading.arms) write_names(arm, file_);
    file_ << ",compute_us,late_us\n" << std::flush;
    look();
    if (!trouble_.empty()) throw SetupError(trouble_);
  }

  void write(const Snapshot& tick) override {
    const TickRecord& k = tick.arms.front();
    file_ << k.tick << ',' << to_text(k.time) << ',' << or_nothing(k.pairs.nearest) << ','
          << name(k.pairs.hardest_pair) << ',' << or_nothing(k.pairs.peak_force) << ','
          << k.pairs.near << ',' << k.pairs.evaluated << ',' << k.pairs.stale << ','
          << k.pairs.oldest_age;
    for (std::size_t i = 0; i < heading_.arms.size(); ++i) {
      write_values(tick.arms[i], heading_.arms[i], file_);
    }
    if (by_the_clock_) {
      file_ << ',' << us(tick.times.compute) << ',' << us(tick.times.late) << '\n';
    } else {
      file_ << ",,\n";
    }
    look();
  }
  void flush() override {
    file_.flush();
    look();
  }
  void close(std::int64_t /*dropped*/) override {
    file_.close();
    look();
  }
  [[nodiscard]] std::string trouble() const override { return trouble_; }

 private:
  [[nodiscard]] static std::string us(std::chrono::nanoseconds time) {
    return to_text(1e-3 * static_cast<double>(time.count()));
  }
  /// Empty for an invalid id.
  [[nodiscard]] std::string name(PairId pair) const {
    if (!pair.valid()) return {};
    return cell_of(heading_.pairs[static_cast<std::size_t>(pair.index)], true);
  }
  /// Keeps the operating system's message of the first failure.
  void look() {
    if (file_ || !trouble_.empty()) return;
    const int error = errno;
    trouble_ = path_ + ": cannot be written";
    if (error != 0) trouble_ += ": " + std::generic_category().message(error);
  }

  std::string path_;
  Heading heading_;
  bool by_the_clock_;
  std::ofstream file_;
  std::string trouble_;
};

}  // namespace

std::unique_ptr<TickLog> csv_log(const std::string& path, const Heading& heading,
                                 bool by_the_clock) {
  return std::make_unique<CsvLog>(path, heading, by_the_clock);
}

LogThread::LogThread(Ring<Snapshot>& ticks, TickLog& log,
                     std::function<void(const std::string&)> on_trouble)
    : ticks_(ticks),
      log_(log),
      on_trouble_(std::move(on_trouble)),
      thread_([this](const std::stop_token& stop) {
        (void)pthread_setname_np(pthread_self(), "repel log");
        using Clock = std::chrono::steady_clock;
        auto flushed = Clock::now();
        for (;;) {
          const bool last = stop.stop_requested();  // one more round for the remaining ticks
          write_all();
          if (last) return;
          if (Clock::now() - flushed > std::chrono::milliseconds(500)) {
            attempt([this] { log_.flush(); });
            flushed = Clock::now();
          }
          std::this_thread::sleep_for(std::chrono::milliseconds(5));
        }
      }) {}

void LogThread::write_all() {
  for (const Snapshot* tick = ticks_.front(); tick != nullptr; tick = ticks_.front()) {
    attempt([&] { log_.write(*tick); });
    unwritten_ += is_lost_ ? 1 : 0;
    ticks_.pop();
  }
}

/// An exception or an error of the log ends the writing, not the run.
template <class Work>
void LogThread::attempt(const Work& work) noexcept {
  if (is_lost_) return;
  std::string trouble = complaint_of(work);
  if (trouble.empty()) trouble = log_.trouble();
  if (!trouble.empty()) lose(trouble);
}

void LogThread::lose(const std::string& trouble) {
  is_lost_ = true;
  on_trouble_(trouble);
}

std::int64_t LogThread::close() {
  thread_ = {};
  const std::int64_t lacking = ticks_.dropped() + unwritten_;
  if (is_lost_) {
    (void)complaint_of([&] { log_.close(lacking); });  // best effort
  } else {
    attempt([&] { log_.close(lacking); });
  }
  return lacking;
}

}  // namespace repel::runs
