/// @file
/// The trials as a page for people.
#pragma once

#include <ostream>
#include <vector>

#include "trial.hpp"

/// Writes one page that needs nothing beside itself: a table of all rates, and for each the share
/// of its ticks that took, and were, no longer than a time.
void write_page(const std::vector<repel::host::Trial>& trials, std::ostream& out);
