// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// What would improve the real-time behaviour of a machine, each with the command to run.
#pragma once

#include <string>
#include <vector>

#include <repel/host/trial/trial.hpp>

namespace repel::host {

/// What advice depends on, apart from a trial.
struct Surroundings {
  bool preempt_rt = false;             ///< the kernel is fully preemptible
  std::vector<std::string> governors;  ///< cpufreq governors in use, each once
  bool virtual_machine = false;
  bool root = false;
  bool can_stay_awake = false;  ///< /dev/cpu_dma_latency exists
};
[[nodiscard]] Surroundings look_around();

struct Advice {
  std::string finding;
  std::string command;  ///< that fixes it
};

/// Only the advice that applies here.
[[nodiscard]] std::vector<Advice> advise(const Surroundings& surroundings, const Trial& trial);

}  // namespace repel::host
