// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The network of an arm whose description has none.
#pragma once

#include <repel/network/plan.hpp>
#include <repel/world/arm.hpp>

namespace repel {

/// The modules of Anderson 1993, Figure 9, with their defaults: a force-feedback lever and six
/// rates without feedback, coupled to the tool by a spring-damper; walls on tool and links; joint
/// limits.
[[nodiscard]] network::Plan default_network(const ArmModel& arm);

}  // namespace repel
