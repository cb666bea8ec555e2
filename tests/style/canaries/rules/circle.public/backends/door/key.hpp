// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Its third leads back.
#pragma once

#include "parts/bit.hpp"
