// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// A fault in a header must be found through the file that includes it.
#pragma once

inline double half() { return 1 / 2; }
