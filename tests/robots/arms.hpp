// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The arms used by these tests.
#pragma once

#include <string>
#include <vector>

#include <repel/robots/urdf.hpp>
#include <repel/world/kinematics.hpp>

#include "world/arms.hpp"

namespace repel::test {

inline const std::vector<std::string> puma_files = {"robots/puma560.urdf",
                                                    "robots/puma560_armstrong.urdf"};

/// Both PUMA sets and the skewed arm.
inline std::vector<ArmModel> all_arms() {
  std::vector<ArmModel> arms = {skewed_arm()};
  for (const std::string& file : puma_files) arms.push_back(load_arm(file).arm);
  return arms;
}

}  // namespace repel::test
