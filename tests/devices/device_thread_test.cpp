// SPDX-License-Identifier: BSD-3-Clause
// The thread between a device and the tick. Times in real seconds are only timeouts against hangs.
#include <repel/devices/device_thread.hpp>

#include <gtest/gtest.h>

#include <atomic>
#include <limits>
#include <string>

#include <devices/fake_spacenavd.hpp>
#include <repel/devices/spacenav.hpp>

namespace repel::devices {
namespace device_thread_test {

using std::chrono::milliseconds;

/// Observations of a Probe; outlives it.
struct Notes {
  std::atomic<int> readings{0};
  std::atomic<double> torque{0.0};
  std::atomic<int> shown{0};
  std::atomic<bool> hangs{false};     // from now on, every read hangs
  std::atomic<bool> is_stuck{false};  // a read hangs now
  std::atomic<bool> ended{false};
  char thread_name[16] = {};
};

class Probe {
 public:
  explicit Probe(Notes& notes) : notes_(notes) {}
  ~Probe() { notes_.ended = true; }
  Probe(const Probe&) = delete;
  Probe& operator=(const Probe&) = delete;

  [[nodiscard]] std::string_view name() const noexcept { return "probe"; }
  [[nodiscard]] Measured read(milliseconds wait) noexcept {
    if (notes_.readings == 0) {
      (void)pthread_getname_np(pthread_self(), notes_.thread_name, sizeof notes_.thread_name);
    }
    std::this_thread::sleep_for(wait / 10);
    while (notes_.hangs) {
      notes_.is_stuck = true;
      std::this_thread::yield();
    }
    Measured m;
    m.operating_state = OperatingState::enabled;
    m.measured_cv.linear.x() = ++notes_.readings;
    m.why = "";
    return m;
  }
  void servo_cf(double lever_torque, const Wrench& /*tool_force*/) noexcept {
    notes_.torque = lever_torque;
    ++notes_.shown;
  }

 private:
  Notes& notes_;
};

/// Polls until the condition holds; false on timeout.
template <class Condition>
bool eventually(const Condition& holds) {
  for (int i = 0; i < 10000; ++i) {
    if (holds()) return true;
    std::this_thread::sleep_for(milliseconds(1));
  }
  return false;
}

TEST(DeviceThread, PostsReadingsThatCountUp) {
  Notes notes;
  DeviceThread<Probe> thread(std::make_unique<Probe>(notes));
  EXPECT_EQ(thread.name(), "probe");
  std::uint64_t before = 0;
  for (int taken = 0; taken < 20;) {
    ASSERT_TRUE(eventually([&] { return thread.measured(0.0).count > before; }));
    const Measured& m = thread.measured(0.0);
    EXPECT_EQ(m.operating_state, OperatingState::enabled);
    EXPECT_EQ(m.measured_cv.linear.x(), static_cast<double>(m.count));  // consistent, not torn
    before = m.count;
    ++taken;
  }
}

TEST(DeviceThread, IsAtRestAndDisabledBeforeTheFirstReading) {
  Notes notes;
  notes.hangs = true;
  DeviceThread<Probe> thread(std::make_unique<Probe>(notes));
  const Measured& m = thread.measured(0.0025);
  EXPECT_EQ(m.operating_state, OperatingState::disabled);
  EXPECT_FALSE(m.silent);
  EXPECT_EQ(m.count, 0U);
  notes.hangs = false;
}

TEST(DeviceThread, AThreadThatHangsIsSilentByTheClockOfTheTickAndComesBack) {
  Notes notes;
  DeviceThread<Probe> thread(std::make_unique<Probe>(notes));
  ASSERT_TRUE(eventually([&] { return thread.measured(0.0).count > 0; }));
  notes.hangs = true;
  ASSERT_TRUE(eventually([&] { return notes.is_stuck.load(); }));
  ASSERT_TRUE(eventually([&] { return thread.measured(0.3).silent; }));
  const Measured m = thread.measured(0.0025);
  EXPECT_EQ(m.operating_state, OperatingState::fault);
  EXPECT_TRUE(m.measured_cv.linear.isZero(0.0));
  EXPECT_STRNE(m.why, "");
  EXPECT_GT(m.count, 0U);
  notes.hangs = false;
  ASSERT_TRUE(eventually([&] { return !thread.measured(0.0025).silent; }));
  EXPECT_EQ(thread.silent_for(), 0.0);
}

TEST(DeviceThread, ShowsTheForceAndLetsGoOfOneThatIsNotRenewed) {
  Notes notes;
  DeviceThread<Probe> thread(std::make_unique<Probe>(notes));
  ASSERT_TRUE(eventually([&] {
    thread.servo_cf(1.5, {});
    return notes.torque == 1.5;
  }));
  ASSERT_TRUE(eventually([&] { return notes.torque == 0.0; }));
  const int shown = notes.shown;
  EXPECT_GE(shown, 2);
}

TEST(DeviceThread, TakesAForceThatIsNotFiniteForNone) {
  Notes notes;
  DeviceThread<Probe> thread(std::make_unique<Probe>(notes), {.felt_for = milliseconds(10000)});
  thread.servo_cf(1.5, {});
  ASSERT_TRUE(eventually([&] { return notes.torque == 1.5; }));
  thread.servo_cf(std::numeric_limits<double>::quiet_NaN(), {});
  ASSERT_TRUE(eventually([&] { return notes.torque == 0.0; }));
  thread.servo_cf(1.5, {});
  ASSERT_TRUE(eventually([&] { return notes.torque == 1.5; }));
  Wrench wrench;
  wrench.torque.y() = std::numeric_limits<double>::infinity();
  thread.servo_cf(1.5, wrench);
  ASSERT_TRUE(eventually([&] { return notes.torque == 0.0; }));
}

TEST(DeviceThread, StopsWithoutForceAndTakesTheDeviceWithIt) {
  Notes notes;
  {
    DeviceThread<Probe> thread(std::make_unique<Probe>(notes), {.felt_for = milliseconds(10000)});
    thread.servo_cf(1.5, {});
    ASSERT_TRUE(eventually([&] { return notes.torque == 1.5; }));
    thread.stop();
    EXPECT_EQ(notes.torque, 0.0);
    const int readings = notes.readings;
    std::this_thread::sleep_for(milliseconds(30));
    EXPECT_EQ(notes.readings, readings);
  }
  EXPECT_TRUE(notes.ended);
}

TEST(DeviceThread, HasANameAndABeginning) {
  static std::atomic<int> begun{0};
  Notes notes;
  DeviceThread<Probe> thread(std::make_unique<Probe>(notes), {.begin = []() noexcept { ++begun; }});
  ASSERT_TRUE(eventually([&] { return notes.readings > 0; }));
  thread.stop();
  EXPECT_EQ(begun, 1);
  EXPECT_STREQ(notes.thread_name, "repel device");
}

TEST(DeviceThread, RefusesTimesOutOfRange) {
  Notes notes;
  EXPECT_THROW(DeviceThread<Probe>(std::make_unique<Probe>(notes), {.wait = milliseconds(0)}),
               SetupError);
  EXPECT_THROW(DeviceThread<Probe>(std::make_unique<Probe>(notes), {.felt_for = milliseconds(0)}),
               SetupError);
}

TEST(DeviceThread, ADaemonThatIsKilledAndStartedAgainIsSeenFromTheTick) {
  const ScratchFolder folder;
  FakeSpacenavd first(folder.socket());
  SpacenavOptions options;
  options.path = folder.socket();
  options.retry_after = 0.05;
  DeviceThread<Spacenav> thread(std::make_unique<Spacenav>(options));
  const auto measured = [&]() -> const Measured& { return thread.measured(0.0); };
  first.accept();
  first.send(motion(0, 0, 350));
  ASSERT_TRUE(eventually([&] { return measured().measured_cv.linear.x() == 0.25; }));
  first.die();
  ASSERT_TRUE(eventually([&] { return measured().silent; }));
  EXPECT_EQ(measured().operating_state, OperatingState::fault);
  EXPECT_TRUE(measured().measured_cv.linear.isZero(0.0));
  FakeSpacenavd second(folder.socket());
  ASSERT_TRUE(eventually([&] { return !measured().silent; }));
  EXPECT_TRUE(measured().measured_cv.linear.isZero(0.0));
  second.accept();
  second.send(motion(0, 0, -350));
  ASSERT_TRUE(eventually([&] { return measured().measured_cv.linear.x() == -0.25; }));
}

}  // namespace device_thread_test
}  // namespace repel::devices
