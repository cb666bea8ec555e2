// SPDX-License-Identifier: BSD-3-Clause
#include <repel/runs/view/arm_inputs_info.hpp>

#include <any>

#include <repel/network/modules/guide.hpp>
#include <repel/network/modules/multiplex.hpp>
#include <repel/network/modules/six_axes.hpp>

namespace repel::runs {

void note_inputs(const scene::Network& network, visual::ArmInfo& arm) {
  for (const scene::Module& module : network.modules) {
    const std::any& options = module.options;
    if (const auto* guide = std::any_cast<network::GuideOptions>(&options)) {
      arm.fixtures = guide->fixtures;
    } else if (const auto* relief = std::any_cast<network::ReliefOptions>(&options)) {
      // The words of a script are those of the first one.
      if (!arm.relief) arm.relief = *relief;
    } else if (const auto* handle = std::any_cast<network::SixAxesOptions>(&options)) {
      const bool is_first = handle->hand == network::Hand::first;
      (is_first ? arm.has_handle : arm.has_second_handle) = true;
      arm.has_scale = true;
    } else if (std::any_cast<network::MultiplexOptions>(&options) != nullptr) {
      arm.has_scale = true;
    }
  }
}

}  // namespace repel::runs
