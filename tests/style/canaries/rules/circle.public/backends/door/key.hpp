/// @file
/// Its third leads back.
#pragma once

#include "parts/bit.hpp"
