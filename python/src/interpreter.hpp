// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Letting go of the interpreter and taking it again, in threads that may outlive it.
///
/// While Python ends, it ends every other thread that asks for the interpreter, by unwinding its
/// stack. The functions of nanobind and of a tick are noexcept: the unwinding would abort the
/// program there. So such a thread stands still where it asked; the end of the process takes it
/// along. (Python 3.14 does the same.)
#pragma once

#include <chrono>
#include <stdexcept>
#include <thread>

#include <nanobind/nanobind.h>

namespace repel::python {

namespace nb = nanobind;

[[noreturn]] inline void stand_still() noexcept {
  if (nb::is_alive()) nb::set_leak_warnings(false);  // what this thread holds is no leak
  for (;;) std::this_thread::sleep_for(std::chrono::hours(1));
}

/// The innermost object around a call that may end this thread.
class StaysUnlessPast {
 public:
  StaysUnlessPast() = default;
  StaysUnlessPast(const StaysUnlessPast&) = delete;
  StaysUnlessPast& operator=(const StaysUnlessPast&) = delete;
  ~StaysUnlessPast() {
    if (!is_past_) stand_still();
  }
  void pass() noexcept { is_past_ = true; }

 private:
  bool is_past_ = false;
};

// Each of these three is a function of its own that may throw: inlined into one that is noexcept,
// the unwinding would end there before it destroys anything.
[[gnu::noinline]] inline void take_again(PyThreadState* state) {
  StaysUnlessPast here;
  PyEval_RestoreThread(state);
  here.pass();
}
[[gnu::noinline]] inline PyGILState_STATE take() {
  StaysUnlessPast here;
  const PyGILState_STATE before = PyGILState_Ensure();
  here.pass();
  return before;
}
[[gnu::noinline]] inline PyObject* answer_of(nb::handle object, nb::handle method, nb::handle a,
                                             nb::handle b) {
  StaysUnlessPast here;
  PyObject* const answer =
      PyObject_CallMethodObjArgs(object.ptr(), method.ptr(), a.ptr(), b.ptr(), nullptr);
  here.pass();
  return answer;
}

/// Other threads of Python go on while this lives.
class Released {
 public:
  Released() noexcept : state_(PyEval_SaveThread()) {}
  Released(const Released&) = delete;
  Released& operator=(const Released&) = delete;
  ~Released() {
    if (!nb::is_alive()) stand_still();
    take_again(state_);
  }

 private:
  PyThreadState* state_;
};

/// This thread has the interpreter while this lives, whether it had it before or not.
class Held {
 public:
  Held() noexcept {
    if (!nb::is_alive()) stand_still();
    before_ = take();
  }
  Held(const Held&) = delete;
  Held& operator=(const Held&) = delete;
  ~Held() { PyGILState_Release(before_); }

 private:
  PyGILState_STATE before_{};
};

/// Calls a method, which may run code of Python: that lets go of the interpreter at times.
/// @param a,b its arguments, if any @throws nanobind::python_error
[[nodiscard]] inline nb::object call_method(nb::handle object, const char* method,
                                            nb::handle a = {}, nb::handle b = {}) {
  PyObject* const answer = answer_of(object, nb::str(method), a, b);
  if (answer == nullptr) nb::raise_python_error();
  return nb::steal(answer);
}

/// Refuses a second call of an object while one goes on, in another thread or from its own
/// kinematics: others run while the interpreter is let go.
class InUse {
 public:
  /// @throws std::runtime_error
  explicit InUse(bool& flag) : flag_(flag) {
    if (flag_) throw std::runtime_error("this object is in use: allowed is one call at a time");
    flag_ = true;
  }
  ~InUse() { flag_ = false; }
  InUse(const InUse&) = delete;
  InUse& operator=(const InUse&) = delete;

 private:
  bool& flag_;  ///< read and written with the GIL only
};

}  // namespace repel::python
