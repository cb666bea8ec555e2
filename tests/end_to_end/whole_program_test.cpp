// All threads of the program at once: workers, view, log and progress. The thread sanitizer makes a
// data race an exit status of its own.
#include "end_to_end/live.hpp"

namespace repel::test {
namespace whole_program_test {

void expect_sound(const std::string& log, const std::vector<std::string>& more) {
  SCOPED_TRACE(log);
  const Folder folder;
  std::vector<std::string> arguments = {"anderson_4x8", "--threads", "2", "--log", folder / log};
  arguments.insert(arguments.end(), more.begin(), more.end());
  LiveTeleop program(arguments);
  {
    LivePage page(program);
    ASSERT_FALSE(page.take().is_null());
    const Vec3 down(0, 0, -0.1);
    const Json pressed = page.drive(down, [](const Json& f) { return force_of(f) > 5.0; });
    EXPECT_FALSE(pressed.is_null());
    EXPECT_FALSE(page.await("timing").is_null());
    LivePage other(program);
    EXPECT_FALSE(other.await("frame").is_null());
  }
  const Ending ending = program.interrupt();
  EXPECT_EQ(ending.status, 0) << ending;
  EXPECT_EQ(ending.err.find("ThreadSanitizer"), std::string::npos) << ending;
  EXPECT_GT(fs::file_size(folder / log), 1000U);
}

TEST(WholeProgram, WorksWithAllItsThreadsByTheClock) {
  expect_sound("run.mcap", {});
  expect_sound("run.csv", {});
}

TEST(WholeProgram, WorksWithAllItsThreadsInLockStep) {
  expect_sound("run.mcap", {"--fast"});
}

}  // namespace whole_program_test
}  // namespace repel::test
