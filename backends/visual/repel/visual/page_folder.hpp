// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Where the files of the page are.
#pragma once

#include <string>

namespace repel::visual {

/// The folder with index.html: `backends/visual/page` of the source tree that the program was built
/// in, `share/repel/page` of the installation it is in, or that of the package repel it was
/// compiled with; the first of these if none exists. Not for the tick.
[[nodiscard]] std::string page_folder();

/// Adds a folder, which must last, to those that page_folder() looks at, as the last one.
/// @return true
bool note_page_folder(const char* folder) noexcept;

#ifdef REPEL_PAGE_FOLDER
/// Set by the target repel::visual of an installed package: the package may have been moved since
/// this library was built, and only who compiles against it knows where it is.
[[maybe_unused]] static const bool page_folder_of_package = note_page_folder(REPEL_PAGE_FOLDER);
#endif

}  // namespace repel::visual
