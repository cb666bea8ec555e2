// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Where the files of the page are.
#pragma once

#include <string>

namespace repel::visual {

/// The folder with index.html, the first that exists of: `backends/visual/page` of the source tree
/// of the build, `share/repel/page` of the program's installation, the folder of the package repel
/// it was compiled with. If none exists, the first. Not for the tick.
[[nodiscard]] std::string page_folder();

/// Adds a folder to the end of the list of page_folder(). The text must last.
/// @return true
bool note_page_folder(const char* folder) noexcept;

#ifdef REPEL_PAGE_FOLDER
/// Set by the target repel::visual of an installed package: the package may have been moved since
/// this library was built, and its place is known only when a program is compiled against it.
[[maybe_unused]] static const bool page_folder_of_package = note_page_folder(REPEL_PAGE_FOLDER);
#endif

}  // namespace repel::visual
