// SPDX-License-Identifier: BSD-3-Clause
#include <repel/runs/wire/station_program.hpp>

#include <fcntl.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <system_error>

#include <repel/base/setup_error.hpp>

namespace repel::runs {
namespace {

/// Of the report, in the other program.
constexpr int report_file = 3;

[[noreturn]] void fail_to_start(int error) {
  throw SetupError("the station cannot be started beside this program: " +
                   std::generic_category().message(error));
}

/// What is done with the files of the other program before it begins.
class FileActions {
 public:
  FileActions(int printed, int complaints, int report) {
    posix_spawn_file_actions_init(&actions_);
    posix_spawn_file_actions_addopen(&actions_, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_adddup2(&actions_, printed, STDOUT_FILENO);
    posix_spawn_file_actions_adddup2(&actions_, complaints, STDERR_FILENO);
    posix_spawn_file_actions_adddup2(&actions_, report, report_file);
  }
  ~FileActions() { posix_spawn_file_actions_destroy(&actions_); }
  FileActions(const FileActions&) = delete;
  FileActions& operator=(const FileActions&) = delete;
  [[nodiscard]] const posix_spawn_file_actions_t* get() const noexcept { return &actions_; }

 private:
  posix_spawn_file_actions_t actions_{};
};

}  // namespace

StationProgram::Paper::Paper(const char* name) : file_(memfd_create(name, MFD_CLOEXEC)) {
  if (file_ < 0) fail_to_start(errno);
  // A file on the number that the other program is to have would be closed there, not passed on.
  if (file_ != report_file) return;
  file_ = fcntl(report_file, F_DUPFD_CLOEXEC, report_file + 1);
  const int error = errno;
  close(report_file);
  if (file_ < 0) fail_to_start(error);
}

StationProgram::Paper::~Paper() {
  close(file_);
}

std::string StationProgram::Paper::text() const {
  std::string text;
  std::array<char, 4096> block{};
  while (true) {
    const ssize_t count = pread(file_, block.data(), block.size(), static_cast<off_t>(text.size()));
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return text;
    text.append(block.data(), static_cast<std::size_t>(count));
  }
}

StationProgram::StationProgram(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), "teleop");
  arguments.emplace_back("--report");
  arguments.emplace_back("/dev/fd/" + std::to_string(report_file));
  std::vector<char*> pointers;
  pointers.reserve(arguments.size() + 1);
  for (std::string& argument : arguments) pointers.push_back(argument.data());
  pointers.push_back(nullptr);
  const FileActions files(printed_.file(), complaints_.file(), report_.file());
  const int error =
      posix_spawn(&program_, "/proc/self/exe", files.get(), nullptr, pointers.data(), environ);
  if (error != 0) fail_to_start(error);
}

StationProgram::~StationProgram() {
  (void)wait();
}

bool StationProgram::has_ended() noexcept {
  if (program_ > 0 && waitpid(program_, &status_, WNOHANG) == program_) program_ = -1;
  return program_ <= 0;
}

int StationProgram::wait() noexcept {
  if (!has_ended()) kill(program_, SIGTERM);
  while (program_ > 0) {
    if (waitpid(program_, &status_, 0) == program_ || errno != EINTR) program_ = -1;
  }
  return WIFEXITED(status_) ? WEXITSTATUS(status_) : 128 + WTERMSIG(status_);
}

StationEnding StationProgram::stop() {
  StationEnding ending;
  ending.status = wait();
  ending.printed = printed_.text();
  ending.complaints = complaints_.text();
  ending.report = report_.text();
  return ending;
}

}  // namespace repel::runs
