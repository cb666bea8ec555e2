// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The browser of the desktop.
#pragma once

#include <optional>
#include <string>

namespace repel::runs {

/// Opens a URL in the browser of this desktop, by xdg-open, and does not wait for it.
/// @param asked for; without a value it is opened if stderr is a terminal of a desktop. Where it is
///        asked for and there is no desktop or no xdg-open, that is said on stderr
void open_browser(const std::string& url, std::optional<bool> asked);

}  // namespace repel::runs
