/// @file
/// A canary.
#pragma once

#include "types.hpp"
