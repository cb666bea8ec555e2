// SPDX-License-Identifier: BSD-3-Clause
// By hand: Boost.Process sets no limits on what a child may use.
#include "child_process.hpp"

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstring>
#include <exception>
#include <fstream>
#include <new>
#include <string_view>
#include <system_error>

#include <repel/base/setup_error.hpp>
#include <repel/common/input_limits.hpp>

#include "parcel.hpp"

namespace repel::detail {
namespace {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool reserves_address_space = true;  // terabytes of address space
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
constexpr bool reserves_address_space = true;
#else
constexpr bool reserves_address_space = false;
#endif
#else
constexpr bool reserves_address_space = false;
#endif

constexpr char succeeded = 'y';
constexpr char failed = 'n';
constexpr char refused = 'r';  // by a SetupError

std::size_t address_space() {
  std::size_t pages = 0;
  std::ifstream("/proc/self/statm") >> pages;
  return pages * static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
}

void limit(decltype(RLIMIT_CPU) resource, std::size_t most) {
  rlimit now{};
  getrlimit(resource, &now);
  now.rlim_cur = std::min<rlim_t>(most, now.rlim_max);
  setrlimit(resource, &now);
}

std::string packed(const SetupError& error) {
  Parcel parcel;
  parcel.put_list(error.file());
  parcel.put(error.line());
  const std::string_view text = error.what();
  // The message without its file and line: the constructor adds them again.
  const SetupError place("", error.file(), error.line());
  parcel.put_list(text.substr(std::strlen(place.what())));
  return parcel.take();
}

[[noreturn]] void throw_packed(std::string_view bytes) {
  Unpacking parcel(bytes);
  const auto file = parcel.take_list<std::string>();
  const int line = parcel.take<int>();
  throw SetupError(parcel.take_list<std::string>(), file, line);
}

/// What libraries print of a file is in the error. @param to stays open: where the result goes
void be_silent(int to) {
  const int nowhere = open("/dev/null", O_WRONLY | O_CLOEXEC);
  for (const int output : {STDOUT_FILENO, STDERR_FILENO}) {
    if (nowhere >= 0 && output != to) (void)dup2(nowhere, output);
  }
}

void write_all(int to, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t count = write(to, bytes.data(), bytes.size());
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return;
    bytes.remove_prefix(static_cast<std::size_t>(count));
  }
}

/// One end of a pipe; closes it at destruction.
class End {
 public:
  explicit End(int file) : file_(file) {}
  ~End() { shut(); }
  End(const End&) = delete;
  End& operator=(const End&) = delete;
  [[nodiscard]] int file() const { return file_; }
  void shut() {
    if (file_ >= 0) close(file_);
    file_ = -1;
  }

 private:
  int file_;
};

/// Runs `work` in the child and writes the result to `to`: a status byte, the length (64 bit), the
/// bytes.
[[noreturn]] void work_as_child(const std::function<std::string()>& work, const ChildLimits& limits,
                                std::size_t memory, int to) {
  for (const int number : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGXCPU, SIGALRM}) {
    (void)signal(number, SIG_DFL);
  }
  be_silent(to);
  limit(RLIMIT_CORE, 0);
  limit(RLIMIT_CPU, static_cast<std::size_t>(limits.seconds));
  if (!reserves_address_space) limit(RLIMIT_AS, memory);
  // A lock that another thread held at the fork is never released: a deadlock uses no processor
  // time.
  alarm(static_cast<unsigned>(10 * limits.seconds + 50));
  std::string answer;
  char sign = failed;
  try {
    answer = work();
    sign = succeeded;
  } catch (const SetupError& error) {
    answer = packed(error);
    sign = refused;
  } catch (const std::bad_alloc&) {
    answer = "needs more memory than allowed, " + std::to_string(limits.memory) + " bytes";
  } catch (const std::exception& error) {
    answer = error.what();
  } catch (...) {
    answer = "cannot be read";
  }
  const std::uint64_t size = answer.size();
  std::array<char, 1 + sizeof size> head{sign};
  std::memcpy(&head[1], &size, sizeof size);
  write_all(to, {head.data(), head.size()});
  write_all(to, answer);
  _exit(0);
}

std::string read_all(int from) {
  std::string bytes;
  std::array<char, 65536> block{};
  while (true) {
    const ssize_t count = read(from, block.data(), block.size());
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return bytes;
    bytes.append(block.data(), static_cast<std::size_t>(count));
  }
}

std::string ending(int status, const ChildLimits& limits) {
  const int number = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
  if (number == SIGXCPU || number == SIGKILL || number == SIGALRM) {
    return "takes longer to read than allowed, " + std::to_string(limits.seconds) +
           " s of processor time";
  }
  std::string text = "cannot be read: its reader crashed";
  if (number != 0) text += " by signal " + std::to_string(number);
  return text;
}

}  // namespace

// Weak: these objects are in more than one part, and a program may have the whole of each.
[[gnu::weak]] std::string result_of_child(const std::function<std::string()>& work,
                                          const ChildLimits& limits) {
  std::array<int, 2> ends{};
  if (pipe2(ends.data(), O_CLOEXEC) != 0) throw SetupError("cannot be read: no pipe to its reader");
  End from(ends[0]);
  End to(ends[1]);
  const std::size_t memory = address_space() + limits.memory;
  const pid_t child = fork();
  if (child < 0) throw SetupError("cannot be read: no process to read it");
  if (child == 0) work_as_child(work, limits, memory, to.file());
  to.shut();
  const std::string bytes = read_all(from.file());
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) continue;
  std::uint64_t size = 0;
  if (bytes.size() > sizeof size) std::memcpy(&size, &bytes[1], sizeof size);
  const bool whole = bytes.size() > sizeof size && bytes.size() - 1 - sizeof size == size;
  if (!whole) throw SetupError(ending(status, limits));
  std::string answer = bytes.substr(1 + sizeof size);
  if (bytes[0] == refused) throw_packed(answer);
  if (bytes[0] != succeeded) throw SetupError(answer);
  return answer;
}

[[gnu::weak]] std::string result_of_file(const std::filesystem::path& path, const std::string& what,
                                         std::size_t expansion,
                                         const std::function<std::string()>& work) {
  const std::string file = what + " '" + path.string() + "' ";
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) {
    const bool exists = std::filesystem::exists(path, error);
    throw SetupError(file + (exists ? "is no file" : "is not there") +
                     "; allowed: an existing file");
  }
  const std::uintmax_t bytes = std::filesystem::file_size(path, error);
  if (error) throw SetupError(file + "cannot be read: " + error.message());
  if (bytes > input_limits.mesh_bytes) {
    throw SetupError(file + "has " + std::to_string(bytes) + " bytes; allowed: up to " +
                     std::to_string(input_limits.mesh_bytes));
  }
  const auto mebibytes = static_cast<int>(bytes >> 20U);
  const ChildLimits limits{
      .seconds = std::min(input_limits.mesh_seconds, 1 + 2 * mebibytes),
      .memory = std::min<std::size_t>(input_limits.mesh_memory,
                                      (std::size_t{256} << 20) + expansion * bytes)};
  try {
    return result_of_child(work, limits);
  } catch (const SetupError& wrong) {
    throw SetupError(file + wrong.what());
  }
}

}  // namespace repel::detail
