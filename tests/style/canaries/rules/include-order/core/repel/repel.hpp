/// @file
/// A canary.
#pragma once

#include <repel/geometry/canary.hpp>
