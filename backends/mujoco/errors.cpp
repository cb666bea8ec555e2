// SPDX-License-Identifier: BSD-3-Clause
#include "errors.hpp"

#include <mujoco/mujoco.h>

#include <mutex>
#include <stdexcept>
#include <utility>

namespace repel::mujoco::detail {
namespace {

using Handler = void (*)(const char*);

thread_local int scopes_here = 0;
Handler error_before = nullptr;
Handler warning_before = nullptr;

// Without a handler MuJoCo does what it does by default, here: it ends the process, or writes a
// log.
void on_error(const char* message) {
  if (scopes_here > 0) throw std::runtime_error(message);
  mju_user_error = error_before;
  mju_error(message);
  mju_user_error = &on_error;
}

void on_warning(const char* message) {
  if (scopes_here > 0) return;
  mju_user_warning = warning_before;
  mju_warning(message);
  mju_user_warning = &on_warning;
}

}  // namespace

void set_handlers() {
  static std::mutex one_at_a_time;
  const std::lock_guard lock(one_at_a_time);
  if (mju_user_error != &on_error) error_before = std::exchange(mju_user_error, &on_error);
  if (mju_user_warning != &on_warning) {
    warning_before = std::exchange(mju_user_warning, &on_warning);
  }
}

ErrorsThrown::ErrorsThrown() noexcept {
  ++scopes_here;
}

ErrorsThrown::~ErrorsThrown() {
  --scopes_here;
}

}  // namespace repel::mujoco::detail
