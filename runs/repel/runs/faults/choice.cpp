// SPDX-License-Identifier: BSD-3-Clause
#include <repel/runs/faults/choice.hpp>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <functional>
#include <sstream>
#include <string_view>

#include <repel/base/setup_error.hpp>
#include <repel/host/command_line.hpp>
#include <repel/runs/faults/exchange.hpp>

namespace repel::faults {
namespace {

constexpr std::string_view between_two = "; ";  // no name has it

std::string in_small_letters(std::string text) {
  for (char& letter : text) {
    letter = static_cast<char>(std::tolower(static_cast<unsigned char>(letter)));
  }
  return text;
}

std::string in_quotes(const std::string& name) {
  return "'" + name + "'";
}

std::vector<std::string> names_to_be_had() {
  std::vector<std::string> names;
  for (const Fault& fault : all_faults()) {
    if (can_be_had(fault)) names.emplace_back(fault.name);
  }
  return names;
}

/// The names that have most of its words, and one that is nearly the same, as a question; empty
/// without any.
std::string those_like(const std::string& text) {
  constexpr std::ptrdiff_t few = 4;
  std::vector<std::string> names = names_to_be_had();
  const std::string meant = host::closest(text, names);
  const auto shared = [&](const std::string& name) {
    if (name == meant) return static_cast<int>(text.size()) + 1;
    std::istringstream words(in_small_letters(text));
    int count = 0;
    for (std::string word; words >> word;) {
      count += in_small_letters(name).find(word) != std::string::npos ? 1 : 0;
    }
    return count;
  };
  std::ranges::stable_sort(names, std::greater{}, shared);
  std::string all;
  for (const std::string& name : std::span(names).first(few)) {
    if (shared(name) > 0) all += (all.empty() ? "" : ", ") + in_quotes(name);
  }
  return all.empty() ? all : " (did you mean " + all + "?)";
}

std::string others_of(Kind kind) {
  std::string all;
  for (const Fault& fault : all_faults()) {
    if (fault.kind == kind && can_be_had(fault))
      all += (all.empty() ? "" : ", ") + in_quotes(fault.name);
  }
  return all;
}

}  // namespace

bool can_be_had(const Fault& fault) {
  return fault.needs != Needs::joint_brakes;
}

const Fault& fault_named(const std::string& name) {
  const auto all = all_faults();
  const auto found = std::ranges::find(all, name, &Fault::name);
  if (found == all.end()) {
    throw SetupError("no fault is called " + in_quotes(name) + those_like(name) +
                     "; allowed: those that teleop list --faults prints");
  }
  if (!can_be_had(*found)) {
    throw SetupError("the fault " + in_quotes(name) +
                     " needs brakes of single joints, which the simulated arms of scenes do not "
                     "have; allowed of its kind: " +
                     others_of(found->kind));
  }
  return *found;
}

Choice choice_in(const std::string& text) {
  const std::size_t at = text.rfind('@');
  if (at == std::string::npos) {
    throw SetupError("the fault " + in_quotes(fault_named(text).name) +
                     " lacks the time at which it begins; allowed: NAME@SECONDS, as 'frame "
                     "frozen@2.5'");
  }
  Choice choice{text.substr(0, at)};
  (void)fault_named(choice.name);
  const char* const end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data() + at + 1, end, choice.begin);
  if (error != std::errc() || rest != end ||
      !(choice.begin >= 0.0 && choice.begin <= latest_begin)) {
    throw SetupError("the fault " + in_quotes(choice.name) + " begins at " +
                     in_quotes(text.substr(at + 1)) + "; allowed: 0 to " +
                     repel::to_text(latest_begin) + " s");
  }
  return choice;
}

std::string to_text(std::span<const Choice> choices) {
  std::string all;
  for (const Choice& each : choices) {
    if (!all.empty()) all += between_two;
    all += each.name + '@' + repel::to_text(each.begin);
  }
  return all;
}

std::vector<Choice> choices_in(const std::string& text) {
  std::vector<Choice> choices;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.size(), text.find(between_two, at));
    choices.push_back(choice_in(text.substr(at, end - at)));
    at = end + between_two.size();
  }
  return choices;
}

void require_no_operator(std::span<const Choice> choices) {
  for (const Choice& each : choices) {
    if (fault_named(each.name).kind != Kind::operators) continue;
    throw SetupError("the fault " + in_quotes(each.name) +
                     " is of the operator, who is in another program; allowed: --programs one, or "
                     "faults of readings, kinematics, clock or drive");
  }
}

}  // namespace repel::faults
