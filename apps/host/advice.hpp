/// @file
/// What would make a machine a better host, each with the command to run.
#pragma once

#include <string>
#include <vector>

#include "trial.hpp"

namespace repel::host {

/// What advice depends on beside a trial.
struct Surroundings {
  bool preempt_rt = false;             ///< the kernel is fully preemptible
  std::vector<std::string> governors;  ///< that scale the frequency of processors, each once
  bool virtual_machine = false;
  bool root = false;
  bool can_stay_awake = false;  ///< there is a /dev/cpu_dma_latency to ask
};
[[nodiscard]] Surroundings look_around();

struct Advice {
  std::string finding;
  std::string command;  ///< that mends it
};

/// Only what applies.
[[nodiscard]] std::vector<Advice> advise(const Surroundings& surroundings, const Trial& trial);

}  // namespace repel::host
