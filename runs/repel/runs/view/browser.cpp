// SPDX-License-Identifier: BSD-3-Clause
#include <repel/runs/view/browser.hpp>

#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>

namespace repel::runs {
namespace {

/// The exit status of `sh -c SCRIPT sh URL` in a session of its own, where an interrupt of the run
/// does not reach it.
int shell(const char* script, const std::string& url) {
  const char* const words[] = {"sh", "-c", script, "sh", url.c_str(), nullptr};
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSID);
  pid_t child = 0;
  int status = 127;
  // NOLINTNEXTLINE(cppcoreguidelines-pro-type-const-cast): it does not write to them
  char* const* arguments = const_cast<char* const*>(words);
  const int error = posix_spawn(&child, "/bin/sh", nullptr, &attributes, arguments, environ);
  posix_spawnattr_destroy(&attributes);
  if (error != 0 || waitpid(child, &status, 0) != child) return 127;
  return WIFEXITED(status) ? WEXITSTATUS(status) : 127;
}

bool has_desktop() {
  // NOLINTBEGIN(concurrency-mt-unsafe): nothing sets the environment
  return std::getenv("DISPLAY") != nullptr || std::getenv("WAYLAND_DISPLAY") != nullptr;
  // NOLINTEND(concurrency-mt-unsafe)
}

}  // namespace

void open_browser(const std::string& url, std::optional<bool> asked) {
  if (!asked.value_or(isatty(STDERR_FILENO) != 0 && has_desktop())) return;
  const char* const detached =
      "command -v xdg-open >/dev/null || exit 3; xdg-open \"$1\" >/dev/null 2>&1 </dev/null &";
  const bool opened = has_desktop() && shell(detached, url) == 0;
  if (opened || !asked) return;
  std::fputs(has_desktop()
                 ? "--open: no browser was opened; it needs: apt-get install xdg-utils\n"
                 : "--open: no browser was opened; there is no desktop, as DISPLAY is not set\n",
             stderr);
}

}  // namespace repel::runs
