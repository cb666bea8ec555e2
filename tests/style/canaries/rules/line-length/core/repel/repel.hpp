/// @file
/// A canary.
#pragma once

#include <repel/base/canary.hpp>
