// SPDX-License-Identifier: BSD-3-Clause
#include <repel/percepts/depth_image_file.hpp>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <system_error>
#include <vector>

#include <repel/base/setup_error.hpp>
#include <repel/common/input_limits.hpp>

#ifdef REPEL_PERCEPTS_PNG
#include <png.h>
#endif

namespace repel::percepts {
#ifdef REPEL_PERCEPTS_PNG
namespace {

constexpr std::uintmax_t most_file_bytes = input_limits.file_bytes;
constexpr png_alloc_size_t most_chunk_bytes = std::size_t{1} << 16;

struct Closing {
  void operator()(std::FILE* file) const noexcept { (void)std::fclose(file); }
};

/// What libpng says of a file that it cannot read.
[[noreturn]] void note_error(png_structp png, png_const_charp text) {
  static_cast<std::string*>(png_get_error_ptr(png))->assign(text);
  png_longjmp(png, 1);
}
void ignore_warning(png_structp /*png*/, png_const_charp /*text*/) {}

/// @param pixels null: only the head
void read_rows(png_structp png, png_infop info, const DepthCamera& camera, std::uint16_t* pixels) {
  png_read_info(png, info);
  const auto width = static_cast<int>(png_get_image_width(png, info));
  const auto height = static_cast<int>(png_get_image_height(png, info));
  const int bits = png_get_bit_depth(png, info);
  const int channels = png_get_channels(png, info);
  if (width != camera.width || height != camera.height || bits != 16 || channels != 1) {
    auto* const message = static_cast<std::string*>(png_get_error_ptr(png));
    *message = "it has " + std::to_string(width) + " x " + std::to_string(height) + " pixels of " +
               std::to_string(channels) + " x " + std::to_string(bits) +
               " bits; allowed: " + std::to_string(camera.width) + " x " +
               std::to_string(camera.height) + " of 1 x 16 bits";
    return;
  }
  if (pixels == nullptr) return;
  const int passes = png_set_interlace_handling(png);
  if constexpr (std::endian::native == std::endian::little) png_set_swap(png);
  png_read_update_info(png, info);
  for (int pass = 0; pass < passes; ++pass) {
    for (int v = 0; v < height; ++v) {
      // NOLINTNEXTLINE(*-reinterpret-cast): libpng fills rows of bytes
      png_read_row(png, reinterpret_cast<png_bytep>(pixels + camera.at(0, v)), nullptr);
    }
  }
  png_read_end(png, nullptr);
}

/// @param message empty if all is well. It and the file belong to the caller, since libpng leaves
/// this function by a jump, which destroys nothing
void read(std::FILE* file, const DepthCamera& camera, std::uint16_t* pixels, std::string& message) {
  png_structp png =
      png_create_read_struct(PNG_LIBPNG_VER_STRING, &message, &note_error, &ignore_warning);
  if (png == nullptr) {
    message = "libpng has no memory";
    return;
  }
  png_infop info = png_create_info_struct(png);
  // Only the pixels count: texts, colour profiles and the like are passed over, whatever they would
  // become when decompressed.
  png_set_keep_unknown_chunks(png, PNG_HANDLE_CHUNK_NEVER, nullptr, -1);
  png_set_chunk_malloc_max(png, most_chunk_bytes);
  if (setjmp(png_jmpbuf(png)) == 0) {  // NOLINT(*-err52-cpp): as libpng asks for
    png_init_io(png, file);
    read_rows(png, info, camera, pixels);
  }
  png_destroy_read_struct(&png, &info, nullptr);
}

void read_or_throw(const std::string& path, const DepthCamera& camera, std::uint16_t* pixels) {
  std::error_code error;
  std::string message;
  // To open a pipe would wait for somebody who writes to it.
  const bool is_file = std::filesystem::is_regular_file(path, error);
  const std::unique_ptr<std::FILE, Closing> file(is_file ? std::fopen(path.c_str(), "rb")
                                                         : nullptr);
  const std::uintmax_t bytes = is_file ? std::filesystem::file_size(path, error) : 0;
  if (file == nullptr || error) {
    message = "it cannot be opened";
  } else if (bytes > most_file_bytes) {
    message = "it has " + std::to_string(bytes) + " bytes; allowed: up to " +
              std::to_string(most_file_bytes);
  } else {
    read(file.get(), camera, pixels, message);
  }
  if (!message.empty()) {
    throw SetupError("the depth image '" + path + "' cannot be used: " + message);
  }
}

}  // namespace

bool reads_depth_images() noexcept {
  return true;
}

void check_depth_image(const std::string& path, const DepthCamera& camera) {
  read_or_throw(path, camera, nullptr);
}

void read_depth_image(const std::string& path, const DepthCamera& camera, double unit,
                      std::span<float> depth) {
  std::vector<std::uint16_t> pixels(camera.pixels());
  read_or_throw(path, camera, pixels.data());
  const std::size_t count = std::min(depth.size(), pixels.size());
  for (std::size_t i = 0; i < count; ++i) depth[i] = static_cast<float>(unit * pixels[i]);
}
#else
bool reads_depth_images() noexcept {
  return false;
}

void check_depth_image(const std::string& path, const DepthCamera& /*camera*/) {
  throw SetupError("the depth image '" + path +
                   "' cannot be read by this build; to have it: apt-get install libpng-dev, then "
                   "build again");
}

void read_depth_image(const std::string& path, const DepthCamera& camera, double /*unit*/,
                      std::span<float> /*depth*/) {
  check_depth_image(path, camera);
}
#endif

}  // namespace repel::percepts
