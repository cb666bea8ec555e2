/// @file
/// A canary.
#pragma once

#include <repel/base/other.hpp>
#include <repel/geometry/canary.hpp>
