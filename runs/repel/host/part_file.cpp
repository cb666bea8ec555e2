// SPDX-License-Identifier: BSD-3-Clause
#include <repel/host/part_file.hpp>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <repel/base/setup_error.hpp>
#include <system_error>

namespace repel::host {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const std::string& what, const std::string& path) {
  const int error = errno;
  throw SetupError(what + ": " + std::generic_category().message(error), path);
}

bool is_below(const fs::path& path, const char* folder) {
  return *path.begin() == "/" && std::next(path.begin()) != path.end() &&
         *std::next(path.begin()) == folder;
}

/// The path of the regular file of that name, existing or not, with links resolved; none if it is
/// to be written directly (device, pipe, /dev, /proc).
std::optional<fs::path> place_of(const std::string& path) {
  constexpr int most_links = 40;  // as the kernel allows
  std::error_code error;
  fs::path at = fs::absolute(path, error);
  for (int i = 0; i < most_links; ++i) {
    // Such a path may refer to an open file description, such as /dev/stdout.
    if (is_below(at, "dev") || is_below(at, "proc")) return std::nullopt;
    if (!fs::is_symlink(fs::symlink_status(at, error))) break;
    at = at.parent_path() / fs::read_symlink(at, error);
  }
  if (fs::exists(at, error) && !fs::is_regular_file(at, error)) return std::nullopt;
  const fs::path folder = fs::canonical(at.parent_path(), error);
  return error ? at : folder / at.filename();
}

/// Creates the first of PLACE.part, PLACE.2.part and so on that does not exist; returns its name.
std::string make_part(const std::string& place, const std::string& path) {
  constexpr int most_parts = 100;
  struct stat now {};
  const bool exists = stat(place.c_str(), &now) == 0;
  if (exists && access(place.c_str(), W_OK) != 0) fail("cannot be written", path);
  for (int i = 1; i <= most_parts; ++i) {
    std::string part = place;
    if (i > 1) part.append(1, '.').append(std::to_string(i));
    part += ".part";
    const int file = open(part.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (file < 0 && errno == EEXIST) continue;
    if (file < 0) fail("cannot be written", path);
    if (exists) (void)fchmod(file, now.st_mode & 07777U);
    (void)close(file);
    return part;
  }
  throw SetupError("cannot be written: there are " + std::to_string(most_parts) +
                       " files of runs that were cut off beside it, up to " + place + "." +
                       std::to_string(most_parts) + ".part; allowed: fewer",
                   path);
}

/// Whether both names refer to the same regular file, which need not exist yet.
bool is_same(const std::string& a, const std::string& b) {
  std::error_code error;
  if (fs::exists(a, error) && !fs::is_regular_file(a, error)) return false;
  if (fs::equivalent(a, b, error) && !error) return true;
  const std::optional<fs::path> place = place_of(a);
  return place && place == place_of(b);
}

}  // namespace

PartFile::PartFile(const std::string& path) : place_(path), part_(path) {
  if (path.empty()) return;
  const std::optional<fs::path> place = place_of(path);
  if (!place) return;
  place_ = place->string();
  part_ = make_part(place_, path);
}

PartFile::~PartFile() {
  if (is_beside() && !is_kept_) (void)std::remove(part_.c_str());
}

void PartFile::put_in_place() {
  if (!is_beside() || is_kept_) return;
  is_kept_ = true;
  // Some file systems report a full disk only at fsync.
  const int file = open(part_.c_str(), O_RDONLY | O_CLOEXEC);
  const bool is_on_disk = file >= 0 && fsync(file) == 0;
  const int error = errno;
  if (file >= 0) (void)close(file);
  errno = error;
  if (!is_on_disk) fail("cannot be written whole", part_);
  if (std::rename(part_.c_str(), place_.c_str()) != 0) {
    fail("is whole but cannot be moved to " + place_, part_);
  }
}

void require_apart(const std::vector<NamedFile>& read, const std::vector<NamedFile>& written) {
  std::vector<NamedFile> taken = read;
  for (const NamedFile& file : written) {
    if (file.path.empty()) continue;
    for (const NamedFile& other : taken) {
      if (other.path.empty()) continue;
      // While being written they have the suffix ".part".
      if (!is_same(file.path, other.path) && !is_same(file.path + ".part", other.path) &&
          !is_same(file.path, other.path + ".part")) {
        continue;
      }
      throw SetupError(file.what + " would write over " + other.what + " (" + other.path +
                           "); allowed: another file",
                       file.path);
    }
    taken.push_back(file);
  }
}

}  // namespace repel::host
