// SPDX-License-Identifier: BSD-3-Clause
#include <array>
#include <atomic>
#include <filesystem>

#include <repel/visual/page_folder.hpp>

namespace repel::visual {
namespace {

namespace fs = std::filesystem;

// Written before main, by initialisers of other sources.
// NOLINTNEXTLINE(cppcoreguidelines-avoid-non-const-global-variables)
constinit std::atomic<const char*> folder_of_package{nullptr};

}  // namespace

bool note_page_folder(const char* folder) noexcept {
  folder_of_package = folder;
  return true;
}

std::string page_folder() {
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error).parent_path();
  const char* const noted = folder_of_package;
  const std::array<fs::path, 3> folders{program / "../../../backends/visual/page",
                                        program / "../share/repel/page",
                                        noted == nullptr ? "" : noted};
  for (const fs::path& folder : folders) {
    if (fs::exists(folder / "index.html", error)) return fs::weakly_canonical(folder).string();
  }
  return folders.front().string();
}

}  // namespace repel::visual
