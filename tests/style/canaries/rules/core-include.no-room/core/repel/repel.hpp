/// @file
/// A canary.
#pragma once

#include <repel/cellar/canary.hpp>
