// SPDX-License-Identifier: BSD-3-Clause
#include <repel/schedule/instruction_set.hpp>

#include <array>
#include <cstdlib>
#include <cstring>
#include <string>

#include <repel/base/setup_error.hpp>
#include <repel/schedule/evaluators.hpp>

extern "C" {
extern const repel::detail::Evaluators repel_evaluators;
#ifdef REPEL_HAS_EVALUATORS_X86_64
extern const repel::detail::Evaluators repel_evaluators_x86_64_v3;
extern const repel::detail::Evaluators repel_evaluators_x86_64_v4;
#endif
}

namespace repel {
namespace detail {
namespace {

#ifdef REPEL_HAS_EVALUATORS_X86_64
/// Valgrind up to 3.19 takes one of the moves that assemblers write with AVX for no instruction.
[[nodiscard]] bool is_in_valgrind() noexcept {
  const char* const preloaded = std::getenv("LD_PRELOAD");
  return preloaded != nullptr && std::strstr(preloaded, "/vgpreload_") != nullptr;
}
// Compilers differ in which levels they know by name.
[[nodiscard]] bool has_v3() noexcept {
  return !is_in_valgrind() && __builtin_cpu_supports("avx2") != 0 &&
         __builtin_cpu_supports("fma") != 0 && __builtin_cpu_supports("bmi") != 0 &&
         __builtin_cpu_supports("bmi2") != 0;
}
[[nodiscard]] bool has_v4() noexcept {
  return has_v3() && __builtin_cpu_supports("avx512f") != 0 &&
         __builtin_cpu_supports("avx512bw") != 0 && __builtin_cpu_supports("avx512cd") != 0 &&
         __builtin_cpu_supports("avx512dq") != 0 && __builtin_cpu_supports("avx512vl") != 0;
}
#endif

/// Those that the processor has, and the one of them that is in use.
class Choice {
 public:
  Choice() noexcept {
    add(repel_evaluators);
#ifdef REPEL_HAS_EVALUATORS_X86_64
    if (has_v3()) add(repel_evaluators_x86_64_v3);
    if (has_v4()) add(repel_evaluators_x86_64_v4);
#endif
    const char* const wanted = std::getenv("REPEL_ISA");
    if (wanted == nullptr || *wanted == '\0') return;
    is_refused_ = true;
    for (std::size_t i = 0; i < count_; ++i) {
      if (names_[i] != wanted) continue;
      used_ = sets_[i];
      is_refused_ = false;
    }
  }

  /// Of the instruction set in use; the fastest one where the wish was refused.
  [[nodiscard]] const Evaluators& used() const noexcept {
    return *used_;
  }
  [[nodiscard]] std::span<const std::string_view> names() const noexcept {
    return {names_.data(), count_};
  }
  [[nodiscard]] std::span<const Evaluators* const> all() const noexcept {
    return {sets_.data(), count_};
  }
  void require() const {
    if (!is_refused_) return;
    std::string all;
    for (const std::string_view name : names()) {
      all += all.empty() ? "" : ", ";
      all += name;
    }
    const char* const wanted = std::getenv("REPEL_ISA");
    throw SetupError("the environment variable REPEL_ISA is '" +
                     std::string(wanted != nullptr ? wanted : "") +
                     "'; this processor and this library have: " + all);
  }

 private:
  void add(const Evaluators& evaluators) noexcept {
    used_ = &evaluators;
    names_[count_] = evaluators.instruction_set;
    sets_[count_++] = &evaluators;
  }

  std::array<std::string_view, 3> names_;
  std::array<const Evaluators*, 3> sets_{};
  std::size_t count_ = 0;
  const Evaluators* used_ = nullptr;
  bool is_refused_ = false;
};

const Choice& choice() noexcept {
  static const Choice made;
  return made;
}

}  // namespace

std::unique_ptr<AnyPairSet> make_pair_set(const World& world, int slots, const Budget& budget,
                                          double lookahead) {
  choice().require();
  return choice().used().make_pair_set(world, slots, budget, lookahead);
}

std::span<const Evaluators* const> all_evaluators() noexcept {
  return choice().all();
}

}  // namespace detail

std::string_view instruction_set() {
  detail::choice().require();
  return detail::choice().used().instruction_set;
}

std::span<const std::string_view> instruction_sets() noexcept {
  return detail::choice().names();
}

void separations(std::span<const PosedShapes> pairs, const QueryOptions& options,
                 std::span<WarmStart> warm, std::span<Separation> results) noexcept {
  detail::choice().used().separations(pairs, options, warm, results);
}

}  // namespace repel
