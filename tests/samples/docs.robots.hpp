// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// What the samples of docs/robots.md leave out.
#pragma once

#include <span>

extern const std::span<const double> q;
