// SPDX-License-Identifier: BSD-3-Clause
#include <filesystem>
#include <fstream>
#include <iterator>

#include <repel/base/setup_error.hpp>
#include <repel/visual/server.hpp>

namespace repel::visual {
namespace {

namespace fs = std::filesystem;

/// Empty for a file that does not belong to the page.
std::string media_type(const fs::path& file) {
  const std::string kind = file.extension().string();
  if (kind == ".html") return "text/html; charset=utf-8";
  if (kind == ".css") return "text/css; charset=utf-8";
  if (kind == ".js") return "text/javascript; charset=utf-8";
  if (kind == ".svg") return "image/svg+xml";
  return {};
}

}  // namespace

std::vector<Asset> load_assets(const std::string& folder) {
  std::vector<Asset> assets;
  std::error_code error;
  for (const auto& entry : fs::recursive_directory_iterator(folder, error)) {
    const std::string type = media_type(entry.path());
    if (type.empty() || !entry.is_regular_file()) continue;
    std::ifstream file(entry.path(), std::ios::binary);
    std::string target = "/";
    target += fs::relative(entry.path(), folder).generic_string();
    const std::string body{std::istreambuf_iterator<char>(file), {}};
    if (target == "/index.html") assets.push_back({"/", type, body});
    assets.push_back({target, type, body});
  }
  for (const Asset& asset : assets) {
    if (asset.target == "/") return assets;
  }
  throw SetupError("the page of the live view is not there: no index.html", folder);
}

}  // namespace repel::visual
