#include "log.hpp"

#include <pthread.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <fstream>

#include <repel/base/complaint.hpp>

#include "times.hpp"

namespace repel::teleop {
namespace {

/// The columns that every arm has.
void write_names(const ArmHeading& arm, std::ostream& file) {
  const std::string prefix = arm.prefix();
  for (const char* name :
       {"phase", "status", "x_m", "y_m", "z_m", "vx_m_s", "vy_m_s", "vz_m_s", "virtual_fx_n",
        "virtual_fy_n", "virtual_fz_n", "virtual_tx_nm", "virtual_ty_nm", "virtual_tz_nm",
        "coupling_fx_n", "coupling_fy_n", "coupling_fz_n", "lever_torque_nm", "gain"}) {
    file << ',' << prefix << name;
  }
  for (std::size_t i = 0; i < arm.joints.size(); ++i) {
    file << ',' << prefix << 'q' << i + 1 << (arm.joints[i] == JointType::revolute ? "_rad" : "_m");
  }
  for (const std::string& module : arm.modules)
    file << ',' << prefix << "energy_" << module << "_j";
}

void write_values(const TickRecord& k, const ArmHeading& arm, std::ostream& file) {
  file << ',' << k.phase << ',' << k.status;
  for (const Vec3& v :
       {k.p_WT, k.v_WT, k.virtual_force.force, k.virtual_force.torque, k.coupling.force}) {
    for (int axis = 0; axis < 3; ++axis) file << ',' << to_text(v[axis]);
  }
  file << ',' << to_text(k.lever_torque) << ',' << to_text(k.gain);
  for (std::size_t i = 0; i < arm.joints.size(); ++i) file << ',' << to_text(k.q[i]);
  for (std::size_t i = 0; i < arm.modules.size(); ++i) file << ',' << to_text(double{k.energy[i]});
}

class CsvLog final : public TickLog {
 public:
  CsvLog(const std::string& path, const Heading& heading)
      : path_(path), heading_(heading), file_(path, std::ios::binary) {
    file_ << "tick,time_s,nearest_m,hardest_pair,hardest_n,pairs_near,pairs_evaluated,pairs_stale,"
             "oldest_age_ticks";
    for (const ArmHeading& arm : heading.arms) write_names(arm, file_);
    file_ << '\n' << std::flush;
    check();
  }

  void write(const Snapshot& tick) override {
    const TickRecord& k = tick.arms.front();
    file_ << k.tick << ',' << to_text(k.time) << ',' << to_text(k.pairs.nearest) << ','
          << name(k.pairs.hardest_pair) << ',' << to_text(k.pairs.peak_force) << ',' << k.pairs.near
          << ',' << k.pairs.evaluated << ',' << k.pairs.stale << ',' << k.pairs.oldest_age;
    for (std::size_t i = 0; i < heading_.arms.size(); ++i) {
      write_values(tick.arms[i], heading_.arms[i], file_);
    }
    file_ << '\n';
  }
  void flush() override { file_.flush(); }
  void close(std::int64_t /*dropped*/) override {
    file_.close();
    check();
  }

 private:
  /// In quotes, since it may have a comma; nothing for none.
  [[nodiscard]] std::string name(PairId pair) const {
    std::string text;
    if (!pair.valid()) return text;
    text += '"';
    text += heading_.pairs[static_cast<std::size_t>(pair.index)];
    text += '"';
    return text;
  }
  void check() const {
    if (!file_) throw SetupError("the file cannot be written", path_);
  }

  std::string path_;
  Heading heading_;
  std::ofstream file_;
};

}  // namespace

std::unique_ptr<TickLog> csv_log(const std::string& path, const Heading& heading) {
  return std::make_unique<CsvLog>(path, heading);
}

LogThread::LogThread(Ring<Snapshot>& ticks, TickLog& log)
    : ticks_(ticks), log_(log), thread_([this](const std::stop_token& stop) {
        (void)pthread_setname_np(pthread_self(), "repel log");
        using Clock = std::chrono::steady_clock;
        auto flushed = Clock::now();
        for (;;) {
          const bool last = stop.stop_requested();  // and then what is left
          for (const Snapshot* tick = ticks_.front(); tick != nullptr; tick = ticks_.front()) {
            attempt([&] { log_.write(*tick); });
            if (!failure_.empty()) ++unwritten_;
            ticks_.pop();
          }
          if (last) return;
          if (Clock::now() - flushed > std::chrono::milliseconds(500)) {
            attempt([&] { log_.flush(); });
            flushed = Clock::now();
          }
          std::this_thread::sleep_for(std::chrono::milliseconds(5));
        }
      }) {}

template <class Work>
void LogThread::attempt(const Work& work) noexcept {
  if (!failure_.empty()) return;
  failure_ = complaint_of(work);
  if (failure_.empty()) return;
  std::fprintf(stderr, "The log ends here, the run goes on: %s\n", failure_.c_str());
}

std::int64_t LogThread::close() {
  thread_ = {};
  const std::int64_t lacking = ticks_.dropped() + unwritten_;
  if (!failure_.empty()) {
    (void)complaint_of([&] { log_.close(lacking); });  // as far as it goes
    return lacking;
  }
  log_.close(lacking);
  return lacking;
}

}  // namespace repel::teleop
