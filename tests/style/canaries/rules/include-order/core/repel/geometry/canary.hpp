/// @file
/// A canary.
#pragma once

#include <repel/loop/tick.hpp>
