// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Closes the circle.
#pragma once
