// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Includes what includes it.
#pragma once

#include "key.hpp"
