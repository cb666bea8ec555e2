// SPDX-License-Identifier: BSD-3-Clause
// Arbitrary text as an SDF file, beside a model and a mesh that it may include: parts that are
// finite, or a SetupError that names a file. The library that reads it does so in a child process.
#include <repel/robots/sdf.hpp>

#include <string>

#include <end_to_end/folder.hpp>
#include <fuzz/bytes.hpp>
#include <repel/base/setup_error.hpp>

namespace repel {
namespace {

using fuzz::require;

void check_text(const std::string& text) {
  static const test::Folder folder;
  static const std::string model = folder.with(
      "model.sdf",
      "<sdf version='1.9'><model name='m'><link name='l'><collision name='c'><geometry><sphere>"
      "<radius>0.2</radius></sphere></geometry></collision></link></model></sdf>");
  static const std::string mesh =
      folder.with("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 2 4\n");
  const std::string path = folder.with("fuzz.sdf", text);
  try {
    for (const RobotPart& part : load_sdf_parts(path)) {
      require(is_finite(part.X_LP), "a part is somewhere");
      require(is_finite(part.size), "a part has a size");
      for (const Vec3& p : part.points) require(is_finite(p), "a corner is somewhere");
      require(!part.in_link.empty(), "a part is in a link");
    }
  } catch (const SetupError& error) {
    require(!error.file().empty(), "an error names a file");
  }
}

}  // namespace
}  // namespace repel

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  repel::check_text(std::string(data, data + size));
  return 0;
}
