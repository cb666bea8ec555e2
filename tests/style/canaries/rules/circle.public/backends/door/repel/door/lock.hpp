// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Stands alone.
#pragma once
