/// @file
/// Includes what includes it.
#pragma once

#include "key.hpp"
