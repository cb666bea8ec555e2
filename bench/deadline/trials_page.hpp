// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The trials as an HTML page.
#pragma once

#include <ostream>
#include <vector>

#include <repel/host/trial/trial.hpp>

/// Writes one self-contained page: a table of all rates, and for each rate the cumulative
/// distributions of compute time and lateness of its ticks.
void write_page(const std::vector<repel::host::Trial>& trials, std::ostream& out);
