/// @file
/// What the tests of this folder move.
#pragma once

#include <repel/bullet/arm.hpp>

#include "simulated/arms.hpp"

namespace repel::bullet::test {

using namespace simulated;

}  // namespace repel::bullet::test
