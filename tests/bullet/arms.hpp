// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The arms used by the tests of this folder.
#pragma once

#include <repel/bullet/arm.hpp>

#include "simulated/arms.hpp"

namespace repel::bullet::test {

using namespace simulated;

}  // namespace repel::bullet::test
