// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// A canary.
#pragma once
